// SPDX-License-Identifier: MIT
// One invocation is a body slot: wakes a body that the caller has changed, and lets the step's other kernels know of it. One that
// the caller has removed sleeps no more either: its contacts end.
// Launched only in a step before which something has changed. args.x: 1 wakes all.
// Reads: Counters, Loads, Shapes.
// Writes: Poses (flags).
// Needs: nothing.
// Overflow: after a step that did not fit nothing is written: this one will be made again.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/sleep.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Loads { BodyLoadCells loads[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) buffer Poses { BodyPoseCells poses[]; };

void main()
{
    uint body = item_index();
    if (body >= parameters.body_count || counters[k_counter_did_not_fit] != 0u) return;
    bool disturbed = unpack(loads[body]).disturbed != 0u;
    BodyPose pose = unpack(poses[body]);
    bool is_gone = is_asleep(pose) && !is_present(unpack(shapes[body]));
    if (!disturbed && !is_gone && args.x == 0u) return;
    pose.flags = wake_flags(pose.flags) | (disturbed ? k_body_disturbed : 0u);
    poses[body] = pack(pose);
}
