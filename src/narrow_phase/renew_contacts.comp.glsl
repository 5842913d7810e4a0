// SPDX-License-Identifier: MIT
// One invocation is a pair. Where the contact of the last step lasts it is this one's, and where the bodies are apart there is none;
// all other pairs are listed. Of two bodies that sleep, or stand, for two steps the contact is there, as it is written where it was two
// steps ago; of others of which one sleeps and nothing moves it is copied.
// args.x: 1 where constraints have not been written over what was there. args.y: 1 where those are
// listed, too, that have nearly had their way (most_way).
// Reads: Counters, Pairs, Poses, Velocities, Shapes, Starts, PairTable, OldManifolds, OldManifoldPoints, OldPointSeparations,
// OldPointImpulses.
// Writes: Manifolds, PointImpulses, ManifoldPoints and PointSeparations of pairs that are not listed; PairsToCollide, in any order, with
// k_had_contact where they had one; Counters, where two bodies touch no longer.
// Needs: barriers after plan_pairs and fill_pair_table.
// Overflow: none; the list has room for every pair.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"
#include "resolution/sleep.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/load.shared.glsl"
#include "resolution/contact_frame.shared.glsl"
#include "narrow_phase/contact_geometry.shared.glsl"
#include "narrow_phase/box_axes.shared.glsl"
#include "narrow_phase/manifold.shared.glsl"
#include "narrow_phase/pair_table.shared.glsl"
#include "finish/body_start.shared.glsl"
#include "narrow_phase/lasting_contact.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) buffer Counters { uint counters[]; };
layout(std430) readonly buffer Pairs { Pair pairs[]; };
layout(std430) writeonly buffer PairsToCollide { uint pairs_to_collide[]; };
layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Starts { BodyStartCells starts[]; };
layout(std430) readonly buffer PairTable { uint pair_table[]; };
layout(std430) readonly buffer OldManifolds { ManifoldCells old_manifolds[]; };
layout(std430) readonly buffer OldManifoldPoints { ManifoldPointCells old_manifold_points[]; };
layout(std430) readonly buffer OldPointSeparations { SeparationsCells old_point_separations[]; };
layout(std430) readonly buffer OldPointImpulses { NormalImpulsesCells old_point_impulses[]; };
layout(std430) writeonly buffer Manifolds { ManifoldCells manifolds[]; };
layout(std430) writeonly buffer ManifoldPoints { ManifoldPointCells manifold_points[]; };
layout(std430) writeonly buffer PointSeparations { SeparationsCells point_separations[]; };
layout(std430) writeonly buffer PointImpulses { NormalImpulsesCells point_impulses[]; };

#include "narrow_phase/find_old_manifold.glsl"
#include "narrow_phase/old_contact.glsl"

shared uint listed_count; // of the group
shared uint first_listed;

// Whether the pairs had their places in the list two steps ago. Those of strays may have been added since; but a body of these has moved,
// and is not settled.
bool is_old_list() { return !has_other_pairs() && counters[k_counter_same_list] != 0u; }

// The last step's contact of the pair, as it lies at its place.
struct OldContact {
    Manifold manifold;
    ManifoldPoint point_0;
    ManifoldPoint point_1;
    ManifoldPoint point_2;
    ManifoldPoint point_3;
    Separations separations;
    NormalImpulses impulses;
};

// All of it, whether it is there or not, so that no load waits for another.
OldContact load_old(uint place)
{
    OldContact old;
    old.manifold = unpack(old_manifolds[place]);
    old.point_0 = unpack(old_manifold_points[4u * place]);
    old.point_1 = unpack(old_manifold_points[4u * place + 1u]);
    old.point_2 = unpack(old_manifold_points[4u * place + 2u]);
    old.point_3 = unpack(old_manifold_points[4u * place + 3u]);
    old.separations = unpack(old_point_separations[place]);
    old.impulses = unpack(old_point_impulses[place]);
    return old;
}

// Of two bodies that sleep.
void keep(uint pair_index, OldContact old)
{
    uint count = old.manifold.point_count;
    manifolds[pair_index] = pack(old.manifold);
    point_impulses[pair_index] = pack(old.impulses);
    point_separations[pair_index] = pack(old.separations);
    put_point(pair_index, 0u, count, old.point_0.anchor, old.point_0.feature_id);
    put_point(pair_index, 1u, count, old.point_1.anchor, old.point_1.feature_id);
    put_point(pair_index, 2u, count, old.point_2.anchor, old.point_2.feature_id);
    put_point(pair_index, 3u, count, old.point_3.anchor, old.point_3.feature_id);
}

// How two bodies have moved in the last step, and how they are about to move.
struct PairMovement {
    Movement a;
    Movement b;
    Movement ahead_a;
    Movement ahead_b;
    vec3 offset; // m, from A's centre to B's, before the last step
    vec3 motion; // m, of B as seen from A, in this step
};

// Whether the contact lasts; then it is this step's.
bool renew(uint pair_index, OldContact old, PairMovement m, LastingAxis axis, BodyShape shape_a, BodyShape shape_b)
{
    vec3 anchor_0 = old.point_0.anchor;
    vec3 anchor_1 = old.point_1.anchor;
    vec3 anchor_2 = old.point_2.anchor;
    vec3 anchor_3 = old.point_3.anchor;
    uint count = old.manifold.point_count;
    MeetingPoint meeting = meeting_point(anchor_0, m.offset, shape_a, shape_b);
    float way = way_after(old.separations, way_between(m.a, m.b, meeting), axis.leverage);
    Manifold manifold = lasting_manifold(old.manifold, axis.normal, parameters);
    vec3 n = axis.normal;
    vec4 opening = vec4(opening_at(n, anchor_0, m.offset, m.a, m.b), opening_at(n, anchor_1, m.offset, m.a, m.b),
                        opening_at(n, anchor_2, m.offset, m.a, m.b), opening_at(n, anchor_3, m.offset, m.a, m.b));
    Separations separations = lasting_separations(old.separations, opening, way, count);
    float most = most_way(args.y == 1u, parameters);
    bool lasts = was_found_in_place(old.separations) && stays(way, m.ahead_a, m.ahead_b, meeting, axis.leverage, most) &&
                 is_within_reach(separations, count, m.motion, parameters);
    if (!lasts) return false;
    manifolds[pair_index] = pack(manifold);
    point_impulses[pair_index] = pack(old.impulses);
    point_separations[pair_index] = pack(separations);
    put_point(pair_index, 0u, count, lasting_anchor(anchor_0, m.offset, m.a, m.b), old.point_0.feature_id);
    put_point(pair_index, 1u, count, lasting_anchor(anchor_1, m.offset, m.a, m.b), old.point_1.feature_id);
    put_point(pair_index, 2u, count, lasting_anchor(anchor_2, m.offset, m.a, m.b), old.point_2.feature_id);
    put_point(pair_index, 3u, count, lasting_anchor(anchor_3, m.offset, m.a, m.b), old.point_3.feature_id);
    return true;
}

// What is to be listed; k_none: the contact of the pair is there, or has been written.
uint treat(uint pair_index)
{
    Pair pair = pairs[pair_index];
    BodyPose pose_a = unpack(poses[pair.body_a]);
    BodyPose pose_b = unpack(poses[pair.body_b]);
    if (args.x == 1u && is_old_list() && are_settled(pose_a, pose_b)) return k_none;
    uint place = pair_index;
    if (has_other_pairs()) place = find_old_manifold(pair.body_a, pair.body_b);
    OldContact old = load_old(place == k_none ? 0u : place);
    BodyShape shape_a = unpack(shapes[pair.body_a]);
    BodyShape shape_b = unpack(shapes[pair.body_b]);
    BodyVelocity velocity_a = unpack(velocities[pair.body_a]);
    BodyVelocity velocity_b = unpack(velocities[pair.body_b]);
    BodyStart start_a = unpack(starts[pair.body_a]);
    BodyStart start_b = unpack(starts[pair.body_b]);

    bool is_found = place != k_none && (has_other_pairs() || was_listed(pair_index));
    bool touched = is_found && old.manifold.point_count > 0u;
    float gap = is_found && !touched ? old.manifold.weights : 0.0;
    if (parameters.rest_steps > 0u && sleep_on(pose_a, velocity_a, shape_a, pose_b, velocity_b, shape_b)) {
        if (touched)
            keep(pair_index, old);
        else
            put_none(pair_index, pair, gap);
        return k_none;
    }

    PairMovement m;
    m.a = last_movement(pose_a, start_a);
    m.b = last_movement(pose_b, start_b);
    m.ahead_a = next_movement(velocity_a, parameters);
    m.ahead_b = next_movement(velocity_b, parameters);
    m.offset = offset_at_meeting(start_a.position, start_b.position, vec3(0.0));
    m.motion = motion_between(velocity_a, velocity_b, parameters);
    bool may = may_last(start_a, shape_a, start_b, shape_b);
    // The search saw boxes with a skin.
    Aabb box_a = compute_aabb(make_oriented_box(pose_a, velocity_a, shape_a, parameters));
    Aabb box_b = compute_aabb(make_oriented_box(pose_b, velocity_b, shape_b, parameters));
    if (touched && is_still_candidate(box_a, box_b)) {
        LastingAxis axis = lasting_axis(old.manifold, m.a, m.b, pose_a, pose_b);
        bool renewed = may && renew(pair_index, old, m, axis, shape_a, shape_b);
        return renewed ? k_none : pair_index | k_had_contact;
    }
    gap = may ? gap_after(gap, way_between(m.a, m.b, centre_of_smaller(m.offset, shape_a, shape_b))) : 0.0;
    if (is_candidate(box_a, box_b) && !is_surely_apart(gap, m.motion, parameters)) return pair_index;
    put_none(pair_index, pair, gap);
    compare_with_last(pair_index, no_manifold(pair, 0.0));
    return k_none;
}

void main()
{
    bool is_first = gl_LocalInvocationID.x == 0u;
    if (is_first) listed_count = 0u;
    barrier();
    uint to_list = item_index() < counters[k_counter_pair_count] ? treat(item_index()) : k_none;
    uint place = to_list != k_none ? atomicAdd(listed_count, 1u) : 0u;
    barrier();
    if (is_first && listed_count > 0u) first_listed = atomicAdd(counters[k_counter_pairs_to_collide], listed_count);
    barrier();
    if (to_list != k_none) pairs_to_collide[first_listed + place] = to_list;
}
