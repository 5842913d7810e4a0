// SPDX-License-Identifier: MIT
// Where the last step's constraint graph is not this one's: the first invocation sets the counts to nothing, and plans the launches
// that make it. Each is a body slot: no colour in use, no rank seen, no hub; and an island of its own, of the fewest sub-steps, if
// contacts can push it. Where bodies may sleep, who is restless, and who is quiet. Where the graph lasts these launches, and those that
// follow, do nothing.
// args.x: 1 where islands are measured. args.y: 1 where parts of them may sleep.
// Reads: Shapes, Poses, Velocities.
// Writes: BodyColours, Islands, Substeps, IslandSizes, IslandStarts, IslandFill; Counters, Dispatches.
// Needs: a barrier after collide_pairs, which may find that the graph is due.
// Overflow: none; after a step that did not fit there are no pairs.
#include "state/math.shared.glsl"
#include "state/dispatch.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/sleep.shared.glsl"
#include "resolution/island.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) writeonly buffer BodyColours { uint body_colours[]; };
layout(std430) writeonly buffer Islands { uint islands[]; };
layout(std430) writeonly buffer Substeps { uint substeps[]; };
layout(std430) writeonly buffer IslandSizes { uint island_sizes[]; };
layout(std430) writeonly buffer IslandStarts { uint island_starts[]; };
layout(std430) writeonly buffer IslandFill { uint island_fill[]; };
layout(std430) buffer Counters { uint counters[]; };
layout(std430) writeonly buffer Dispatches { Dispatch dispatches[]; };

void plan_launches(bool due)
{
    uint pair_count = due ? counters[k_counter_pair_count] : 0u;
    counters[k_counter_graph_bodies] = due ? parameters.body_count : 0u;
    counters[k_counter_graph_pairs] = pair_count;
    dispatches[k_dispatch_graph_pairs] = groups_for(pair_count, k_group_size);
    dispatches[k_dispatch_graph_tiles] = groups_for(pair_count, k_sort_tile);
    dispatches[k_dispatch_graph_counts] = groups_for(pair_count, k_count_group);
}

void count_nothing()
{
    counters[k_counter_manifold_count] = 0u;
    counters[k_counter_contact_count] = 0u;
    counters[k_counter_colour_demand] = 0u;
    counters[k_counter_overflow_count] = 0u;
    counters[k_counter_uncoloured] = 0u;
    counters[k_counter_doubtful] = 0u;
    counters[k_counter_given_up] = 0u;
    counters[k_counter_hub_count] = 0u;
    counters[k_counter_hub_manifolds] = 0u;
    counters[k_counter_launched_colours] = 0u;
    counters[k_counter_launched_substeps] = 0u;
    counters[k_counter_launched_overflow] = 0u;
    counters[k_counter_multirate_islands] = 0u;
    counters[k_counter_low_islands] = 0u;
    counters[k_counter_sleeping_manifolds] = 0u;
    counters[k_counter_singles] = 0u;
    counters[k_counter_largest_island] = 0u;
    counters[k_counter_substep_demand] = parameters.least_substeps;
}

void begin_island(uint body)
{
    BodyShape shape = unpack(shapes[body]);
    islands[body] = is_movable(shape) ? body : k_none;
    substeps[body] = parameters.fewest_substeps;
    island_sizes[body] = 0u;
    island_starts[body] = 0u;
    island_fill[body] = 0u;
    if (parameters.rest_steps == 0u) return;
    BodyPose pose = unpack(poses[body]);
    // Where all pairs have been searched for, what parts stand for is found anew.
    bool quiet = args.y == 1u && counters[k_counter_pairs_changed] == 0u && is_quiet_part(pose);
    bool restless = !quiet && is_restless(pose, unpack(velocities[body]), shape, parameters);
    quiet = quiet || (args.y == 1u && !is_movable(shape) && !restless);
    island_fill[body] = (restless ? k_restless : 0u) | (quiet ? k_quiet : 0u);
}

void main()
{
    uint body = item_index();
    bool due = counters[k_counter_graph_due] != 0u;
    if (body == 0u) {
        plan_launches(due);
        if (due) count_nothing();
    }
    if (!due) return;
    // Neighbouring invocations write neighbouring words.
    uint first = body_word(group_index() * gl_WorkGroupSize.x, 0u) + gl_LocalInvocationID.x;
    for (uint i = 0u; i < k_body_words; ++i) {
        uint word = first + i * gl_WorkGroupSize.x;
        if (word < body_word(parameters.body_count, 0u)) body_colours[word] = 0u;
    }
    if (body >= parameters.body_count) return;
    if (args.x == 1u) begin_island(body);
}
