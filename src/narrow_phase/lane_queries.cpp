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
    uint done = 0;
    const auto add = [&](const NearPairs& some, std::uint64_t asked) {
        all.now |= (some.now & asked) << done;
        all.still |= (some.still & asked) << done;
    };
    for (; done + queries.lanes <= count; done += queries.lanes)
        add(queries.find_near(state, pairs + done), ~std::uint64_t{0});
    if (done < count)
        add(queries.find_near(state, filled_up(pairs + done, pairs + count).data()),
            (std::uint64_t{1} << (count - done)) - 1);
    return all;
}

void collide_box_pairs(const CpuState& state, const BoxQuestion* questions, uint count, ContactGeometry* answers) {
    const LaneQueries& queries = lane_queries();
    uint done = 0;
    for (; done + queries.lanes <= count; done += queries.lanes)
        queries.collide_box_pairs(state, questions + done, answers + done);
    if (done == count) return;
    std::array<ContactGeometry, k_most_lanes> rest;
    queries.collide_box_pairs(state, filled_up(questions + done, questions + count).data(), rest.data());
    std::copy_n(rest.begin(), count - done, answers + done);
}

std::uint64_t renew_last_contacts(const CpuState& state, const LastContact* contacts, uint count) {
    const LaneQueries& queries = lane_queries();
    return by_lanes(queries.lanes, contacts, count, [&](const LastContact* some, uint lanes) {
        return queries.renew_last_contacts(state, some, lanes);
    });
}

} // namespace talus::engine
