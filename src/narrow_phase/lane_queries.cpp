// SPDX-License-Identifier: MIT
#include "narrow_phase/lane_queries.h"

#include <algorithm>
#include <array>

#include "device/cpu/by_lanes.h"

namespace talus::engine {

TALUS_DECLARE_OF_SETS(LaneQueries, lane_queries);

static const LaneQueries& lane_queries() {
    return TALUS_FOR_THIS_MACHINE(lane_queries);
}

NearPairs find_near(const CpuState& state, const Pair* pairs, uint count) {
    const LaneQueries& queries = lane_queries();
    NearPairs all{};
    by_lanes(queries.lanes, pairs, count, [&](uint done, const Pair* some, uint active) {
        const NearPairs near = queries.find_near(state, some);
        all.now |= (near.now & active) << done;
        all.still |= (near.still & active) << done;
    });
    return all;
}

void collide_box_pairs(const CpuState& state, const BoxQuestion* questions, uint count, ContactGeometry* answers) {
    const LaneQueries& queries = lane_queries();
    by_lanes(queries.lanes, questions, count, [&](uint done, const BoxQuestion* some, uint) {
        if (done + queries.lanes <= count) {
            queries.collide_box_pairs(state, some, answers + done);
        } else {
            std::array<ContactGeometry, k_most_lanes> rest;
            queries.collide_box_pairs(state, some, rest.data());
            std::copy_n(rest.begin(), count - done, answers + done);
        }
    });
}

std::uint64_t renew_last_contacts(const CpuState& state, const LastContact* contacts, uint count, float most) {
    const LaneQueries& queries = lane_queries();
    std::uint64_t lasting = 0;
    by_lanes(queries.lanes, contacts, count, [&](uint done, const LastContact* some, uint active) {
        lasting |= std::uint64_t{queries.renew_last_contacts(state, some, active, most)} << done;
    });
    return lasting;
}

} // namespace talus::engine
