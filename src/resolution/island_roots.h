// SPDX-License-Identifier: MIT
// Union and find on the CPU: a forest in which each body leads to one of its island, and the root leads to itself.
// `parents`: anything that is indexed by body slots.
#pragma once

#include "state/dialect.h"

namespace talus::engine {

/// Leads each body on the way to its grandparent.
template <typename Parents> uint root_of(Parents& parents, uint body) {
    while (parents[body] != body)
        body = parents[body] = parents[parents[body]];
    return body;
}

/// The root of both is the one whose order(root) is lower.
template <typename Parents, typename Order> void join_islands_of(Parents& parents, uint a, uint b, const Order& order) {
    const uint root_a = root_of(parents, a), root_b = root_of(parents, b);
    if (order(root_a) < order(root_b))
        parents[root_b] = root_a;
    else
        parents[root_a] = root_b;
}

} // namespace talus::engine
