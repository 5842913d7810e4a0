// SPDX-License-Identifier: MIT
// Records that the host has changed go to their places in a buffer.
// One invocation is a cell of 16 bytes of a record.
// Reads: Changes: the places of args.x records, then the records, of args.y cells each; Counters.
// Writes: Target.
// Needs: a barrier after the kernels that used Target last. No two records have the same place.
// Overflow: after a step that did not fit nothing is written, as that step will be made again from what was there before
// it. The host then gives the later changes again.
layout(local_size_x = 64) in; // k_group_size

layout(std430) readonly buffer Changes { uint changes[]; };
layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) writeonly buffer Target { uvec4 target[]; }; // cells

void main()
{
    uint record_count = args.x;
    uint cells = args.y;
    uint cell = item_index();
    if (cell >= record_count * cells || counters[k_counter_did_not_fit] != 0u) return;

    uint from = record_count + 4u * cell;
    target[changes[cell / cells] * cells + cell % cells] =
        uvec4(changes[from], changes[from + 1u], changes[from + 2u], changes[from + 3u]);
}
