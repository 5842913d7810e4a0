// SPDX-License-Identifier: MIT
// One invocation is a pair of the last step: where the caller has changed or removed one of two bodies that touched, the
// other one wakes. They may touch no longer, so that the contacts of this step would not tell.
// Reads: Counters, OldManifolds, Shapes.
// Writes: Poses (flags), which it reads too.
// Needs: a barrier after wake_bodies.
// Overflow: after a step that did not fit nothing is written: this one will be made again.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/sleep.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer OldManifolds { ManifoldCells old_manifolds[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) buffer Poses { BodyPoseCells poses[]; };

bool has_changed(uint body)
{
    if (body >= parameters.body_count || !is_present(unpack(shapes[body]))) return true;
    return (unpack(poses[body]).flags & k_body_disturbed) != 0u;
}

// Others may do the same.
void wake(uint body)
{
    if (body >= parameters.body_count) return;
    BodyPose pose = unpack(poses[body]);
    if (!is_asleep(pose)) return;
    pose.flags = wake_flags(pose.flags);
    poses[body] = pack(pose);
}

void main()
{
    uint pair = item_index();
    if (pair >= counters[k_counter_old_pair_count] || counters[k_counter_did_not_fit] != 0u) return;
    Manifold manifold = unpack(old_manifolds[pair]);
    if (manifold.point_count == 0u) return;
    if (has_changed(manifold.body_a)) wake(manifold.body_b);
    if (has_changed(manifold.body_b)) wake(manifold.body_a);
}
