// SPDX-License-Identifier: MIT
// One invocation is a candidate pair: its manifold, with the impulses of the last step (thesis, section 3.3).
// Reads: Counters, Pairs, Poses, Velocities, Shapes, Properties, PairTable, OldManifolds,
// OldManifoldPoints.
// Writes: Manifolds, one a pair, with point_count 0 where the two do not touch; ManifoldPoints.
// Needs: barriers after plan_pairs and fill_pair_table.
// Overflow: none.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/softness.shared.glsl"
#include "resolution/tangents.shared.glsl"
#include "narrow_phase/contact_geometry.shared.glsl"
#include "narrow_phase/collide_boxes.shared.glsl"
#include "narrow_phase/collide_spheres.shared.glsl"
#include "narrow_phase/manifold.shared.glsl"
#include "narrow_phase/look_ahead.shared.glsl"
#include "narrow_phase/pair_table.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Pairs { Pair pairs[]; };
layout(std430) readonly buffer Poses { BodyPose poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocity velocities[]; };
layout(std430) readonly buffer Shapes { BodyShape shapes[]; };
layout(std430) readonly buffer Properties { BodyProperties properties[]; };
layout(std430) readonly buffer PairTable { uint pair_table[]; };
layout(std430) readonly buffer OldManifolds { Manifold old_manifolds[]; };
layout(std430) readonly buffer OldManifoldPoints { ManifoldPoint old_manifold_points[]; };
layout(std430) writeonly buffer Manifolds { Manifold manifolds[]; };
layout(std430) writeonly buffer ManifoldPoints { ManifoldPoint manifold_points[]; };

// The last step's manifold of a pair, or k_none.
uint find_old_manifold(Pair pair)
{
    uint slot = hash_pair(pair.body_a, pair.body_b) & (parameters.table_size - 1u);
    while (true) {
        uint old = pair_table[slot];
        if (old == k_none) return k_none;
        if (old_manifolds[old].body_a == pair.body_a && old_manifolds[old].body_b == pair.body_b) return old;
        slot = (slot + 1u) & (parameters.table_size - 1u);
    }
    return k_none;
}

void main()
{
    uint pair_index = item_index();
    if (pair_index >= counters[k_counter_pair_count]) return;
    Pair pair = pairs[pair_index];

    uint old_index = find_old_manifold(pair);
    uint old_colour = k_no_colour;
    Manifold old;
    OldPoints old_points = no_old_points();
    if (old_index != k_none) {
        old = old_manifolds[old_index];
        old_colour = old.colour;
        old_points.axis = old.axis;
        old_points.count = old.point_count;
        for (uint i = 0u; i < old.point_count; ++i) {
            old_points.anchors[i] = old_manifold_points[4u * old_index + i].anchor_a;
            old_points.features[i] = old_manifold_points[4u * old_index + i].feature_id;
            old_points.impulses[i] = old_manifold_points[4u * old_index + i].normal_impulse;
        }
    }

    BodyPose pose_a = poses[pair.body_a];
    BodyPose pose_b = poses[pair.body_b];
    precise vec3 offset = pose_b.position - pose_a.position;
    precise vec3 motion = (velocities[pair.body_b].linear - velocities[pair.body_a].linear) * parameters.dt;
    precise float max_separation = parameters.speculative_distance + length3(motion);
    ContactGeometry g = collide_moving_shapes(pose_a, shapes[pair.body_a], pose_b, shapes[pair.body_b], motion,
                                              old_points, max_separation);
    Manifold manifold = make_manifold(pair, g, old_colour, properties[pair.body_a], properties[pair.body_b]);
    if (old_index != k_none)
        manifold = carry_over(manifold, old, parameters);
    else if (is_placed(pose_a, shapes[pair.body_a]) && is_placed(pose_b, shapes[pair.body_b]))
        manifold = begin_trial(manifold, parameters);
    manifolds[pair_index] = manifold;

    PointMatch match = match_points(g, old_points);
    for (uint i = 0u; i < g.count; ++i) {
        ManifoldPoint point = make_point(g, pose_a.position, offset, i);
        if (match.old_index[i] != k_none) point.normal_impulse = old_points.impulses[match.old_index[i]];
        manifold_points[4u * pair_index + i] = point;
    }
}
