// SPDX-License-Identifier: MIT
// One invocation is a pair: a manifold that had a colour in the last step keeps it (what is left of a valid colouring
// is valid), a new one is listed as uncoloured, and so is a hub's, as its load changes. One that has kept a colour far down, or was
// lent the ground's, is listed from the end: assign_colours sees whether it may keep that, and counts it.
// Also counts manifolds and contact points. Each group counts, and finds places in the list, for all of its own at once.
// args.x: 1 where the graph is made of ListedPairs.
// Reads: Manifolds, PointImpulses, Shapes; ListedPairs, and Islands of those.
// Writes: ManifoldKeys (the colour, or the load on an uncoloured one), BodyColours, Uncoloured, Counters. The
// order of the list depends on who comes first; nothing that is made from it does.
// Needs: a barrier after begin_graph.
// Overflow: none; the list has room for every pair.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/load.shared.glsl"
#include "resolution/hub_load.shared.glsl"

layout(local_size_x = 1024) in; // k_count_group

layout(std430) readonly buffer Manifolds { ManifoldCells manifolds[]; };
layout(std430) readonly buffer Shapes { BodyShape shapes[]; };
layout(std430) writeonly buffer ManifoldKeys { uint manifold_keys[]; };
layout(std430) readonly buffer Islands { uint islands[]; };
layout(std430) readonly buffer ListedPairs { uint listed_pairs[]; };
layout(std430) buffer BodyColours { uint body_colours[]; };
layout(std430) writeonly buffer Uncoloured { uint uncoloured[]; };
layout(std430) buffer Counters { uint counters[]; };

#include "resolution/hub_load.glsl"
#include "resolution/raise_counter.glsl"

// What the group's manifolds add to the counters, and to the list.
shared uint manifold_count;
shared uint contact_count;
shared uint substep_demand;
shared uint colour_demand;
shared uint new_count;
shared uint doubtful_count;
shared uint first_new; // of the group's, its place
shared uint first_doubtful;

void use_colour(uint body, uint colour)
{
    if (!is_movable(shapes[body])) return;
    atomicOr(body_colours[body_word(body, used_word(colour))], used_bit(colour));
}

void want_colour(uint body, bool is_on_ground)
{
    if (!is_movable(shapes[body])) return;
    atomicAdd(body_colours[body_word(body, k_new_edges)], 1u);
    if (is_on_ground) atomicOr(body_colours[body_word(body, k_new_edges)], k_new_on_ground);
}

// Between two sleepers, of which something awake touches one: its colour is in use, and it keeps it whatever that is.
bool is_between_sleepers(Manifold manifold)
{
    return args.x == 1u && islands[manifold.body_a] == k_none && islands[manifold.body_b] == k_none;
}

// The entry to be listed; k_none: none.
uint keep_colour(uint pair)
{
    uint listed = k_none;
    Manifold manifold = unpack(manifolds[pair]);
    uint colour = k_inactive_colour;
    if (is_active(manifold)) {
        bool sleeps = is_between_sleepers(manifold);
        atomicAdd(manifold_count, 1u);
        atomicAdd(contact_count, manifold.point_count);
        if (!sleeps) atomicMax(substep_demand, substeps_of(manifold.demand));
        colour = manifold.colour;
        bool both_movable = is_movable(shapes[manifold.body_a]) && is_movable(shapes[manifold.body_b]);
        if (colour < parameters.usable_colours) {
            use_colour(manifold.body_a, colour);
            use_colour(manifold.body_b, colour);
            if (!sleeps && (is_far_down(colour) || is_lent(colour, both_movable)))
                listed = pair | k_has_kept;
            else if (!sleeps)
                atomicMax(colour_demand, colours_down_to(colour));
        } else if (!sleeps) {
            colour = floatBitsToUint(load_on(pair, manifold.point_count));
            listed = pair;
            want_colour(manifold.body_a, !both_movable);
            want_colour(manifold.body_b, !both_movable);
        }
    }
    manifold_keys[pair] = colour;
    return listed;
}

void main()
{
    bool is_first = gl_LocalInvocationID.x == 0u;
    if (is_first) {
        manifold_count = 0u;
        contact_count = 0u;
        substep_demand = 0u;
        colour_demand = 0u;
        new_count = 0u;
        doubtful_count = 0u;
    }
    barrier();
    uint entry = item_index();
    uint listed = k_none;
    if (entry < counters[k_counter_graph_pairs]) listed = keep_colour(args.x == 1u ? listed_pairs[entry] : entry);
    bool is_doubtful = listed != k_none && (listed & k_has_kept) != 0u;
    bool is_new = listed != k_none && !is_doubtful;
    uint place = 0u;
    if (is_new) place = atomicAdd(new_count, 1u);
    if (is_doubtful) place = atomicAdd(doubtful_count, 1u);
    barrier();
    if (is_first && new_count > 0u) first_new = atomicAdd(counters[k_counter_uncoloured], new_count);
    if (is_first && doubtful_count > 0u) first_doubtful = atomicAdd(counters[k_counter_doubtful], doubtful_count);
    barrier();
    if (is_new) uncoloured[first_new + place] = listed;
    if (is_doubtful) uncoloured[counters[k_counter_graph_pairs] - 1u - (first_doubtful + place)] = listed;
    if (!is_first || manifold_count == 0u) return;
    atomicAdd(counters[k_counter_manifold_count], manifold_count);
    atomicAdd(counters[k_counter_contact_count], contact_count);
    raise_counter(k_counter_substep_demand, substep_demand);
    raise_counter(k_counter_colour_demand, colour_demand);
}
