// SPDX-License-Identifier: MIT
// CPU twin of finish_bodies.comp.glsl.
#include <algorithm>
#include <atomic>

#include "device/cpu/cpu_state.h"
#include "finish/finish.h"
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

static void finish_bodies_on_cpu(CpuState& state, const Launch& launch) {
    const Parameters& p = state.parameters;
    state.counters[k_counter_old_pair_count] = state.counters[k_counter_pair_count];
    state.counters[k_counter_same_list] = state.counters[k_counter_pairs_changed] == 0 ? 1 : 0;
    state.counters[k_counter_pairs_changed] = 0;
    const auto is_noted = [&](uint body, uint what) {
        return launch.args[0] == 1 && (state.island_fill[body] & what) != 0;
    };
    state.parallel(p.body_count, [&](uint body) {
        BodyPose& pose = state.poses[body];
        state.starts[body] = start_at(pose, pose);
        if (is_asleep(pose)) {
            if (!is_noted(body, k_pressed)) return;
            if (!is_in_balance(state, body) && (pose.flags & k_body_frozen) == 0) {
                state.rests[body] = with_calm(state.rests[body], 0);
                pose.flags &= ~k_body_in_part;
            }
            std::fill_n(&state.balances[std::size_t{k_balance_words} * body], k_balance_words, 0u);
            return;
        }
        const bool moves = is_mover(state.shapes[body]);
        if (launch.args[2] == 1 && (moves || (pose.flags & k_body_disturbed) != 0)) state.loads[body] = no_load();
        pose.flags &= ~k_body_disturbed;
        if (!moves || (pose.flags & k_body_frozen) != 0) {
            const bool may_sleep = launch.args[0] == 1 && is_movable(state.shapes[body]); // what is frozen rests
            if (may_sleep) state.rests[body] = with_calm(state.rests[body], p.rest_steps);
            return;
        }
        BodyPose moved = apply_delta(pose, state.deltas[body]);
        const bool may_rest = p.rest_steps > 0 && is_movable(state.shapes[body]);
        if (may_rest) {
            const NextRest next = next_rest(pose, moved, state.deltas[body], state.rests[body],
                                            is_noted(body, k_touched), state.shapes[body], p);
            moved.flags = next.flags;
            state.rests[body] = next.rest;
        } else {
            moved.flags = wake_flags(moved.flags);
        }
        if (is_finite_motion(moved, state.velocities[body])) {
            state.starts[body] = start_at(pose, moved);
            pose = moved;
            BodyVelocity& velocity = state.velocities[body];
            velocity = limit_speeds(velocity, p);
        } else {
            pose.flags |= k_body_frozen;
            state.velocities[body] = frozen_velocity();
            std::atomic_ref(state.counters[k_counter_frozen_bodies]).fetch_add(1);
        }
    });
}

const Kernel finish_bodies{"finish/finish_bodies", finish_bodies_on_cpu};

} // namespace talus::engine
