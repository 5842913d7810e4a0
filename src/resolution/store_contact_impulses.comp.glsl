// SPDX-License-Identifier: MIT
// One invocation is a pair that the constraint graph was made of: its impulses and its colour go back to where the next step, and the
// caller, find them. The load on it decides how many sub-steps it asks for next.
// args.x: 1 where the graph was made of ListedPairs. args.y: 1 where something may bounce. args.z: 1 where islands may be
// multirate.
// Reads: Counters, Constraints, WarmStarts (hits), ManifoldKeys, ManifoldPlaces, ListedPairs, ToldLoads.
// Writes: PointImpulses; Manifolds (friction impulses, colour, load, sub-steps); Counters, where an island may get other
// sub-steps; Constraints (total impulses), where something may bounce.
// Needs: a barrier after the last pass of the solver.
// Overflow: none; launched empty after a step that did not fit.
#include "state/math.shared.glsl"
#include "resolution/body.shared.glsl"
#include "resolution/contact_frame.shared.glsl"
#include "resolution/softness.shared.glsl"
#include "resolution/multirate.shared.glsl"
#include "resolution/load.shared.glsl"
#include "resolution/manifold_rows.shared.glsl"
#include "resolution/hub.shared.glsl"
#include "resolution/island.shared.glsl"
#include "resolution/contact_counts.shared.glsl"
#include "resolution/contact_constraint.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) buffer Counters { uint counters[]; };
layout(std430) buffer Constraints { ContactConstraintCellBlock constraints[]; };
layout(std430) buffer WarmStarts { BodyWarmStartCells warm_starts[]; };
layout(std430) readonly buffer ManifoldKeys { uint manifold_keys[]; };
layout(std430) readonly buffer ManifoldPlaces { uint manifold_places[]; };
layout(std430) readonly buffer ListedPairs { uint listed_pairs[]; };
layout(std430) readonly buffer ToldLoads { uint told_loads[]; };
layout(std430) buffer Manifolds { ManifoldCells manifolds[]; };
layout(std430) writeonly buffer PointImpulses { NormalImpulsesCells point_impulses[]; };

#include "resolution/stored_contact_hits.glsl"

void main()
{
    uint entry = item_index();
    if (entry >= counters[k_counter_ordered_pairs]) return;
    uint index = manifold_places[entry];
    if (index >= counters[k_counter_manifold_count]) return; // they do not touch, or sleep
    uint pair = args.x == 1u ? listed_pairs[entry] : entry;
    Manifold manifold = unpack(manifolds[pair]);
    ContactConstraint c = unpack_ContactConstraint(constraints, index);
    NormalImpulses impulses;
    impulses.normal = vec4(0.0);
    for (uint i = 0u; i < 4u; ++i) {
        if (i >= point_count_of(c.counts)) continue;
        impulses.normal[i] = impulse_of_step(c.normal_impulse[i], c.total_impulse[i], substeps_of_contact(c.counts));
    }
    point_impulses[pair] = pack(impulses);
    if (args.y == 1u) {
        vec4 whole = with_hits(c.total_impulse, load_contact_hits(index));
        cell_in_block(constraints, index, k_first_changing + 3u) = floatBitsToUint(whole);
    }
    manifold.colour = colour_of_step(manifold_keys[index], c.traits);
    Standing standing = find_standing(c.normal, c.centre_a, c.centre_b, c.gap, parameters);
    uint above = k_told_words * body_above(standing, c.body_a, c.body_b);
    uint below = body_below(standing, c.body_a, c.body_b);
    Manifold finished = finish_manifold(manifold, c, standing, impulses.normal, told_loads[above + k_told_mass],
                                        told_loads[above + k_told_height], told_loads[k_told_words * below + k_told_mass],
                                        told_loads[told_foot_word(below, parameters.body_count)], parameters);
    manifolds[pair] = pack(finished);
    if (!asks_alike(finished.demand, manifold.demand, substeps_of_contact(c.counts), args.z == 1u))
        counters[k_counter_graph_due] = 1u; // of the next step
}
