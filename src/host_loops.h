// SPDX-License-Identifier: MIT
// Loops of the host over many things, which several threads share.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

namespace talus::engine {

/// in_parts for several threads.
void share_parts(std::size_t count, unsigned threads, std::size_t least,
                 const std::function<void(std::size_t first, std::size_t end)>& work);

/// Calls `work` with parts of the numbers below `count`, [first, end), which together are all of them; side by side on
/// so many threads, in parts of half of `least` or more, where there are several of `least`. What one of them throws is
/// thrown here, once none runs any more.
template <typename Work> void in_parts(std::size_t count, unsigned threads, std::size_t least, const Work& work) {
    if (threads > 1 && count >= 2 * least)
        share_parts(count, threads, least, std::cref(work));
    else if (count > 0)
        work(std::size_t{0}, count);
}

/// Does all of it, in any order; where one throws, perhaps not the others.
void side_by_side(unsigned threads, std::span<const std::function<void()>> tasks);

} // namespace talus::engine
