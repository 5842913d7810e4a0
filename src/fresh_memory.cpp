// SPDX-License-Identifier: MIT
// See fresh_memory.h.
#include "fresh_memory.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

namespace talus::engine {
namespace {

constexpr std::size_t k_page_bytes = 4096;                    // the smallest that systems have
constexpr std::size_t k_worth_threads = std::size_t{1} << 22; // bytes; fewer take less time than threads to wake
constexpr std::size_t k_pages_each = 128;

} // namespace

void touch_pages(void* begin, std::size_t bytes, unsigned threads) {
    if (bytes < k_worth_threads || threads <= 1) return;
    auto* const memory = static_cast<volatile std::byte*>(begin);
    // In an arena of its own the caller takes up no other work while it waits.
    tbb::task_arena(static_cast<int>(threads)).execute([&] {
        const tbb::blocked_range<std::size_t> all(0, bytes / k_page_bytes, k_pages_each);
        tbb::parallel_for(all, [memory](const tbb::blocked_range<std::size_t>& pages) {
            for (std::size_t page = pages.begin(); page < pages.end(); ++page)
                memory[page * k_page_bytes] = std::byte{0};
        });
    });
}

} // namespace talus::engine
