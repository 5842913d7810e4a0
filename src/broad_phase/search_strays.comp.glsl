// SPDX-License-Identifier: MIT
// An invocation has some body slots: which strays a body is near to. Of two strays the one with the higher slot finds the pair. What was
// near already as the boxes are that the list was made of is in it, and is not found again.
// Reads: Counters, Poses, Velocities, Shapes, Strays, StrayMarks, Aabbs, OrientedBoxes.
// Writes: NearPairs, in any order; StrayMarks, of those that are near to somebody; Counters.
// Needs: a barrier after find_strays.
// Overflow: where strays have too many pairs all are searched for.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"
#include "broad_phase/strays.shared.glsl"

layout(local_size_x = 256) in;

layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Strays { uint strays[]; };
layout(std430) buffer StrayMarks { uint stray_marks[]; };
layout(std430) readonly buffer Aabbs { AabbCells aabbs[]; };
layout(std430) readonly buffer OrientedBoxes { OrientedBoxCells oriented_boxes[]; };
layout(std430) writeonly buffer NearPairs { Pair near_pairs[]; };
layout(std430) buffer Counters { uint counters[]; };

#include "broad_phase/box_now.glsl"

// Strays lie in the cells of a grid, each in that of its centre; cells of one hash share a list.
const uint k_cells = 1024u;
const uint k_most_cells = 64u; // that a body looks at: a larger one is left to all of the group
const uint k_most_large = 64u; // bodies of a group that are

shared uint stray_count; // 0 where there is nothing to do
shared uint largest_extent; // of a stray's box, m: the bits of a float
shared Aabb stray_aabbs[k_most_strays];
shared uint first_of_cell[k_cells]; // a stray's place
shared uint next_of_cell[k_most_strays];
shared uint large_bodies[k_most_large];
shared uint large_count;

void note_near(uint stray, uint body)
{
    stray_marks[stray] = k_stray_near; // others may write the same
    uint place = atomicAdd(counters[k_counter_near_pairs], 1u);
    if (place < most_stray_pairs(parameters.body_count))
        near_pairs[place] = make_pair(stray, body);
    else
        counters[k_counter_search_count] = parameters.body_count;
}

float inverse_cell() { return 0.5 / uintBitsToFloat(largest_extent); }

ivec3 cell_at(vec3 place) { return ivec3(floor(clamp(place * inverse_cell(), vec3(-1.0e9), vec3(1.0e9)))); }

ivec3 cell_of_stray(uint i) { return cell_at(0.5 * (stray_aabbs[i].lower + stray_aabbs[i].upper)); }

uint list_of(ivec3 cell)
{
    uvec3 c = uvec3(cell) * uvec3(73856093u, 19349663u, 83492791u); // Teschner et al., "Optimized Spatial Hashing" (2003)
    return (c.x ^ c.y ^ c.z) % k_cells;
}

void put_strays_into_cells()
{
    uint me = gl_LocalInvocationID.x;
    if (me == 0u) {
        largest_extent = floatBitsToUint(1.0e-3);
        large_count = 0u;
    }
    for (uint i = me; i < k_cells; i += gl_WorkGroupSize.x)
        first_of_cell[i] = k_none;
    barrier();
    for (uint i = me; i < stray_count; i += gl_WorkGroupSize.x) {
        stray_aabbs[i] = compute_aabb(box_with_skin(strays[i]));
        vec3 extent = stray_aabbs[i].upper - stray_aabbs[i].lower;
        atomicMax(largest_extent, floatBitsToUint(max(max(extent.x, extent.y), max(extent.z, 0.0))));
    }
    barrier();
    for (uint i = me; i < stray_count; i += gl_WorkGroupSize.x)
        next_of_cell[i] = atomicExchange(first_of_cell[list_of(cell_of_stray(i))], i);
    barrier();
}

OrientedBox box_of(uint body, bool strays_too)
{
    if (strays_too) return box_with_skin(body);
    return unpack(oriented_boxes[body]);
}

bool was_near(uint stray, uint body)
{
    return is_candidate(unpack(aabbs[stray]), unpack(aabbs[body])) &&
           !faces_part(unpack(oriented_boxes[stray]), unpack(oriented_boxes[body]));
}

void look_at_stray(uint i, uint body, bool strays_too, Aabb box)
{
    uint stray = strays[i];
    bool is_its_turn = !strays_too || body > stray;
    if (is_its_turn && is_candidate(stray_aabbs[i], box) && !faces_part(box_with_skin(stray), box_of(body, strays_too)) &&
        !was_near(stray, body))
        note_near(stray, body);
}

Aabb aabb_of(uint body, bool strays_too)
{
    if (strays_too) return compute_aabb(box_of(body, true));
    return unpack(aabbs[body]);
}

void look_at_strays(uint body, uint first, uint stride)
{
    bool strays_too = stray_marks[body] != 0u;
    Aabb box = aabb_of(body, strays_too);
    for (uint i = first; i < stray_count; i += stride)
        look_at_stray(i, body, strays_too, box);
}

void find_near(uint body)
{
    bool strays_too = stray_marks[body] != 0u;
    Aabb box = aabb_of(body, strays_too);
    // A stray whose box touches this one has its centre no farther from it than half its extent, and what is rounded.
    vec3 size = max(abs(box.lower), abs(box.upper));
    float farthest = max(max(size.x, size.y), size.z);
    float reach = 0.51 * uintBitsToFloat(largest_extent) + 1.0e-5 * farthest;
    ivec3 first = cell_at(box.lower - reach);
    vec3 counts = vec3(cell_at(box.upper + reach) - first) + 1.0;
    bool looks_at_all = !(counts.x * counts.y * counts.z <= float(k_most_cells)) || !is_finite(uintBitsToFloat(largest_extent));
    if (looks_at_all) {
        uint place = atomicAdd(large_count, 1u);
        if (place < k_most_large)
            large_bodies[place] = body;
        else
            look_at_strays(body, 0u, 1u);
        return;
    }
    uvec3 cells = uvec3(max(counts, vec3(0.0)));
    for (uint c = 0u; c < cells.x * cells.y * cells.z; ++c) {
        ivec3 cell = first + ivec3(c % cells.x, c / cells.x % cells.y, c / (cells.x * cells.y));
        for (uint i = first_of_cell[list_of(cell)]; i != k_none; i = next_of_cell[i])
            if (cell_of_stray(i) == cell) look_at_stray(i, body, strays_too, box);
    }
}

void main()
{
    if (gl_LocalInvocationID.x == 0u)
        stray_count = counters[k_counter_search_count] == 0u ? counters[k_counter_stray_count] : 0u;
    barrier();
    if (stray_count == 0u) return;
    // Cells are made by each group for itself, so there are no more groups than run at a time.
    uint invocations = gl_NumWorkGroups.x * gl_NumWorkGroups.y * gl_WorkGroupSize.x;
    put_strays_into_cells();
    for (uint body = item_index(); body < parameters.body_count; body += invocations)
        find_near(body);
    barrier();
    for (uint i = 0u; i < min(large_count, k_most_large); ++i)
        look_at_strays(large_bodies[i], gl_LocalInvocationID.x, gl_WorkGroupSize.x);
}
