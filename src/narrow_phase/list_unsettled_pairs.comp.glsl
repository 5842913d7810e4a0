// SPDX-License-Identifier: MIT
// One invocation is a pair: listed where its contact is not there already. Of two bodies that sleep, or stand, for two steps it is, as
// the narrow phase writes where it did two steps ago. The list also gets its launch.
// Launched where constraints have not been written over what was there.
// Reads: Counters, Pairs, Poses.
// Writes: UnsettledPairs, in any order; Counters, Dispatches.
// Needs: a barrier after plan_pairs.
// Overflow: none; the list has room for every pair.
#include "state/math.shared.glsl"
#include "state/dispatch.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/sleep.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) buffer Counters { uint counters[]; };
layout(std430) readonly buffer Pairs { Pair pairs[]; };
layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) writeonly buffer UnsettledPairs { uint unsettled_pairs[]; };
layout(std430) buffer Dispatches { Dispatch dispatches[]; };

shared uint listed_count; // of the group
shared uint first_listed;

// Whether the pairs had their places in the list two steps ago. Those of strays may have been added since; but a body of these has moved,
// and is not settled.
bool is_old_list() { return counters[k_counter_pairs_changed] == 0u && counters[k_counter_same_list] != 0u; }

bool has_contact(Pair pair) { return are_settled(unpack(poses[pair.body_a]), unpack(poses[pair.body_b])); }

// Others may have listed more by now.
void plan_launch(uint count)
{
    Dispatch launch = groups_for(count, k_group_size);
    atomicMax(dispatches[k_dispatch_unsettled_pairs].groups_x, launch.groups_x);
    atomicMax(dispatches[k_dispatch_unsettled_pairs].groups_y, launch.groups_y);
    atomicMax(dispatches[k_dispatch_unsettled_pairs].groups_z, launch.groups_z);
    atomicMax(dispatches[k_dispatch_unsettled_pairs].items, launch.items);
}

void main()
{
    bool is_first = gl_LocalInvocationID.x == 0u;
    if (is_first) listed_count = 0u;
    barrier();
    uint pair_index = item_index();
    bool listed = pair_index < counters[k_counter_pair_count] && !(is_old_list() && has_contact(pairs[pair_index]));
    uint place = listed ? atomicAdd(listed_count, 1u) : 0u;
    barrier();
    if (is_first && listed_count > 0u) {
        first_listed = atomicAdd(counters[k_counter_unsettled_pairs], listed_count);
        plan_launch(first_listed + listed_count);
    }
    barrier();
    if (listed) unsettled_pairs[first_listed + place] = pair_index;
}
