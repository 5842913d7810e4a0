// SPDX-License-Identifier: MIT
// A pink disc with a darker rim; faint where a body is in front of it, which the first of two passes draws.

layout(location = 0) in vec2 disc;

uniform float opacity;

layout(location = 0) out vec4 colour;

void main()
{
    float r = length(disc);
    float pixel = fwidth(r);
    float cover = 1.0 - smoothstep(1.0 - pixel, 1.0, r);
    if (cover == 0.0) discard;
    vec3 pink = mix(vec3(1.0, 0.10, 0.42), vec3(0.45, 0.01, 0.16), smoothstep(0.65, 0.9, r));
    colour = vec4(pink, cover * opacity);
}
