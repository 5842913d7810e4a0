// SPDX-License-Identifier: MIT
// One invocation is a slot of the pair table: empties it.
// Reads: nothing.
// Writes: PairTable.
// Needs: nothing.
// Overflow: none.
layout(local_size_x = 64) in;

layout(std430) writeonly buffer PairTable { uint pair_table[]; };

void main()
{
    uint slot = item_index();
    if (slot < parameters.table_size) pair_table[slot] = k_none;
}
