// SPDX-License-Identifier: MIT
// One invocation is a body slot: its new pose, for how long it has rested, and no load for the next step. A body that would
// become non-finite stays where it was and is frozen; one that sleeps is left alone, and wakes with the next step where what presses
// on it has changed, and of that there are no sums any more. Where each was is kept for whoever asks for the step's contacts. The first
// invocation also makes this step's pairs the last step's.
// args.x: 1 where an island may sleep in parts. args.y: 1 where Starts holds what the last step wrote. args.z: 1 where there is
// room for loads.
// Reads: Shapes, Deltas, Counters; where an island may sleep in parts IslandFill, Balances, Properties.
// Writes: Starts; Poses, Loads, Rests, Balances, Counters; Velocities where a body is frozen or too fast.
// Needs: a barrier after the last pass of the solver.
// Overflow: none; launched empty after a step that did not fit, and does nothing after one that went wrong.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/sleep.shared.glsl"
#include "resolution/body.shared.glsl"
#include "resolution/contact_frame.shared.glsl"
#include "resolution/island.shared.glsl"
#include "resolution/balance.shared.glsl"
#include "finish/body_start.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Deltas { BodyDeltaCells deltas[]; };
layout(std430) buffer Rests { BodyRestCells rests[]; };
layout(std430) writeonly buffer Starts { BodyStartCells starts[]; };
layout(std430) buffer Poses { BodyPoseCells poses[]; };
layout(std430) buffer Loads { BodyLoadCells loads[]; };
layout(std430) buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) buffer Counters { uint counters[]; };
layout(std430) readonly buffer IslandFill { uint island_fill[]; };
layout(std430) buffer Balances { uint balances[]; };
layout(std430) readonly buffer Properties { BodyPropertiesCells properties[]; };

float balance_of(uint body, uint word) { return speed_of_balance(balances[k_balance_words * body + word]); }

vec3 balance3_of(uint body, uint word)
{
    return vec3(balance_of(body, word), balance_of(body, word + 1u), balance_of(body, word + 2u));
}

bool is_in_balance(uint body)
{
    return is_balanced(balance3_of(body, k_balance_impulse), balance3_of(body, k_balance_moment),
                       balance_of(body, k_balance_load), unpack(properties[body]).gravity_scale, parameters);
}

void main()
{
    uint body = item_index();
    if ((counters[k_counter_did_not_fit] & k_fit_groups) != 0u) return;
    if (body == 0u) {
        counters[k_counter_old_pair_count] = counters[k_counter_pair_count];
        counters[k_counter_same_list] = counters[k_counter_pairs_changed] == 0u ? 1u : 0u;
        counters[k_counter_pairs_changed] = 0u;
    }
    if (body >= parameters.body_count) return;
    BodyPose pose = unpack(poses[body]);
    bool is_kept = args.y == 1u && is_asleep(pose) && is_settled(pose);
    if (is_asleep(pose)) {
        if (!is_kept) starts[body] = pack(start_of_still(pose));
        bool is_weighed = args.x == 1u && (island_fill[body] & k_pressed) != 0u;
        if (is_weighed && !is_in_balance(body) && (pose.flags & k_body_frozen) == 0u) {
            rests[body] = pack(with_calm(unpack(rests[body]), 0u));
            pose.flags &= ~k_body_in_part;
            poses[body] = pack(pose);
        }
        for (uint word = 0u; is_weighed && word < k_balance_words; ++word)
            balances[k_balance_words * body + word] = 0u; // for the next step
        return;
    }
    bool moves = is_mover(unpack(shapes[body]));
    bool disturbed = (pose.flags & k_body_disturbed) != 0u;
    if (args.z == 1u && (moves || disturbed)) loads[body] = pack(no_load());
    pose.flags &= ~k_body_disturbed;
    if (!moves || (pose.flags & k_body_frozen) != 0u) {
        starts[body] = pack(start_of_still(pose));
        if (disturbed) poses[body] = pack(pose);
        bool may_sleep = args.x == 1u && is_movable(unpack(shapes[body])); // what is frozen rests
        if (may_sleep) rests[body] = pack(with_calm(unpack(rests[body]), parameters.rest_steps));
        return;
    }
    BodyDelta delta = unpack(deltas[body]);
    BodyPose moved = apply_delta(pose, delta);
    bool may_rest = parameters.rest_steps > 0u && is_movable(unpack(shapes[body]));
    if (may_rest) {
        bool touched = args.x == 1u && (island_fill[body] & k_touched) != 0u;
        NextRest next =
            next_rest(pose, moved, delta, unpack(rests[body]), touched, unpack(shapes[body]), parameters);
        moved.flags = next.flags;
        rests[body] = pack(next.rest);
    } else {
        moved.flags = wake_flags(moved.flags);
    }
    BodyVelocity velocity = unpack(velocities[body]);
    if (is_finite_motion(moved, velocity)) {
        starts[body] = pack(start_at(pose, moved));
        poses[body] = pack(moved);
        BodyVelocity limited = limit_speeds(velocity, parameters);
        if (limited != velocity) velocities[body] = pack(limited);
    } else {
        starts[body] = pack(start_of_still(pose));
        pose.flags |= k_body_frozen;
        poses[body] = pack(pose);
        velocities[body] = pack(frozen_velocity());
        atomicAdd(counters[k_counter_frozen_bodies], 1u);
    }
}
