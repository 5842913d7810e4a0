// SPDX-License-Identifier: MIT
#include "narrow_phase/lane_queries.h"

#include <algorithm>
#include <array>

#include "device/cpu/instruction_set.h"

namespace talus::engine {

// One a file, as each is compiled for its own instructions.
extern const LaneQueries lane_queries_base, lane_queries_avx2;

static const LaneQueries& lane_queries() {
    return TALUS_FOR_THIS_MACHINE(lane_queries);
}

uint find_near(const CpuState& state, const Pair* pairs, uint count) {
    const LaneQueries& queries = lane_queries();
    uint near = 0, done = 0;
    for (; done + queries.lanes <= count; done += queries.lanes)
        near |= queries.find_near(state, pairs + done) << done;
    if (done == count) return near;
    // The last ones are asked about with one of them again in the lanes that are left.
    std::array<Pair, k_most_lanes> rest;
    rest.fill(pairs[done]);
    std::copy(pairs + done, pairs + count, rest.begin());
    const uint asked = (1u << (count - done)) - 1;
    return near | (queries.find_near(state, rest.data()) & asked) << done;
}

void query_axes(const CpuState& state, const AxisQuestion* questions, uint count, AxisQuery* answers) {
    const LaneQueries& queries = lane_queries();
    uint done = 0;
    for (; done + queries.lanes <= count; done += queries.lanes)
        queries.query_axes(state, questions + done, answers + done);
    if (done == count) return;
    // The last ones are asked with one of them again in the lanes that are left.
    std::array<AxisQuestion, k_most_lanes> rest;
    std::array<AxisQuery, k_most_lanes> rest_answers;
    rest.fill(questions[done]);
    std::copy(questions + done, questions + count, rest.begin());
    queries.query_axes(state, rest.data(), rest_answers.data());
    std::copy_n(rest_answers.begin(), count - done, answers + done);
}

} // namespace talus::engine
