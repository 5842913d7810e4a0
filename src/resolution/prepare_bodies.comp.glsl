// SPDX-License-Identifier: MIT
// One invocation is a body slot: its inertia in world axes, its number of sub-steps; no movement and no warm start yet.
// Where it is to sleep it stops, and is left alone.
// args.x: 1 where islands have numbers of their own. args.y: 1 where work groups solve several islands. args.z: 1 where something
// bounces.
// Reads: Counters, Poses, Velocities, Properties, Loads, Shapes, Substeps, IslandGroups, BodyColours.
// Writes: Inertias, Deltas, WarmStarts (and no hits behind them), ToldLoads (none yet); LaunchedBodies, in any order, and
// Counters; Poses (flags), Velocities and Rests where a body falls asleep or wakes.
// Needs: a barrier after find_islands, group_islands or keep_colours.
// Overflow: none; launched empty after a step that did not fit.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/sleep.shared.glsl"
#include "resolution/body.shared.glsl"
#include "resolution/multirate.shared.glsl"
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
layout(std430) buffer Counters { uint counters[]; };
layout(std430) readonly buffer BodyColours { uint body_colours[]; };
layout(std430) writeonly buffer LaunchedBodies { uint launched_bodies[]; };
layout(std430) writeonly buffer Inertias { BodyInertiaCells inertias[]; };
layout(std430) writeonly buffer Deltas { BodyDeltaCells deltas[]; };
layout(std430) writeonly buffer ToldLoads { uint told_loads[]; };
layout(std430) writeonly buffer WarmStarts { BodyWarmStartCells warm_starts[]; };

void main()
{
    uint body = item_index();
    if (body >= parameters.body_count) return;
    if (args.z == 1u) warm_starts[hits_place(body, parameters.body_count)] = pack(no_warm_start()); // all zero, as no_hits
    told_loads[k_told_words * body + k_told_mass] = 0u;
    told_loads[k_told_words * body + k_told_height] = 0u;
    BodyPose pose = unpack(poses[body]);
    bool asleep = parameters.rest_steps > 0u && is_movable(unpack(shapes[body])) && substeps[body] == 0u;
    uint flags = sleep_flags(pose.flags, asleep);
    if (flags != pose.flags) {
        pose.flags = flags;
        poses[body] = pack(pose);
        if (asleep) {
            velocities[body] = pack(stop(unpack(velocities[body])));
            rests[body] = pack(with_calm(unpack(rests[body]), parameters.rest_steps));
        }
    }
    deltas[body] = pack(no_delta());
    uint traits = traits_of_body(unpack(shapes[body]), pose);
    vec3 inverse_inertia = unpack(properties[body]).inverse_inertia;
    if (asleep) {
        inertias[body] = pack(inertia_asleep(pose.rotation, inverse_inertia, traits));
        atomicAdd(counters[k_counter_sleeping_bodies], 1u);
        return;
    }
    uint ticks = counters[k_counter_launched_substeps];
    uint word = args.x == 1u ? substeps[body] : ticks;
    uint its_substeps = number_of_substeps(word);
    BodyInertia inertia = world_inertia(pose.rotation, inverse_inertia, traits, its_substeps);
    inertia.traits |= traits_in_graph(inertia.traits, body_colours[body_word(body, k_used_low)],
                                      body_colours[body_word(body, k_used_high)], body_colours[body_word(body, k_hub_word)]);
    if (word != its_substeps) inertia.traits |= slowness_trait(ticks, its_substeps);
    if (is_loaded(unpack(loads[body]))) inertia.traits |= k_trait_loaded;
    if (args.y == 1u && island_groups[body] != k_launched) inertia.traits |= k_trait_grouped;
    inertias[body] = pack(inertia);
    if (is_in_launched_bodies(inertia))
        launched_bodies[atomicAdd(counters[k_counter_launched_bodies], 1u)] = body;
    warm_starts[body] = pack(kept_warm_start(no_warm_start(), unpack(velocities[body])));
}
