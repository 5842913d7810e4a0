// SPDX-License-Identifier: MIT
// Instead of stored_hits.glsl, for kernels in which nothing bounces.

BodyHits load_hits(uint body) { return no_hits(no_warm_start()); }
void store_hits(uint body, BodyHits hits) {}
vec4 load_contact_hits(uint index) { return vec4(0.0); }
void store_contact_hits(uint index, vec4 hits) {}
