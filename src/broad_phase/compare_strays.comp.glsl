// SPDX-License-Identifier: MIT
// An invocation has some body slots: which strays these bodies are near to, of all or of those that search_strays has left. What was
// near already as the boxes are that the list was made of is in it, and is not found again.
// args.x: 1 where there is a tree.
// Reads: Counters, Poses, Velocities, Shapes, Strays, WideStrays, Aabbs, OrientedBoxes.
// Writes: NearPairs and NearTable, in any order; StrayMarks, of those that are near to somebody; Counters.
// Needs: a barrier after search_strays.
// Overflow: where strays are near to too many all are searched for.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"
#include "broad_phase/strays.shared.glsl"
#include "narrow_phase/pair_table.shared.glsl"

layout(local_size_x = 256) in;

layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Strays { uint strays[]; };
layout(std430) readonly buffer WideStrays { uint wide_strays[]; };
layout(std430) buffer StrayMarks { uint stray_marks[]; };
layout(std430) readonly buffer Aabbs { AabbCells aabbs[]; };
layout(std430) readonly buffer OrientedBoxes { OrientedBoxCells oriented_boxes[]; };
layout(std430) writeonly buffer NearPairs { Pair near_pairs[]; };
layout(std430) buffer NearTable { uint near_table[]; };
layout(std430) buffer Counters { uint counters[]; };

#include "broad_phase/box_now.glsl"
#include "broad_phase/note_near.glsl"

const uint k_tile = 64u;

shared bool searched_tree;
shared uint stray_count; // 0 where there is nothing to do
shared uint tile[k_tile];
shared OrientedBox oriented[k_tile]; // of these, as they are now
shared Aabb boxes[k_tile];

void count_strays()
{
    uint count = counters[k_counter_stray_count];
    uint search_count = counters[k_counter_search_count];
    searched_tree = args.x == 1u && strays_in_tree(count, search_count) > 0u;
    stray_count = searched_tree ? counters[k_counter_wide_strays] : count;
    if (search_count != 0u) stray_count = 0u;
}

void load_tile(uint first)
{
    uint me = gl_LocalInvocationID.x;
    if (me >= k_tile || first + me >= stray_count) return;
    tile[me] = searched_tree ? wide_strays[first + me] : strays[first + me];
    oriented[me] = box_with_skin(tile[me]);
    boxes[me] = compute_aabb(oriented[me]);
}

void compare_with_tile(uint body, uint count)
{
    Aabb box = unpack(aabbs[body]);
    if (stray_marks[body] != 0u) box = compute_aabb(box_with_skin(body));
    for (uint i = 0u; i < count; ++i)
        if (is_candidate(boxes[i], box)) look_at(tile[i], oriented[i], body);
}

void main()
{
    if (gl_LocalInvocationID.x == 0u) count_strays();
    barrier();
    uint invocations = gl_NumWorkGroups.x * gl_NumWorkGroups.y * gl_WorkGroupSize.x;
    for (uint first = 0u; first < stray_count; first += k_tile) {
        load_tile(first);
        barrier();
        for (uint body = item_index(); body < parameters.body_count; body += invocations)
            compare_with_tile(body, min(stray_count - first, k_tile));
        barrier();
    }
}
