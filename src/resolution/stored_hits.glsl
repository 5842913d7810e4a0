// SPDX-License-Identifier: MIT
// What hits have to know of bodies, and how hard they have been on each contact in the step (N s of each point), for kernels in which
// something may bounce; others have no_hits.glsl instead. It lies behind the warm starts of all bodies. See contact_passes.glsl.

// A coherent block's member is no argument: NVIDIA's compiler refuses it.
BodyHits load_hits(uint body)
{
    BodyWarmStartCells cells = warm_starts[hits_place(body, parameters.body_count)];
    return unpack(BodyHitsCells(cells.cell_0, cells.cell_1));
}

void store_hits(uint body, BodyHits hits)
{
    BodyHitsCells cells = pack(hits);
    warm_starts[hits_place(body, parameters.body_count)] = BodyWarmStartCells(cells.cell_0, cells.cell_1);
}

#include "resolution/stored_contact_hits.glsl"
