// SPDX-License-Identifier: MIT
// A line with smooth sides; faint where a body is in front of it, which the first of two passes draws.

layout(location = 0) flat in vec4 line_colour;
layout(location = 1) in float across;
layout(location = 2) flat in float half_width;

uniform float opacity;

layout(location = 0) out vec4 colour;

void main()
{
    float cover = clamp(half_width + 0.5 - abs(across), 0.0, 1.0);
    if (cover == 0.0) discard;
    colour = vec4(line_colour.rgb, line_colour.a * cover * opacity);
}
