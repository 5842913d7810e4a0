// SPDX-License-Identifier: MIT
// Prefix sums over the invocations of one work group of k_scan_group, without subgroup operations (Hillis and Steele:
// in round r each sum takes in the one 2^r places before it).

// Two rows, read and written by turns, so that a round needs one barrier.
shared uint group_sums[2u * k_scan_group];

// Sum of `value` over the invocations before this one; `total` is the sum over all. Every invocation must call it.
uint group_scan(uint value, out uint total)
{
    uint me = gl_LocalInvocationID.x;
    uint row = 0u;
    uint sum = value;
    barrier(); // the last call's sums have been read
    group_sums[me] = sum;
    barrier();
    for (uint reach = 1u; reach < k_scan_group; reach *= 2u) {
        if (me >= reach) sum += group_sums[row + me - reach];
        row = k_scan_group - row;
        group_sums[row + me] = sum;
        barrier();
    }
    total = group_sums[row + k_scan_group - 1u];
    return sum - value;
}
