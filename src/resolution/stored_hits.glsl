// SPDX-License-Identifier: MIT
// What hits have to know of bodies, for kernels in which something may bounce. Others have no_hits.glsl instead. See
// contact_passes.glsl.

layout(std430) coherent buffer Hits { BodyHitsCells hits[]; };

// A coherent block's member is no argument: NVIDIA's compiler refuses it.
BodyHits load_hits(uint body)
{
    BodyHitsCells its_hits = hits[body];
    return unpack(its_hits);
}

void store_hits(uint body, BodyHits its_hits) { hits[body] = pack(its_hits); }
