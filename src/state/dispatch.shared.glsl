// SPDX-License-Identifier: MIT
// Arguments of indirect dispatches.

const uint k_most_groups = 65535u; // a dimension, on every driver

// Enough groups of `group_size` invocations for `items`, in two dimensions where one is not enough.
inline Dispatch groups_for(uint items, uint group_size)
{
    uint groups = (items + group_size - 1u) / group_size;
    Dispatch d;
    d.groups_x = min(groups, k_most_groups);
    d.groups_y = groups == 0u ? 0u : (groups + k_most_groups - 1u) / k_most_groups;
    d.groups_z = groups == 0u ? 0u : 1u;
    d.items = items;
    return d;
}
