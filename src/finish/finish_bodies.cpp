// SPDX-License-Identifier: MIT
// CPU twin of finish_bodies.comp.glsl.
#include <algorithm>
#include <array>
#include <atomic>
#include <bit>

#include "device/cpu/cpu_state.h"
#include "finish/finish.h"
#include "finish/lane_moves.h"
#include "state/formulas.h"

namespace talus::engine {

static bool is_in_balance(const CpuState& state, uint body) {
    const uint* const words = &state.balances[std::size_t{k_balance_words} * body];
    const auto at = [&](uint word) {
        return vec3(speed_of_balance(words[word]), speed_of_balance(words[word + 1]),
                    speed_of_balance(words[word + 2]));
    };
    return is_balanced(at(k_balance_impulse), at(k_balance_moment), speed_of_balance(words[k_balance_load]),
                       state.properties[body].gravity_scale, state.parameters);
}

/// Of a body that the step moves. Returns its flags then: see MovingBody.
static uint count_rest_of(CpuState& state, uint body, bool is_touched) {
    const BodyPose& pose = state.poses[body];
    if (state.parameters.rest_steps == 0 || !is_movable(state.shapes[body])) return wake_flags(pose.flags);
    const BodyDelta& delta = state.deltas[body];
    const NextRest next = next_rest(pose, apply_delta(pose, delta), delta, state.rests[body], is_touched,
                                    state.shapes[body], state.parameters);
    state.rests[body] = next.rest;
    return next.flags;
}

static void freeze(CpuState& state, uint body) {
    state.starts[body] = start_of_still(state.poses[body]);
    state.poses[body].flags |= k_body_frozen;
    state.velocities[body] = frozen_velocity();
    std::atomic_ref(state.counters[k_counter_frozen_bodies]).fetch_add(1);
}

static void finish_bodies_on_cpu(CpuState& state, const Launch& launch) {
    const Parameters& p = state.parameters;
    state.counters[k_counter_old_pair_count] = state.counters[k_counter_pair_count];
    state.counters[k_counter_same_list] = state.counters[k_counter_pairs_changed] == 0 ? 1 : 0;
    state.counters[k_counter_pairs_changed] = 0;
    const auto is_noted = [&](uint body, uint what) {
        return launch.args[0] == 1 && (state.island_fill[body] & what) != 0;
    };
    const auto finish_sleeper = [&](uint body) {
        BodyPose& pose = state.poses[body];
        state.starts[body] = start_of_still(pose);
        if (!is_noted(body, k_pressed)) return;
        if (!is_in_balance(state, body) && (pose.flags & k_body_frozen) == 0) {
            state.rests[body] = with_calm(state.rests[body], 0);
            pose.flags &= ~k_body_in_part;
        }
        std::fill_n(&state.balances[std::size_t{k_balance_words} * body], k_balance_words, 0u);
    };
    // Whether the step moves it; else nothing is left to do.
    const auto begin_to_finish = [&](uint body) {
        BodyPose& pose = state.poses[body];
        const bool moves = is_mover(state.shapes[body]);
        if (launch.args[2] == 1 && (moves || (pose.flags & k_body_disturbed) != 0)) state.loads[body] = no_load();
        pose.flags &= ~k_body_disturbed;
        if (moves && (pose.flags & k_body_frozen) == 0) return true;
        state.starts[body] = start_of_still(pose);
        const bool may_sleep = launch.args[0] == 1 && is_movable(state.shapes[body]); // what is frozen rests
        if (may_sleep) state.rests[body] = with_calm(state.rests[body], p.rest_steps);
        return false;
    };
    constexpr uint k_part = 64;
    const auto finish_part = [&](uint, uint first, uint end) {
        std::array<MovingBody, k_part> moving;
        uint count = 0;
        for (uint body = first; body < end; ++body) {
            if (is_asleep(state.poses[body]))
                finish_sleeper(body);
            else if (begin_to_finish(body))
                moving[count++] = {body, count_rest_of(state, body, is_noted(body, k_touched))};
        }
        for (std::uint64_t left = move_bodies(state, moving.data(), count); left != 0; left &= left - 1)
            freeze(state, moving[static_cast<uint>(std::countr_zero(left))].body);
    };
    state.parallel_parts(p.body_count, k_part, finish_part);
}

const Kernel finish_bodies{"finish/finish_bodies", finish_bodies_on_cpu};

} // namespace talus::engine
