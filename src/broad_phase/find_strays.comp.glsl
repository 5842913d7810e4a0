// SPDX-License-Identifier: MIT
// One invocation is a body slot: whether it has left the box that the last search for pairs had of it. Then it is a stray, whose
// pairs are searched for anew. Where there are many strays, or there have been since the list was made, or many pairs have been added
// to it, or it is not of these slots, all pairs are. Also whether any body is awake, where some may sleep.
// args.x: 1 where bodies are in a tree.
// Reads: Poses, Velocities, Shapes, OrientedBoxes.
// Writes: Counters; Strays, in any order; StrayMarks and NearTable, which is empty then, unless all are searched for.
// Needs: nothing.
// Overflow: none; after a step that did not fit nothing is searched for, as it will be done again with the pairs that it
// had.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"
#include "broad_phase/strays.shared.glsl"
#include "resolution/sleep.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer OrientedBoxes { OrientedBoxCells oriented_boxes[]; };
layout(std430) coherent buffer Counters { uint counters[]; };
layout(std430) writeonly buffer Strays { uint strays[]; };
layout(std430) writeonly buffer StrayMarks { uint stray_marks[]; };
layout(std430) writeonly buffer NearTable { uint near_table[]; };

#include "broad_phase/box_now.glsl"

void note_if_awake(uint body)
{
    if (counters[k_counter_awake] != 0u) return;
    if (is_awake(unpack(poses[body]), unpack(velocities[body]), unpack(shapes[body]), parameters))
        counters[k_counter_awake] = 1u; // all write the same
}

void main()
{
    uint body = item_index();
    if (body >= parameters.body_count || counters[k_counter_did_not_fit] != 0u) return;
    bool may_sleep = parameters.rest_steps > 0u;
    bool asleep = may_sleep && is_asleep(unpack(poses[body]));
    if (may_sleep && !asleep) note_if_awake(body);
    if (counters[k_counter_search_count] != 0u) return; // it is known already
    for (uint slot = body; slot < near_table_size(parameters.body_count); slot += parameters.body_count)
        near_table[slot] = k_none;
    stray_marks[body] = 0u;
    bool other_list = counters[k_counter_searched_slots] != parameters.body_count;
    if (!other_list && asleep) return; // where it was
    if (!other_list && is_within(box_now(body), unpack(oriented_boxes[body]))) return;
    bool takes_all = other_list || has_aged(counters[k_counter_added_pairs], counters[k_counter_pair_demand],
                                            counters[k_counter_all_strays], parameters.body_count);
    uint most = most_strays(parameters.body_count, args.x == 1u);
    bool are_many = counters[k_counter_stray_count] >= most; // known without adding to what all add to
    uint place = takes_all || are_many ? most : atomicAdd(counters[k_counter_stray_count], 1u);
    if (place >= most) {
        counters[k_counter_search_count] = parameters.body_count; // all write the same
        return;
    }
    strays[place] = body;
    stray_marks[body] = k_stray;
}
