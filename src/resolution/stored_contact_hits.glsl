// SPDX-License-Identifier: MIT
// Where something may bounce: how hard hits have been on each contact in the step, N s of each point. They lie behind what hits have to
// know of bodies: see stored_hits.glsl. The kernel declares WarmStarts.

vec4 load_contact_hits(uint index)
{
    BodyWarmStartCells cells = warm_starts[contact_hits_place(index, parameters.body_count)];
    return uintBitsToFloat(are_first_hits(index) ? cells.cell_0 : cells.cell_1);
}

void store_contact_hits(uint index, vec4 hits)
{
    uint place = contact_hits_place(index, parameters.body_count);
    if (are_first_hits(index))
        warm_starts[place].cell_0 = floatBitsToUint(hits);
    else
        warm_starts[place].cell_1 = floatBitsToUint(hits);
}
