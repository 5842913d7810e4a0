// SPDX-License-Identifier: MIT
// See fresh_memory.h.
#include "fresh_memory.h"

#include "host_loops.h"

namespace talus::engine {
namespace {

constexpr std::size_t k_page_bytes = 4096;                    // the smallest that systems have
constexpr std::size_t k_worth_threads = std::size_t{1} << 22; // bytes; fewer take less time than threads to wake
constexpr std::size_t k_pages_each = 128;

} // namespace

void touch_pages(void* begin, std::size_t bytes, unsigned threads) {
    if (bytes < k_worth_threads || threads <= 1) return;
    auto* const memory = static_cast<volatile std::byte*>(begin);
    in_parts(bytes / k_page_bytes, threads, k_pages_each, [memory](std::size_t first, std::size_t end) {
        for (std::size_t page = first; page < end; ++page)
            memory[page * k_page_bytes] = std::byte{0};
    });
}

} // namespace talus::engine
