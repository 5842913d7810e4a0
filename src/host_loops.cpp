// SPDX-License-Identifier: MIT
// See host_loops.h.
#include "host_loops.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

namespace talus::engine {

void share_parts(std::size_t count, unsigned threads, std::size_t least,
                 const std::function<void(std::size_t first, std::size_t end)>& work) {
    // In an arena of its own the caller takes up no other work while it waits.
    tbb::task_arena(static_cast<int>(threads)).execute([&] {
        const tbb::blocked_range<std::size_t> all(0, count, least);
        tbb::parallel_for(all,
                          [&work](const tbb::blocked_range<std::size_t>& part) { work(part.begin(), part.end()); });
    });
}

void side_by_side(unsigned threads, std::span<const std::function<void()>> tasks) {
    in_parts(tasks.size(), threads, 1, [&](std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i)
            tasks[i]();
    });
}

} // namespace talus::engine
