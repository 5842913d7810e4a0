// SPDX-License-Identifier: MIT
// Memory that is about to be filled. A system hands out fresh pages one by one, at the first access to each, and most
// of the time that a million bodies take on the host goes there.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace talus::engine {

/// Accesses each page, by so many threads where there are many pages; does nothing with one. What lies there is lost.
void touch_pages(void* begin, std::size_t bytes, unsigned threads);

/// Gives the list, which is to be filled up to `count`, room for that, if it had too little, and then for `capacity` at
/// least; and no pages to wait for.
template <typename T>
void reserve_touched(std::vector<T>& list, std::size_t count, unsigned threads, std::size_t capacity = 0) {
    if (count <= list.capacity()) return;
    list.reserve(std::max(count, capacity));
    touch_pages(list.data() + list.size(), (count - list.size()) * sizeof(T), threads);
}

} // namespace talus::engine
