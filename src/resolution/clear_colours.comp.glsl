// SPDX-License-Identifier: MIT
// One invocation is a body slot: no colour in use, no rank seen, no hub.
// Reads: nothing.
// Writes: BodyColours.
// Needs: nothing.
// Overflow: none.
#include "resolution/colouring.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) writeonly buffer BodyColours { uint body_colours[]; };

void main()
{
    uint body = item_index();
    if (body >= parameters.body_count) return;
    for (uint word = 0u; word < k_body_words; ++word)
        body_colours[body_word(body, word)] = 0u;
}
