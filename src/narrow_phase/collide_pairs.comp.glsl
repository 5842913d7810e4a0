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
#include "resolution/contact_frame.shared.glsl"
#include "narrow_phase/contact_geometry.shared.glsl"
#include "narrow_phase/collide_boxes.shared.glsl"
#include "narrow_phase/collide_spheres.shared.glsl"
#include "narrow_phase/manifold.shared.glsl"
#include "narrow_phase/look_ahead.shared.glsl"
#include "narrow_phase/pair_table.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Pairs { Pair pairs[]; };
layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Properties { BodyPropertiesCells properties[]; };
layout(std430) readonly buffer PairTable { uint pair_table[]; };
layout(std430) readonly buffer OldManifolds { ManifoldCells old_manifolds[]; };
layout(std430) readonly buffer OldManifoldPoints { ManifoldPointCells old_manifold_points[]; };
layout(std430) writeonly buffer Manifolds { ManifoldCells manifolds[]; };
layout(std430) writeonly buffer ManifoldPoints { ManifoldPointCells manifold_points[]; };

#include "narrow_phase/find_old_manifold.glsl"

Carriers read_carriers(uint old_index)
{
    Carriers carriers = no_carriers();
    carriers.axis = unpack(old_manifolds[old_index]).axis;
    uint count = unpack(old_manifolds[old_index]).point_count;
    for (uint i = 0u; i < count; ++i) {
        uint point = 4u * old_index + i;
        if (unpack(old_manifold_points[point]).normal_impulse > 0.0)
            carriers.features[i] = unpack(old_manifold_points[point]).feature_id;
    }
    return carriers;
}

OldPoints read_old_points(uint old_index)
{
    OldPoints old;
    old.axis = unpack(old_manifolds[old_index]).axis;
    old.count = unpack(old_manifolds[old_index]).point_count;
    for (uint i = 0u; i < old.count; ++i) {
        old.anchors[i] = unpack(old_manifold_points[4u * old_index + i]).anchor_a;
        old.features[i] = unpack(old_manifold_points[4u * old_index + i]).feature_id;
    }
    return old;
}

void main()
{
    uint pair_index = item_index();
    if (pair_index >= counters[k_counter_pair_count]) return;
    Pair pair = pairs[pair_index];
    uint old_index = find_old_manifold(pair.body_a, pair.body_b);
    Carriers carriers = no_carriers();
    if (old_index != k_none) carriers = read_carriers(old_index);

    BodyPose pose_a = unpack(poses[pair.body_a]);
    BodyPose pose_b = unpack(poses[pair.body_b]);
    BodyShape shape_a = unpack(shapes[pair.body_a]);
    BodyShape shape_b = unpack(shapes[pair.body_b]);
    precise vec3 offset = pose_b.position - pose_a.position;
    precise vec3 motion =
        (unpack(velocities[pair.body_b]).linear - unpack(velocities[pair.body_a]).linear) * parameters.dt;
    precise float max_separation = parameters.speculative_distance + length3(motion);
    ContactGeometry g =
        collide_moving_shapes(pose_a, shape_a, pose_b, shape_b, motion, carriers, max_separation);
    bool sensed = is_sensed(shape_a, shape_b);
    if (sensed && !can_meet(shape_a, shape_b)) g.count = 0u;

    // The rest of the last manifold is read here, as registers are short in the collision.
    Manifold manifold = make_manifold(pair, g, unpack(properties[pair.body_a]), unpack(properties[pair.body_b]));
    PointMatch match = no_match();
    if (old_index != k_none) {
        manifold = carry_over(manifold, unpack(old_manifolds[old_index]), parameters);
        match = match_points(g, read_old_points(old_index));
    } else if (is_placed(pose_a, shape_a) && is_placed(pose_b, shape_b)) {
        manifold = begin_trial(manifold, parameters);
    }
    if (sensed) manifold = make_sensed(manifold);
    manifolds[pair_index] = pack(manifold);
    for (uint i = 0u; i < g.count; ++i) {
        ManifoldPoint point = make_point(g, pose_a.position, offset, i);
        uint old_point = match.old_index[i];
        if (old_point != k_none && !sensed)
            point.normal_impulse = unpack(old_manifold_points[4u * old_index + old_point]).normal_impulse;
        manifold_points[4u * pair_index + i] = pack(point);
    }
}
