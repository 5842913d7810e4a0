// SPDX-License-Identifier: MIT
// The movements of bodies where they are in a buffer: see contact_passes.glsl and body_passes.glsl.

layout(std430) coherent buffer Deltas { BodyDeltaCells deltas[]; };

// A coherent block's member is no argument: NVIDIA's compiler refuses it.
BodyDelta load_stored_delta(uint body)
{
    BodyDeltaCells delta = deltas[body];
    return unpack(delta);
}

void store_stored_delta(uint body, BodyDelta delta) { deltas[body] = pack(delta); }
