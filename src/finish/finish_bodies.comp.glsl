// SPDX-License-Identifier: MIT
// One invocation is a body slot: its new pose, for how long it has rested, and no load for the next step. A body that would
// become non-finite stays where it was and is frozen; one that sleeps is left alone. Where each was is kept for whoever asks
// for the step's contacts. The first invocation also makes this step's pairs the last step's.
// Reads: Shapes, Deltas, Counters.
// Writes: Starts; Poses, Loads, Rests, Counters; Velocities where a body is frozen or too fast.
// Needs: a barrier after the last pass of the solver.
// Overflow: none; launched empty after a step that did not fit, and does nothing after one that went wrong.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/sleep.shared.glsl"
#include "resolution/body.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Deltas { BodyDeltaCells deltas[]; };
layout(std430) buffer Rests { BodyRestCells rests[]; };
layout(std430) writeonly buffer Starts { BodyStartCells starts[]; };
layout(std430) buffer Poses { BodyPoseCells poses[]; };
layout(std430) buffer Loads { BodyLoadCells loads[]; };
layout(std430) buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) buffer Counters { uint counters[]; };

void main()
{
    uint body = item_index();
    if ((counters[k_counter_did_not_fit] & k_fit_groups) != 0u) return;
    if (body == 0u) {
        counters[k_counter_old_pair_count] = counters[k_counter_pair_count];
        counters[k_counter_pairs_changed] = 0u;
    }
    if (body >= parameters.body_count) return;
    BodyPose pose = unpack(poses[body]);
    starts[body] = pack(start_at(pose));
    if (is_asleep(pose)) return;
    bool moves = is_mover(unpack(shapes[body]));
    bool disturbed = (pose.flags & k_body_disturbed) != 0u;
    if (moves || disturbed) loads[body] = pack(no_load());
    pose.flags &= ~k_body_disturbed;
    if (!moves || (pose.flags & k_body_frozen) != 0u) {
        if (disturbed) poses[body] = pack(pose);
        return;
    }
    BodyPose moved = apply_delta(pose, unpack(deltas[body]));
    bool may_rest = parameters.rest_steps > 0u && is_movable(unpack(shapes[body]));
    if (may_rest) {
        NextRest next = next_rest(pose, moved, unpack(deltas[body]), unpack(rests[body]), unpack(shapes[body]), parameters);
        moved.flags = next.flags;
        rests[body] = pack(next.rest);
    } else {
        moved.flags = wake_flags(moved.flags);
    }
    BodyVelocity velocity = unpack(velocities[body]);
    if (is_finite_motion(moved, velocity)) {
        poses[body] = pack(moved);
        BodyVelocity limited = limit_speeds(velocity, parameters);
        if (limited != velocity) velocities[body] = pack(limited);
    } else {
        pose.flags |= k_body_frozen;
        poses[body] = pack(pose);
        velocities[body] = pack(frozen_velocity());
        atomicAdd(counters[k_counter_frozen_bodies], 1u);
    }
}
