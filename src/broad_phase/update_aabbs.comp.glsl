// SPDX-License-Identifier: MIT
// One invocation is a body slot: its box with a skin, and the bounding box of that.
// Reads: Counters, Poses, Velocities, Shapes.
// Writes: OrientedBoxes, Aabbs.
// Needs: a barrier after find_strays.
// Overflow: none.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) writeonly buffer OrientedBoxes { OrientedBoxCells oriented_boxes[]; };
layout(std430) writeonly buffer Aabbs { AabbCells aabbs[]; };

#include "broad_phase/box_now.glsl"

void main()
{
    uint body = item_index();
    if (body >= counters[k_counter_search_count]) return;
    OrientedBox box = box_with_skin(body);
    oriented_boxes[body] = pack(box);
    aabbs[body] = pack(compute_aabb(box));
}
