// SPDX-License-Identifier: MIT
// For a group of k_spread_group invocations in a kernel with the block SpreadSums: each adds those of every
// k_spread_group-th group, one after the other; then these are added as a tree.

shared SpreadSum sums[k_spread_group];

// The sum of all groups' sums, for the first invocation. Every invocation must call it.
SpreadSum sum_spread()
{
    uint me = gl_LocalInvocationID.x;
    uint group_count = (parameters.body_count + k_spread_group - 1u) / k_spread_group;
    SpreadSum sum = empty_spread();
    for (uint group = me; group < group_count; group += k_spread_group)
        sum = add_spreads(sum, spread_sums[group]);
    sums[me] = sum;
    for (uint half_size = k_spread_group / 2u; half_size > 0u; half_size /= 2u) {
        barrier();
        if (me < half_size) sums[me] = add_spreads(sums[me], sums[me + half_size]);
    }
    return sums[0];
}
