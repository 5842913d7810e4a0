// SPDX-License-Identifier: MIT
// One invocation is a body slot: its inertia in world axes, its number of sub-steps; no movement and no warm start yet.
// args.x: 1 where islands have numbers of their own.
// Reads: Poses, Velocities, Properties, Shapes, Substeps, Counters, BodyColours.
// Writes: Inertias, Deltas, WarmStarts.
// Needs: a barrier after find_islands or keep_colours.
// Overflow: none; launched empty after a step that did not fit.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/body.shared.glsl"
#include "resolution/colouring.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Poses { BodyPose poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocity velocities[]; };
layout(std430) readonly buffer Properties { BodyProperties properties[]; };
layout(std430) readonly buffer Shapes { BodyShape shapes[]; };
layout(std430) readonly buffer Substeps { uint substeps[]; };
layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer BodyColours { uint body_colours[]; };
layout(std430) writeonly buffer Inertias { BodyInertia inertias[]; };
layout(std430) writeonly buffer Deltas { BodyDelta deltas[]; };
layout(std430) writeonly buffer WarmStarts { BodyWarmStart warm_starts[]; };

void main()
{
    uint body = item_index();
    if (body >= parameters.body_count) return;
    BodyPose pose = poses[body];
    bool movable = is_movable(shapes[body]) && (pose.flags & k_body_frozen) == 0u;
    uint its_substeps = args.x == 1u ? substeps[body] : counters[k_counter_substep_demand];
    BodyInertia inertia = world_inertia(pose.rotation, properties[body].inverse_inertia, movable,
                                        is_sphere(shapes[body]), its_substeps);
    inertia.traits |= hub_traits(body_colours[body_word(body, k_hub_word)]);
    inertias[body] = inertia;
    deltas[body] = no_delta();
    warm_starts[body] = no_warm_start(velocities[body]);
}
