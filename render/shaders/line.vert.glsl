// SPDX-License-Identifier: MIT
// One instance is a line, drawn as a thin quadrilateral: OpenGL need not have lines wider than a pixel.

struct Line {
    vec3 from; // m, world
    uint colour;
    vec3 to;
    float width; // pixels of a usual screen
};

layout(std430, binding = 6) readonly buffer Lines { Line lines[]; };

uniform float pixel_scale; // pixels for one of a usual screen

layout(location = 0) flat out vec4 line_colour;
layout(location = 1) out float across; // pixels from the middle
layout(location = 2) flat out float half_width;

void main()
{
    Line line = lines[gl_InstanceID];
    vec4 a = view_projection * vec4(line.from, 1.0), b = view_projection * vec4(line.to, 1.0);
    // What lies behind the eye is cut off: its place in the picture would be on the wrong side.
    float nearest = 0.01 * target.w;
    if (a.w < nearest && b.w >= nearest) a = mix(a, b, (nearest - a.w) / (b.w - a.w));
    if (b.w < nearest && a.w >= nearest) b = mix(b, a, (nearest - b.w) / (a.w - b.w));
    vec2 way = (b.xy / b.w - a.xy / a.w) * viewport.xy;
    vec2 sideways = length(way) > 1e-6 ? normalize(vec2(-way.y, way.x)) : vec2(1.0, 0.0);

    half_width = 0.5 * line.width * pixel_scale;
    vec4 place = (gl_VertexID & 1) == 0 ? a : b;
    across = ((gl_VertexID & 2) == 0 ? -1.0 : 1.0) * (half_width + 1.0);
    gl_Position = place + vec4(2.0 * across * sideways / viewport.xy * place.w, -1e-4 * place.w, 0.0);
    if (a.w < nearest && b.w < nearest) gl_Position = vec4(0.0, 0.0, 2.0, 1.0);
    line_colour = unpackUnorm4x8(line.colour);
}
