// SPDX-License-Identifier: MIT
#include "viewer/history.h"

#include <algorithm>

namespace talus::viewer {

namespace {

// Snapshots of this size are taken before each step; larger ones as much less often, so that copying them does not
// outweigh the steps.
constexpr std::size_t k_small_bytes = std::size_t{2} << 20;
constexpr std::uint64_t k_longest_interval = 60; // steps; it is how many are made again for a step back

} // namespace

std::uint64_t History::interval() const {
    return ring.empty() ? 1 : std::clamp<std::uint64_t>(ring.back().bytes() / k_small_bytes, 1, k_longest_interval);
}

void History::before_step(const World& world) {
    const std::uint64_t step = world.step_count();
    const bool due = ring.empty() || changed || step >= ring.back().step() + interval();
    if (!due) return;
    // After a step back and a change, what was ahead is no longer so.
    while (!ring.empty() && ring.back().step() >= step) {
        total -= ring.back().bytes();
        ring.pop_back();
    }
    ring.push_back(world.snapshot());
    total += ring.back().bytes();
    changed = false;
    while (total > budget && ring.size() > 2) {
        total -= ring.front().bytes();
        ring.pop_front();
    }
}

bool History::step_back(World& world) {
    const std::uint64_t now = world.step_count();
    while (!ring.empty() && ring.back().step() >= now) {
        total -= ring.back().bytes();
        ring.pop_back();
    }
    if (ring.empty()) return false;
    const Snapshot& from = ring.back();
    world.restore(from);
    world.step(static_cast<std::uint32_t>(now - 1 - from.step()));
    changed = false;
    return true;
}

void History::clear() {
    ring.clear();
    total = 0;
    changed = true;
}

} // namespace talus::viewer
