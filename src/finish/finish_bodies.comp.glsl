// SPDX-License-Identifier: MIT
// One invocation is a body slot: its new pose, and no load for the next step. A body that would become non-finite stays
// where it was and is frozen. The first one also makes this step's pairs the last step's.
// Reads: Shapes, Deltas, Counters.
// Writes: Poses, Loads, Counters; Velocities where a body is frozen.
// Needs: a barrier after the last pass of the solver.
// Overflow: none; launched empty after a step that did not fit.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/body.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Shapes { BodyShape shapes[]; };
layout(std430) readonly buffer Deltas { BodyDelta deltas[]; };
layout(std430) buffer Poses { BodyPose poses[]; };
layout(std430) writeonly buffer Loads { BodyLoad loads[]; };
layout(std430) buffer Velocities { BodyVelocity velocities[]; };
layout(std430) buffer Counters { uint counters[]; };

void main()
{
    uint body = item_index();
    if (body >= parameters.body_count) return;
    if (body == 0u) counters[k_counter_old_pair_count] = counters[k_counter_pair_count];
    if (!is_mover(shapes[body])) return;
    loads[body] = no_load();
    BodyPose pose = poses[body];
    if ((pose.flags & k_body_frozen) != 0u) return;
    BodyPose moved = apply_delta(pose, deltas[body]);
    if (is_finite_motion(moved, velocities[body])) {
        poses[body] = moved;
    } else {
        poses[body].flags = pose.flags | k_body_frozen;
        velocities[body] = frozen_velocity();
        atomicAdd(counters[k_counter_frozen_bodies], 1u);
    }
}
