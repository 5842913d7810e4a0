// SPDX-License-Identifier: MIT
#include "viewer/history.h"

#include <algorithm>
#include <chrono>

namespace talus::viewer {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t k_longest_interval = 600; // steps
// A step back that has to make more steps again leaves a snapshot on its way, for the steps back that follow.
constexpr std::uint64_t k_many_steps = 32;

} // namespace

void History::take(const World& world) {
    const auto start = Clock::now();
    ring.push_back(world.snapshot());
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    interval = std::clamp<std::uint64_t>(static_cast<std::uint64_t>(seconds / (share * world.settings().dt)), 1,
                                         k_longest_interval);
    total += ring.back().bytes();
    while (total > budget && ring.size() > 2) {
        total -= ring.front().bytes();
        ring.pop_front();
    }
}

void History::forget_from(std::uint64_t step) {
    while (!ring.empty() && ring.back().step() >= step) {
        total -= ring.back().bytes();
        ring.pop_back();
    }
}

void History::before_step(const World& world) {
    const std::uint64_t step = world.step_count();
    if (!ring.empty() && !changed && step < ring.back().step() + interval) return;
    forget_from(step); // after a step back and a change, what was ahead is no longer so
    take(world);
    changed = false;
}

bool History::step_back(World& world) {
    const std::uint64_t now = world.step_count();
    forget_from(now);
    if (ring.empty()) return false;
    world.restore(ring.back());
    std::uint64_t again = now - 1 - ring.back().step();
    if (again > k_many_steps) {
        world.step(static_cast<std::uint32_t>(again - k_many_steps / 2));
        again = k_many_steps / 2;
        take(world);
    }
    world.step(static_cast<std::uint32_t>(again));
    changed = false;
    return true;
}

void History::clear() {
    ring.clear();
    total = 0;
    changed = true;
}

} // namespace talus::viewer
