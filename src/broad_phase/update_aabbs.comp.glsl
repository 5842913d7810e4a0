// SPDX-License-Identifier: MIT
// One invocation is a body slot, or a stray: its box with a skin, and the bounding box of that.
// args.x: 1 for strays, where no more are searched for. args.y: 1 where they may have searched the tree.
// Reads: Counters, Poses, Velocities, Shapes, Strays.
// Writes: OrientedBoxes, Aabbs.
// Needs: a barrier after find_strays; for strays, after add_pairs.
// Overflow: where there was no room for the pairs of strays, or they had no launches, their boxes stay as they are.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"
#include "broad_phase/strays.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Strays { uint strays[]; };
layout(std430) writeonly buffer OrientedBoxes { OrientedBoxCells oriented_boxes[]; };
layout(std430) writeonly buffer Aabbs { AabbCells aabbs[]; };

#include "broad_phase/box_now.glsl"

uint strays_with_their_pairs()
{
    if (counters[k_counter_did_not_fit] != 0u) return 0u;
    return found_strays(counters[k_counter_stray_count], counters[k_counter_search_count], args.y == 1u);
}

void main()
{
    uint item = item_index();
    bool for_strays = args.x == 1u;
    if (item >= (for_strays ? strays_with_their_pairs() : counters[k_counter_search_count])) return;
    uint body = for_strays ? strays[item] : item;
    OrientedBox box = box_with_skin(body);
    oriented_boxes[body] = pack(box);
    aabbs[body] = pack(compute_aabb(box));
}
