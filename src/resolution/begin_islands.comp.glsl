// SPDX-License-Identifier: MIT
// One invocation is a body slot: an island of its own, of the least sub-steps, if contacts can push it.
// Reads: Shapes.
// Writes: Islands, Substeps, IslandSizes, IslandStarts, IslandFill.
// Needs: nothing.
// Overflow: none.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) writeonly buffer Islands { uint islands[]; };
layout(std430) writeonly buffer Substeps { uint substeps[]; };
layout(std430) writeonly buffer IslandSizes { uint island_sizes[]; };
layout(std430) writeonly buffer IslandStarts { uint island_starts[]; };
layout(std430) writeonly buffer IslandFill { uint island_fill[]; };

void main()
{
    uint body = item_index();
    if (body >= parameters.body_count) return;
    islands[body] = is_movable(unpack(shapes[body])) ? body : k_none;
    substeps[body] = parameters.least_substeps;
    island_sizes[body] = 0u;
    island_starts[body] = 0u;
    island_fill[body] = 0u;
}
