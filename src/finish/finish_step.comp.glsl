// SPDX-License-Identifier: MIT
// One invocation: this step's pairs become the last step's.
// Reads: Counters.
// Writes: Counters.
// Needs: nothing.
// Overflow: none; launched empty after a step that did not fit.
layout(local_size_x = 1) in;

layout(std430) buffer Counters { uint counters[]; };

void main()
{
    counters[k_counter_old_pair_count] = counters[k_counter_pair_count];
}
