// SPDX-License-Identifier: MIT
// One invocation is a body slot: an island of its own, of the least sub-steps, if contacts can push it. What is restless
// is awake.
// Reads: Shapes, Poses, Velocities.
// Writes: Islands, Substeps, IslandSizes, IslandStarts, IslandFill; Counters, as kinematic bodies move by launches.
// Needs: nothing.
// Overflow: none.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/sleep.shared.glsl"
#include "resolution/island.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) writeonly buffer Islands { uint islands[]; };
layout(std430) writeonly buffer Substeps { uint substeps[]; };
layout(std430) writeonly buffer IslandSizes { uint island_sizes[]; };
layout(std430) writeonly buffer IslandStarts { uint island_starts[]; };
layout(std430) writeonly buffer IslandFill { uint island_fill[]; };
layout(std430) buffer Counters { uint counters[]; };

void main()
{
    uint body = item_index();
    if (body >= parameters.body_count) return;
    islands[body] = is_movable(unpack(shapes[body])) ? body : k_none;
    substeps[body] = parameters.least_substeps;
    island_sizes[body] = 0u;
    island_starts[body] = 0u;
    bool restless = parameters.rest_steps == 0u || is_restless(unpack(poses[body]), unpack(velocities[body]),
                                                               unpack(shapes[body]), parameters);
    island_fill[body] = restless ? k_awake : 0u;
    if (is_mover(unpack(shapes[body])) && !is_movable(unpack(shapes[body])))
        atomicMax(counters[k_counter_launched_substeps], parameters.least_substeps);
}
