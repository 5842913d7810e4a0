// SPDX-License-Identifier: MIT
// One invocation is a pair that the constraint graph was made of: the solver's record of its manifold, with effective masses, goes to
// its place in the order of the solve. What is read of a pair lies in the order of pairs, and bodies of pairs that follow each other
// are near each other; records are only written, so they can be far apart.
// args.x: 1 where the graph was made of ListedPairs. args.y: 1 where something may bounce.
// Reads: Counters, Poses, ManifoldKeys, ManifoldPlaces, ListedPairs, Manifolds, ManifoldPoints, PointSeparations, PointImpulses,
// BodyColours, Velocities, Inertias.
// Writes: Constraints, ToldLoads; WarmStarts, the contact's hits, where something may bounce.
// Needs: barriers after plan_colours and prepare_bodies.
// Overflow: none; launched empty after a step that did not fit.
#include "state/math.shared.glsl"
#include "resolution/body.shared.glsl"
#include "resolution/contact_counts.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/hub_load.shared.glsl"
#include "resolution/contact_frame.shared.glsl"
#include "resolution/softness.shared.glsl"
#include "resolution/multirate.shared.glsl"
#include "resolution/load.shared.glsl"
#include "resolution/manifold_rows.shared.glsl"
#include "resolution/hub.shared.glsl"
#include "resolution/island.shared.glsl"
#include "resolution/contact_constraint.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer ManifoldKeys { uint manifold_keys[]; };
layout(std430) readonly buffer ManifoldPlaces { uint manifold_places[]; };
layout(std430) readonly buffer ListedPairs { uint listed_pairs[]; };
layout(std430) readonly buffer Manifolds { ManifoldCells manifolds[]; };
layout(std430) readonly buffer BodyColours { uint body_colours[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) readonly buffer Inertias { BodyInertiaCells inertias[]; };
layout(std430) buffer ToldLoads { uint told_loads[]; };
layout(std430) writeonly buffer Constraints { ContactConstraintCellBlock constraints[]; };
layout(std430) buffer WarmStarts { BodyWarmStartCells warm_starts[]; };
layout(std430) readonly buffer ManifoldPoints { ManifoldPointCells manifold_points[]; };
layout(std430) readonly buffer PointSeparations { SeparationsCells point_separations[]; };

#include "resolution/hub_load.glsl"
#include "resolution/stored_contact_hits.glsl"

float share_of_contact(Manifold manifold, uint pair, uint colour)
{
    if (!is_hub_colour(colour)) return 1.0;
    bool of_a = (unpack(inertias[manifold.body_a]).traits & k_trait_hub) != 0u;
    uint hub = of_a ? manifold.body_a : manifold.body_b;
    uint part = part_of_load(manifold, load_on(pair, manifold.point_count), hub);
    uint shared_load = body_colours[body_word(hub, k_whole_load)] - body_colours[body_word(hub, k_unshared_load)];
    return share_of_hub(part, shared_load,
                        shares_of_hub(body_colours[body_word(hub, k_new_edges)], body_colours[body_word(hub, k_hub_word)]));
}

uint order_at(uint body, uint its_traits, uint colour, uint earlier_shift, uint last_shift)
{
    return order_at_body(is_pushed(its_traits), contacts_of_body(its_traits), body_colours[body_word(body, k_used_low)],
                         body_colours[body_word(body, k_used_high)], colour, earlier_shift, last_shift);
}

void tell_load(LoadBelow load, uint height)
{
    if (load.mass == 0u) return;
    atomicAdd(told_loads[k_told_words * load.body + k_told_mass], load.mass);
    atomicMax(told_loads[k_told_words * load.body + k_told_height], height);
}

void tell_foot(ToldFoot foot)
{
    if (foot.rate > 0u) atomicMax(told_loads[told_foot_word(foot.body, parameters.body_count)], foot.rate);
}

vec3 anchor_at(uint pair, uint i) { return unpack(manifold_points[4u * pair + i]).anchor; }

void main()
{
    uint entry = item_index();
    if (entry >= counters[k_counter_ordered_pairs]) return;
    uint index = manifold_places[entry];
    if (index >= counters[k_counter_manifold_count]) return; // they do not touch, or sleep
    uint pair = args.x == 1u ? listed_pairs[entry] : entry;
    // All that is known of the pair at once, and then of its bodies: loads behind a decision wait for what it is made from.
    Manifold manifold = unpack(manifolds[pair]);
    vec3 anchor_0 = anchor_at(pair, 0u);
    vec3 anchor_1 = anchor_at(pair, 1u);
    vec3 anchor_2 = anchor_at(pair, 2u);
    vec3 anchor_3 = anchor_at(pair, 3u);
    Separations separations = unpack(point_separations[pair]);
    vec4 impulses = unpack(point_impulses[pair]).normal;
    float inverse_mass_a = unpack(velocities[manifold.body_a]).inverse_mass;
    float inverse_mass_b = unpack(velocities[manifold.body_b]).inverse_mass;
    BodyInertia inertia_a = unpack(inertias[manifold.body_a]);
    BodyInertia inertia_b = unpack(inertias[manifold.body_b]);
    vec3 position_a = unpack(poses[manifold.body_a]).position;
    vec3 position_b = unpack(poses[manifold.body_b]).position;
    uint colour = colour_of_key(manifold_keys[index]);
    uint order = order_at(manifold.body_a, inertia_a.traits, colour, k_earlier_of_a, k_last_of_a) |
                 order_at(manifold.body_b, inertia_b.traits, colour, k_earlier_of_b, k_last_of_b);
    ContactConstraint c =
        begin_constraint(manifold, pair, colour, order, share_of_contact(manifold, pair, colour),
                         inverse_mass_a, inverse_mass_b, inertia_a, inertia_b, parameters);
    vec3 offset = offset_at_meeting(position_a, position_b, separations.shift);
    if (0u < manifold.point_count) c = add_to_centre(c, anchor_0, offset);
    if (1u < manifold.point_count) c = add_to_centre(c, anchor_1, offset);
    if (2u < manifold.point_count) c = add_to_centre(c, anchor_2, offset);
    if (3u < manifold.point_count) c = add_to_centre(c, anchor_3, offset);
    c = end_centre(c, position_a, position_b);
    Standing standing = find_standing(c.normal, c.centre_a, c.centre_b, c.gap, parameters);
    tell_load(load_below(manifold, standing, inverse_mass_a, inverse_mass_b), height_of(manifold.demand));
    tell_foot(told_foot(manifold, standing));
    Meeting meeting = make_meeting(c, inertia_a, inertia_b);
    c.friction_mass = friction_masses(meeting);
    NormalResponse response = respond_to_normals(meeting);
    if (0u < manifold.point_count)
        c = add_point(c, 0, anchor_0, separations.separation.x, impulses.x, meeting, response);
    if (1u < manifold.point_count)
        c = add_point(c, 1, anchor_1, separations.separation.y, impulses.y, meeting, response);
    if (2u < manifold.point_count)
        c = add_point(c, 2, anchor_2, separations.separation.z, impulses.z, meeting, response);
    if (3u < manifold.point_count)
        c = add_point(c, 3, anchor_3, separations.separation.w, impulses.w, meeting, response);
    float force = force_of(manifold.lasting_weights, inverse_mass_a, inverse_mass_b, parameters);
    c.base_separation =
        lifted_separation(c.base_separation, c.normal_mass, force, substeps_of_contact(c.counts), c.traits, parameters);
    pack_ContactConstraint(constraints, index, c);
    if (args.y == 1u) store_contact_hits(index, vec4(0.0));
}
