// SPDX-License-Identifier: MIT
// How far bodies have come and what contacts have done to them, in the buffers. Before this file the kernel declares
// Deltas and WarmStarts, and has its bodies' slots in the world as their slots; beyond them is what nothing moves.
// solve_island_groups.glsl has the same in shared memory.

// A coherent block's member is no argument: NVIDIA's compiler refuses it.
BodyDelta load_delta(uint slot)
{
    BodyDeltaCells delta = deltas[slot];
    return unpack(delta);
}

void store_delta(uint slot, BodyDelta delta) { deltas[slot] = pack(delta); }

BodyWarmStart load_warm_start(uint slot)
{
    BodyWarmStartCells warm = warm_starts[slot];
    return unpack(warm);
}

void store_warm_start(uint slot, BodyWarmStart warm) { warm_starts[slot] = pack(warm); }
