// SPDX-License-Identifier: MIT
// Union and find on the CPU: a forest in which each body leads to one of its island, and the lowest leads to itself.
// `parents`: anything that is indexed by body slots.
#pragma once

#include <algorithm>

#include "state/dialect.h"

namespace talus::engine {

/// Leads each body on the way to its grandparent.
template <typename Parents> uint root_of(Parents& parents, uint body) {
    while (parents[body] != body)
        body = parents[body] = parents[parents[body]];
    return body;
}

/// Hangs the larger root below the smaller one.
template <typename Parents> void join_islands_of(Parents& parents, uint a, uint b) {
    const uint root_a = root_of(parents, a), root_b = root_of(parents, b);
    parents[std::max(root_a, root_b)] = std::min(root_a, root_b);
}

} // namespace talus::engine
