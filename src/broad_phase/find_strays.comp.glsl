// SPDX-License-Identifier: MIT
// One invocation is a body slot: whether it has left the box that the last search for pairs had of it. Then pairs are
// searched for anew.
// Reads: Counters, Poses, Velocities, Shapes, OrientedBoxes.
// Writes: Counters.
// Needs: nothing.
// Overflow: none; after a step that did not fit nothing is searched for, as it will be done again with the pairs that it
// had.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer OrientedBoxes { OrientedBoxCells oriented_boxes[]; };
layout(std430) buffer Counters { uint counters[]; };

#include "broad_phase/box_now.glsl"

void main()
{
    uint body = item_index();
    if (body >= parameters.body_count || counters[k_counter_did_not_fit] != 0u) return;
    if (counters[k_counter_search_count] != 0u) return; // it is known already
    bool strays = counters[k_counter_searched_slots] != parameters.body_count;
    if (!strays) strays = !is_within(box_now(body), unpack(oriented_boxes[body]));
    if (strays) counters[k_counter_search_count] = parameters.body_count; // all write the same
}
