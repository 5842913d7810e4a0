// SPDX-License-Identifier: MIT
// One group: islands, the sets of rigid bodies that contacts join, by hooking the larger root to the smaller one and
// pointer jumping. An island is named by its lowest body slot, whoever comes first. Bodies that touch nothing share an
// island: they are many, and each has next to nothing to do. An island has as many sub-steps as the manifold of it that
// asks for most; none where all that is part of it rests. What sleeps is part of no island that is solved.
// args.x: 1 makes one island of all bodies that move. args.y: 1 puts the island into the manifolds' keys.
// Reads: Counters, Shapes, Poses, Velocities; ManifoldKeys, the colours.
// Writes: Islands, Substeps; ManifoldKeys, island and colour; Counters; Manifolds, the colour of what sleeps.
// Needs: a barrier after assign_colours. At most k_island_bodies body slots.
// Overflow: none.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/sleep.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/load.shared.glsl"
#include "resolution/island.shared.glsl"

layout(local_size_x = 1024) in;

layout(std430) buffer Counters { uint counters[]; };
layout(std430) buffer Manifolds { Manifold manifolds[]; };
layout(std430) readonly buffer Shapes { BodyShape shapes[]; };
layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) writeonly buffer Islands { uint islands[]; };
layout(std430) writeonly buffer Substeps { uint substeps[]; };
layout(std430) buffer ManifoldKeys { uint manifold_keys[]; };

shared uint roots[k_island_bodies];
shared bool touches[k_island_bodies];
shared bool restless[k_island_bodies]; // of an island: any of it
shared uint most_substeps[k_island_bodies];
shared uint manifold_counts[k_island_bodies];
shared uint largest;
shared uint first_mover; // of those that touch nothing; of all, if all are one island
shared bool changed;

// The two bodies that a pair's contact joins; body 0 twice where it joins none. What has a root can be pushed.
uvec2 joined_by(uint pair)
{
    uint body_a = manifolds[pair].body_a;
    uint body_b = manifolds[pair].body_b;
    if (!is_active(manifolds[pair])) return uvec2(0u);
    touches[body_a] = true;
    touches[body_b] = true;
    if (roots[body_a] == k_none && restless[body_a]) restless[body_b] = true;
    if (roots[body_b] == k_none && restless[body_b]) restless[body_a] = true;
    return roots[body_a] != k_none && roots[body_b] != k_none ? uvec2(body_a, body_b) : uvec2(0u);
}

void hook(uvec2 bodies)
{
    uint root_a = roots[bodies.x];
    uint root_b = roots[bodies.y];
    if (root_a == root_b) return;
    atomicMin(roots[max(root_a, root_b)], min(root_a, root_b));
    changed = true;
}

// The last two bodies of the chain meet in a root, which points at itself.
uint root_of(uint body)
{
    uint root = body;
    while (roots[root] != root) root = roots[root];
    return root;
}

void main()
{
    uint me = gl_LocalInvocationID.x;
    if (counters[k_counter_graph_bodies] == 0u) return;
    uint pair_count = counters[k_counter_graph_pairs];
    if (me == 0u) {
        first_mover = k_none;
        largest = 0u;
    }
    barrier();
    for (uint body = me; body < parameters.body_count; body += gl_WorkGroupSize.x) {
        roots[body] = is_movable(shapes[body]) ? body : k_none;
        touches[body] = false;
        restless[body] =
            parameters.rest_steps == 0u ||
            is_restless(unpack(poses[body]), unpack(velocities[body]), shapes[body], parameters);
        most_substeps[body] = parameters.least_substeps;
        manifold_counts[body] = 0u;
    }
    barrier();
    // One island of all that is awake: which that is the true islands tell, where anything may sleep.
    bool done = args.x == 1u && parameters.rest_steps == 0u;
    // Each round hooks the same pairs: most worlds have no more than can be kept.
    uvec2 first = uvec2(0u);
    uvec2 second = uvec2(0u);
    if (!done && me < pair_count) first = joined_by(me);
    if (!done && me + gl_WorkGroupSize.x < pair_count) second = joined_by(me + gl_WorkGroupSize.x);
    while (!done) {
        barrier();
        if (me == 0u) changed = false;
        barrier();
        hook(first);
        hook(second);
        for (uint pair = me + 2u * gl_WorkGroupSize.x; pair < pair_count; pair += gl_WorkGroupSize.x)
            hook(joined_by(pair));
        barrier();
        for (uint body = me; body < parameters.body_count; body += gl_WorkGroupSize.x) {
            if (roots[body] != k_none) roots[body] = root_of(body);
        }
        barrier();
        done = !changed;
    }
    barrier();
    // What leads an island is restless where any of it is.
    for (uint body = me; body < parameters.body_count; body += gl_WorkGroupSize.x) {
        if (roots[body] != k_none && restless[body]) restless[roots[body]] = true;
    }
    barrier();
    for (uint body = me; body < parameters.body_count; body += gl_WorkGroupSize.x) {
        if (is_movable(shapes[body]) && restless[roots[body]]) restless[body] = true;
    }
    barrier();
    for (uint body = me; body < parameters.body_count; body += gl_WorkGroupSize.x) {
        if (is_movable(shapes[body]) && !restless[body]) {
            roots[body] = k_none;
            continue;
        }
        bool is_single = args.x == 1u ? is_mover(shapes[body]) : roots[body] != k_none && !touches[body];
        if (is_single) atomicMin(first_mover, body);
    }
    barrier();
    for (uint body = me; body < parameters.body_count; body += gl_WorkGroupSize.x) {
        bool is_awake = is_mover(shapes[body]) && (roots[body] != k_none || !is_movable(shapes[body]));
        if (is_awake && (args.x == 1u || !touches[body])) roots[body] = first_mover;
    }
    barrier();

    for (uint pair = me; pair < pair_count; pair += gl_WorkGroupSize.x) {
        uint colour = manifold_keys[pair];
        uint island = k_island_bodies; // after all others
        if (colour != k_inactive_colour) {
            uint body_a = manifolds[pair].body_a;
            island = roots[is_movable(shapes[body_a]) ? body_a : manifolds[pair].body_b];
            if (island != k_none) {
                atomicMax(most_substeps[island], substeps_of(manifolds[pair].demand));
                atomicAdd(manifold_counts[island], 1u);
            } else { // it sleeps, and wakes with the colour that it has
                manifolds[pair].colour = colour;
                atomicAdd(counters[k_counter_sleeping_manifolds], 1u);
                island = k_island_bodies;
                colour = k_inactive_colour;
            }
        }
        manifold_keys[pair] = args.y == 1u ? manifold_key(island, colour) : colour;
    }
    barrier();
    for (uint body = me; body < parameters.body_count; body += gl_WorkGroupSize.x) {
        islands[body] = roots[body];
        substeps[body] = roots[body] == k_none ? 0u : most_substeps[roots[body]];
        atomicMax(largest, manifold_counts[body]);
    }
    barrier();
    if (me == 0u) counters[k_counter_largest_island] = largest;
}
