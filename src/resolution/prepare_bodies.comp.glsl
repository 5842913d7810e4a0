// SPDX-License-Identifier: MIT
// One invocation is a body slot: its inertia in world axes, its number of sub-steps; no movement and no warm start yet.
// Where it is to sleep it stops, and is left alone.
// args.x: 1 where islands have numbers of their own. args.y: 1 where work groups solve several islands. args.z: 1 where something
// bounces. args.w: k_with_records where the last step's records of bodies are there, k_with_parts where parts of islands may
// sleep, k_with_loads where there is room for loads.
// Reads: Counters, Poses, Velocities, Properties, Loads, Shapes, Substeps, IslandGroups, IslandSizes, BodyColours.
// Writes: Inertias, Deltas, WarmStarts (and no hits behind them), ToldLoads (none yet); LaunchedBodies, in any order, and
// Counters; Poses (flags), Velocities and Rests where a body falls asleep or wakes.
// Needs: a barrier after find_islands, group_islands or keep_colours.
// Overflow: none; launched empty after a step that did not fit.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/sleep.shared.glsl"
#include "resolution/body.shared.glsl"
#include "resolution/multirate.shared.glsl"
#include "resolution/load.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/island.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) buffer Poses { BodyPoseCells poses[]; };
layout(std430) buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) readonly buffer Properties { BodyPropertiesCells properties[]; };
layout(std430) readonly buffer Loads { BodyLoadCells loads[]; };
layout(std430) buffer Rests { BodyRestCells rests[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Substeps { uint substeps[]; };
layout(std430) readonly buffer IslandGroups { uint island_groups[]; };
layout(std430) readonly buffer IslandSizes { uint island_sizes[]; };
layout(std430) buffer Counters { uint counters[]; };
layout(std430) readonly buffer BodyColours { uint body_colours[]; };
layout(std430) writeonly buffer LaunchedBodies { uint launched_bodies[]; };
layout(std430) writeonly buffer Inertias { BodyInertiaCells inertias[]; };
layout(std430) writeonly buffer Deltas { BodyDeltaCells deltas[]; };
layout(std430) writeonly buffer ToldLoads { uint told_loads[]; };
layout(std430) writeonly buffer WarmStarts { BodyWarmStartCells warm_starts[]; };

// What the group's bodies add to the counters.
shared uint sleeper_count;
shared uint launched_count;
shared uint first_launched;

// `kept`: of a large island that it sleeps as a part of; 0 where it is of none.
void sleep_on(uint body, BodyPose before, uint kept)
{
    atomicAdd(sleeper_count, 1u);
    bool slept = is_asleep(before);
    bool was_in_part = (before.flags & k_body_in_part) != 0u;
    if (!slept) velocities[body] = pack(stop(unpack(velocities[body])));
    if (keeps_anew(kept, slept && was_in_part, counters[k_counter_pairs_changed] != 0u))
        rests[body] = pack(with_calm(unpack(rests[body]), kept));
    else if (!slept)
        rests[body] = pack(with_calm(unpack(rests[body]), parameters.rest_steps));
}

// Whether it is to be among the launched bodies.
bool prepare(uint body)
{
    BodyPose before = unpack(poses[body]);
    BodyShape shape = unpack(shapes[body]);
    uint own_substeps = substeps[body];
    if (args.z == 1u) warm_starts[hits_place(body, parameters.body_count)] = pack(no_warm_start()); // all zero, as no_hits
    told_loads[k_told_words * body + k_told_mass] = 0u;
    told_loads[k_told_words * body + k_told_height] = 0u;
    told_loads[told_foot_word(body, parameters.body_count)] = 0u;
    bool asleep = parameters.rest_steps > 0u && is_movable(shape) && own_substeps == 0u;
    uint kept = asleep && (args.w & k_with_parts) != 0u ? island_sizes[body] : 0u;
    BodyPose pose = before;
    pose.flags = flags_in_step(before, shape, asleep, kept != 0u, parameters);
    if (pose.flags != before.flags) poses[body] = pack(pose);
    if (asleep) sleep_on(body, before, kept);
    if (asleep && is_asleep(before) && (args.w & k_with_records) != 0u) return false;
    deltas[body] = pack(no_delta());
    uint traits = traits_of_body(shape, pose);
    vec3 inverse_inertia = unpack(properties[body]).inverse_inertia;
    if (asleep) {
        inertias[body] = pack(inertia_asleep(pose.rotation, inverse_inertia, traits));
        return false;
    }
    uint ticks = counters[k_counter_launched_substeps];
    uint word = args.x == 1u ? own_substeps : ticks;
    uint its_substeps = number_of_substeps(word);
    BodyInertia inertia = world_inertia(pose.rotation, inverse_inertia, traits, its_substeps);
    inertia.traits |= traits_in_graph(inertia.traits, body_colours[body_word(body, k_used_low)],
                                      body_colours[body_word(body, k_used_high)], body_colours[body_word(body, k_hub_word)]);
    if (word != its_substeps) inertia.traits |= slowness_trait(ticks, its_substeps);
    if ((word & k_multirate_tall) != 0u) inertia.traits |= k_trait_of_tall;
    if ((args.w & k_with_loads) != 0u && is_loaded(unpack(loads[body]))) inertia.traits |= k_trait_loaded;
    if (args.y == 1u && island_groups[body] != k_launched) inertia.traits |= k_trait_grouped;
    inertias[body] = pack(inertia);
    warm_starts[body] = pack(kept_warm_start(no_warm_start(), unpack(velocities[body])));
    return is_in_launched_bodies(inertia);
}

void main()
{
    bool is_first = gl_LocalInvocationID.x == 0u;
    if (is_first) {
        sleeper_count = 0u;
        launched_count = 0u;
    }
    barrier();
    bool launched = item_index() < parameters.body_count && prepare(item_index());
    uint place = launched ? atomicAdd(launched_count, 1u) : 0u;
    barrier();
    if (is_first && sleeper_count > 0u) atomicAdd(counters[k_counter_sleeping_bodies], sleeper_count);
    if (is_first && launched_count > 0u) first_launched = atomicAdd(counters[k_counter_launched_bodies], launched_count);
    barrier();
    if (launched) launched_bodies[first_launched + place] = item_index();
}
