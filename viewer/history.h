// SPDX-License-Identifier: MIT
// The way back: a ring of snapshots. Where worlds are large they lie some steps apart, and a step in between is made
// again from the one before it, with the same bits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>

#include <talus/world.h>

namespace talus::viewer {

class History {
public:
    /// `most_bytes`: of memory, for all snapshots together; there are always two. `time_share`: of the time that the
    /// steps stand for, which may go into taking snapshots.
    explicit History(std::size_t most_bytes = std::size_t{256} << 20, double time_share = 0.05)
        : budget(most_bytes), share(time_share) {}

    /// To be called before each step, and never within one.
    void before_step(const World&);
    /// The world has been changed by hand: stepping on from an older snapshot would not lead here.
    void note_change() noexcept { changed = true; }
    /// Brings the world to the state before its last step, or, where steps before it were changed by hand and are
    /// forgotten, to the nearest one before. False where there is none.
    bool step_back(World&);
    void clear();

    std::size_t size() const noexcept { return ring.size(); }
    std::size_t bytes() const noexcept { return total; }
    /// The earliest step that can be gone back to; the world's own where there is none.
    std::uint64_t first_step(const World& world) const {
        return ring.empty() ? world.step_count() : ring.front().step();
    }

private:
    void take(const World&);
    void forget_from(std::uint64_t step);

    std::deque<Snapshot> ring; ///< in the order of their steps
    std::size_t budget;
    double share;
    std::size_t total = 0;
    std::uint64_t interval = 1; ///< steps from one snapshot to the next
    bool changed = true;
};

} // namespace talus::viewer
