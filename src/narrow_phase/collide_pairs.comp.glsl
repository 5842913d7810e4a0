// SPDX-License-Identifier: MIT
// One invocation is a candidate pair: its manifold, with the impulses of the last step (thesis, section 3.3). Of a pair in
// which a body sleeps and nothing moves it is the last step's.
// args.x: 1 where pairs are listed, as all others have their contacts already (list_unsettled_pairs).
// Reads: Counters, Pairs, UnsettledPairs, Poses, Velocities, Shapes, Properties, PairTable, OldManifolds, OldManifoldPoints,
// OldPointImpulses; of a pair that sleeps OldPointSeparations.
// Writes: Manifolds, one a pair, with point_count 0 where the two do not touch; PointImpulses; where they touch or sleep
// ManifoldPoints and PointSeparations; Counters, where two bodies touch that did not in the last step, or touch no longer, by which the
// constraint graph is another one, and where they touch at fewer or more points.
// Needs: barriers after plan_pairs and fill_pair_table.
// Overflow: none.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"
#include "resolution/sleep.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/load.shared.glsl"
#include "resolution/contact_frame.shared.glsl"
#include "narrow_phase/contact_geometry.shared.glsl"
#include "narrow_phase/polygon.glsl"
#include "narrow_phase/box_axes.shared.glsl"
#include "narrow_phase/collide_boxes.shared.glsl"
#include "narrow_phase/collide_spheres.shared.glsl"
#include "narrow_phase/manifold.shared.glsl"
#include "narrow_phase/look_ahead.shared.glsl"
#include "narrow_phase/pair_table.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) buffer Counters { uint counters[]; };
layout(std430) readonly buffer Pairs { Pair pairs[]; };
layout(std430) readonly buffer UnsettledPairs { uint unsettled_pairs[]; };
layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Properties { BodyPropertiesCells properties[]; };
layout(std430) readonly buffer PairTable { uint pair_table[]; };
layout(std430) readonly buffer OldManifolds { ManifoldCells old_manifolds[]; };
layout(std430) readonly buffer OldManifoldPoints { ManifoldPointCells old_manifold_points[]; };
layout(std430) readonly buffer OldPointSeparations { SeparationsCells old_point_separations[]; };
layout(std430) readonly buffer OldPointImpulses { NormalImpulsesCells old_point_impulses[]; };
layout(std430) writeonly buffer Manifolds { ManifoldCells manifolds[]; };
layout(std430) writeonly buffer ManifoldPoints { ManifoldPointCells manifold_points[]; };
layout(std430) writeonly buffer PointSeparations { SeparationsCells point_separations[]; };
layout(std430) writeonly buffer PointImpulses { NormalImpulsesCells point_impulses[]; };

#include "broad_phase/box_now.glsl"
#include "narrow_phase/find_old_manifold.glsl"

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

// Of most bodies that sleep nothing else is loaded.
bool stays(uint body, BodyPose pose)
{
    if (is_asleep(pose)) return true;
    return is_left_alone(pose, unpack(velocities[body]), unpack(shapes[body]));
}

bool sleeps(uint body_a, uint body_b)
{
    BodyPose pose_a = unpack(poses[body_a]);
    BodyPose pose_b = unpack(poses[body_b]);
    if (!is_asleep(pose_a) && !is_asleep(pose_b)) return false;
    return stays(body_a, pose_a) && stays(body_b, pose_b);
}

void put_impulses(uint pair_index, vec4 normal)
{
    NormalImpulses impulses;
    impulses.normal = normal;
    point_impulses[pair_index] = pack(impulses);
}

void put_point(uint pair_index, uint i, uint count, vec3 anchor, uint feature)
{
    if (i < count) manifold_points[4u * pair_index + i] = pack(make_point(anchor, feature));
}

void put_none(uint pair_index, Pair pair)
{
    manifolds[pair_index] = pack(no_manifold(pair));
    put_impulses(pair_index, vec4(0.0));
}

void keep_manifold(uint pair_index, Pair pair, uint old_index)
{
    if (old_index == k_none) { // they were apart
        put_none(pair_index, pair);
        return;
    }
    manifolds[pair_index] = old_manifolds[old_index];
    point_separations[pair_index] = old_point_separations[old_index];
    point_impulses[pair_index] = old_point_impulses[old_index];
    uint count = unpack(old_manifolds[old_index]).point_count;
    for (uint i = 0u; i < 4u; ++i) {
        if (i < count) manifold_points[4u * pair_index + i] = old_manifold_points[4u * old_index + i];
    }
}

// Pairs that have been added come behind those of the last step.
bool was_listed(uint pair_index) { return pair_index < counters[k_counter_old_pair_count]; }

uint old_manifold_of(uint pair_index, Pair pair)
{
    if (counters[k_counter_pairs_changed] != 0u) return find_old_manifold(pair.body_a, pair.body_b);
    return was_listed(pair_index) && unpack(old_manifolds[pair_index]).point_count > 0u ? pair_index : k_none;
}

void compare_with_last(uint pair_index, Manifold manifold)
{
    if (counters[k_counter_pairs_changed] != 0u) return;
    Manifold old = unpack(old_manifolds[pair_index]);
    if ((was_listed(pair_index) && is_active(old)) != is_active(manifold))
        counters[k_counter_graph_due] = 1u;
    else if (is_active(manifold) && manifold.point_count != old.point_count)
        atomicAdd(counters[k_counter_contact_count], manifold.point_count - old.point_count);
}

void main()
{
    uint pair_index = item_index();
    if (pair_index >= counters[args.x == 1u ? k_counter_unsettled_pairs : k_counter_pair_count]) return;
    if (args.x == 1u) pair_index = unsettled_pairs[pair_index];
    Pair pair = pairs[pair_index];
    if (parameters.rest_steps > 0u && sleeps(pair.body_a, pair.body_b)) {
        keep_manifold(pair_index, pair, old_manifold_of(pair_index, pair));
        return;
    }
    // The search saw boxes with a skin.
    Aabb box_a = compute_aabb(box_now(pair.body_a));
    Aabb box_b = compute_aabb(box_now(pair.body_b));
    uint old_index = k_none;
    if (is_still_candidate(box_a, box_b)) old_index = old_manifold_of(pair_index, pair);
    if (old_index == k_none && !is_candidate(box_a, box_b)) {
        put_none(pair_index, pair);
        compare_with_last(pair_index, no_manifold(pair));
        return;
    }
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
    if (sensed && !can_meet(shape_a, shape_b)) g.count = 0u;
    if (g.count == 0u) {
        put_none(pair_index, pair);
        compare_with_last(pair_index, no_manifold(pair));
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
