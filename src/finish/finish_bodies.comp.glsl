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

layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Deltas { BodyDeltaCells deltas[]; };
layout(std430) buffer Poses { BodyPoseCells poses[]; };
layout(std430) writeonly buffer Loads { BodyLoadCells loads[]; };
layout(std430) buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) buffer Counters { uint counters[]; };

void main()
{
    uint body = item_index();
    if (body >= parameters.body_count) return;
    if (body == 0u) counters[k_counter_old_pair_count] = counters[k_counter_pair_count];
    if (!is_mover(unpack(shapes[body]))) return;
    loads[body] = pack(no_load());
    BodyPose pose = unpack(poses[body]);
    if ((pose.flags & k_body_frozen) != 0u) return;
    BodyPose moved = apply_delta(pose, unpack(deltas[body]));
    if (is_finite_motion(moved, unpack(velocities[body]))) {
        poses[body] = pack(moved);
    } else {
        pose.flags |= k_body_frozen;
        poses[body] = pack(pose);
        velocities[body] = pack(frozen_velocity());
        atomicAdd(counters[k_counter_frozen_bodies], 1u);
    }
}
