// SPDX-License-Identifier: MIT
// What is found of several pairs side by side: a pair in each lane of the CPU's vector registers. With the same bits as
// the formulas for one pair.
#pragma once

#include "device/cpu/cpu_state.h"
#include "state/formulas.h"

namespace talus::engine {

/// Two boxes that are to be collided, in cells of four words.
struct alignas(16) BoxQuestion {
    uint body_a;
    uint body_b;
    Carriers carriers; ///< of their last manifold
    float time;        ///< when they are asked for, in steps
    uint had_contact;  ///< 0: they have no last manifold
};

/// Of up to 64 pairs, a bit for each.
struct NearPairs {
    std::uint64_t now;   ///< is_candidate(), as the bodies are now
    std::uint64_t still; ///< is_still_candidate()
};

/// The last step's contact of a pair.
struct LastContact {
    uint pair;
    uint manifold; ///< its place among those of the last step
};

struct LaneQueries {
    uint lanes; ///< pairs side by side
    /// Of as many pairs as there are lanes.
    NearPairs (*find_near)(const CpuState&, const Pair*);
    /// Answers as many questions as there are lanes.
    void (*collide_box_pairs)(const CpuState&, const BoxQuestion*, ContactGeometry*);
    /// Of as many contacts as there are lanes those in `lanes`, a bit each; `most`: most_way. Returns those that last.
    uint (*renew_last_contacts)(const CpuState&, const LastContact*, uint lanes, float most);
};

/// Of at most 64 pairs, with the widest registers that this machine has.
NearPairs find_near(const CpuState&, const Pair*, uint count);

/// Answers `count` questions, as many side by side as the widest registers of this machine have lanes.
void collide_box_pairs(const CpuState&, const BoxQuestion*, uint count, ContactGeometry*);

/// Writes those of at most 64 contacts that last, as they are in this step; `most`: most_way. Returns them, a bit each.
std::uint64_t renew_last_contacts(const CpuState&, const LastContact*, uint count, float most);

} // namespace talus::engine
