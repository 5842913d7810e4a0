// SPDX-License-Identifier: MIT
// One invocation is a pair whose contact does not last: its manifold, with the impulses of the last step (thesis, section 3.3).
// Reads: Counters, Pairs, PairsToCollide, Poses, Velocities, Shapes, Properties, PairTable, OldManifolds, OldManifoldPoints,
// OldPointImpulses.
// Writes: Manifolds, with point_count 0 where the two do not touch; PointImpulses; where they touch ManifoldPoints and PointSeparations;
// Counters, where two bodies touch that did not in the last step, or touch no longer, by which the constraint graph is another one, and
// where they touch at fewer or more points.
// Needs: a barrier after renew_contacts.
// Overflow: none.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/load.shared.glsl"
#include "resolution/contact_frame.shared.glsl"
#include "narrow_phase/contact_geometry.shared.glsl"
#include "narrow_phase/polygon.glsl"
#include "narrow_phase/box_axes.shared.glsl"
#include "narrow_phase/collide_boxes.shared.glsl"
#include "narrow_phase/collide_spheres.shared.glsl"
#include "narrow_phase/collide_shapes.shared.glsl"
#include "narrow_phase/carried_impulses.shared.glsl"
#include "narrow_phase/manifold.shared.glsl"
#include "narrow_phase/look_ahead.shared.glsl"
#include "narrow_phase/pair_table.shared.glsl"
#include "finish/body_start.shared.glsl"
#include "narrow_phase/lasting_contact.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) buffer Counters { uint counters[]; };
layout(std430) readonly buffer Pairs { Pair pairs[]; };
layout(std430) readonly buffer PairsToCollide { uint pairs_to_collide[]; };
layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Properties { BodyPropertiesCells properties[]; };
layout(std430) readonly buffer PairTable { uint pair_table[]; };
layout(std430) readonly buffer OldManifolds { ManifoldCells old_manifolds[]; };
layout(std430) readonly buffer OldManifoldPoints { ManifoldPointCells old_manifold_points[]; };
layout(std430) readonly buffer OldPointImpulses { NormalImpulsesCells old_point_impulses[]; };
layout(std430) writeonly buffer Manifolds { ManifoldCells manifolds[]; };
layout(std430) writeonly buffer ManifoldPoints { ManifoldPointCells manifold_points[]; };
layout(std430) writeonly buffer PointSeparations { SeparationsCells point_separations[]; };
layout(std430) writeonly buffer PointImpulses { NormalImpulsesCells point_impulses[]; };

#include "narrow_phase/find_old_manifold.glsl"
#include "narrow_phase/old_contact.glsl"

ManifoldPoint old_point(uint old_index, uint i) { return unpack(old_manifold_points[4u * old_index + i]); }

// All four points are loaded, whether they are there or not, so that no load waits for another.
OldPoints read_old_points(uint old_index)
{
    Manifold old = unpack(old_manifolds[old_index]);
    vec4 impulses = unpack(old_point_impulses[old_index]).normal;
    ManifoldPoint point_0 = old_point(old_index, 0u);
    ManifoldPoint point_1 = old_point(old_index, 1u);
    ManifoldPoint point_2 = old_point(old_index, 2u);
    ManifoldPoint point_3 = old_point(old_index, 3u);
    OldPoints points;
    points.axis = old.axis;
    points.count = old.point_count;
    points.anchors[0] = point_0.anchor;
    points.anchors[1] = point_1.anchor;
    points.anchors[2] = point_2.anchor;
    points.anchors[3] = point_3.anchor;
    points.features[0] = point_0.feature_id;
    points.features[1] = point_1.feature_id;
    points.features[2] = point_2.feature_id;
    points.features[3] = point_3.feature_id;
    points.impulses[0] = impulses.x;
    points.impulses[1] = impulses.y;
    points.impulses[2] = impulses.z;
    points.impulses[3] = impulses.w;
    return points;
}

void main()
{
    if (item_index() >= counters[k_counter_pairs_to_collide]) return;
    uint listed = pairs_to_collide[item_index()];
    uint pair_index = listed & ~k_had_contact;
    Pair pair = pairs[pair_index];
    uint old_index = k_none;
    if ((listed & k_had_contact) != 0u)
        old_index = has_other_pairs() ? find_old_manifold(pair.body_a, pair.body_b) : pair_index;
    Carriers carriers = no_carriers();
    if (old_index != k_none) carriers = carriers_of(read_old_points(old_index));

    BodyPose pose_a = unpack(poses[pair.body_a]);
    BodyPose pose_b = unpack(poses[pair.body_b]);
    BodyShape shape_a = unpack(shapes[pair.body_a]);
    BodyShape shape_b = unpack(shapes[pair.body_b]);
    vec3 motion = motion_between(unpack(velocities[pair.body_a]), unpack(velocities[pair.body_b]), parameters);
    float max_separation = contact_reach(motion, old_index != k_none, parameters);
    ContactGeometry g =
        collide_moving_shapes(pose_a, shape_a, pose_b, shape_b, motion, carriers, max_separation);
    bool sensed = is_sensed(shape_a, shape_b);
    if (sensed && !can_meet(shape_a, shape_b)) g = no_contact();
    if (g.count == 0u) {
        put_none(pair_index, pair, gap_without_points(g));
        compare_with_last(pair_index, no_manifold(pair, 0.0));
        return;
    }

    // The rest of the last manifold is read here, as registers are short in the collision.
    Manifold manifold = make_manifold(pair, g, unpack(properties[pair.body_a]), unpack(properties[pair.body_b]));
    vec4 impulses = vec4(0.0);
    if (old_index != k_none) {
        manifold = carry_over(manifold, unpack(old_manifolds[old_index]), parameters);
        impulses = carry_impulses(g, read_old_points(old_index));
    } else if (is_placed(pose_a, shape_a) && is_placed(pose_b, shape_b)) {
        manifold = begin_trial(manifold, parameters);
    }
    if (sensed) {
        manifold = make_sensed(manifold);
        impulses = vec4(0.0);
    }
    manifolds[pair_index] = pack(manifold);
    put_impulses(pair_index, impulses);
    compare_with_last(pair_index, manifold);
    point_separations[pair_index] = pack(make_separations(g));
    put_point(pair_index, 0u, g.count, g.points[0], g.features[0]);
    put_point(pair_index, 1u, g.count, g.points[1], g.features[1]);
    put_point(pair_index, 2u, g.count, g.points[2], g.features[2]);
    put_point(pair_index, 3u, g.count, g.points[3], g.features[3]);
}
