// SPDX-License-Identifier: MIT
// A box face, with darker edges; with a grid where it is large and static; translucent where it is a sensor's.
#include "shaders/surface.glsl"

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec2 face_position;
layout(location = 2) in vec3 shadow_position;
layout(location = 3) flat in vec3 normal;
layout(location = 4) flat in vec3 face_reach;
layout(location = 5) flat in vec3 albedo;
layout(location = 6) flat in uint look;

layout(location = 0) out vec4 colour;

float grid_lines()
{
    vec2 d = abs(fract(face_position / sizes.y + 0.5) - 0.5) * sizes.y;
    // A pixel covers more of the ground the flatter one looks at it.
    vec2 covered = max(fwidth(face_position), 1e-6);
    return max(line(d.x, 0.008 * sizes.y, covered.x), line(d.y, 0.008 * sizes.y, covered.y));
}

void main()
{
    vec3 to_eye = eye.xyz - world_position;
    float eye_distance = length(to_eye);
    to_eye /= eye_distance;
    float pixel = eye.w * eye_distance / max(0.25, dot(normal, to_eye));

    vec2 to_sides = face_reach.xy - abs(face_position);
    float to_edge = min(to_sides.x, to_sides.y);
    vec3 surface = albedo * edge_line(to_edge, face_reach.z, pixel);
    float grid = look == k_kind_static && min(face_reach.x, face_reach.y) >= 4.0 * sizes.y ? grid_lines() : 0.0;
    surface *= 1.0 + 0.35 * grid;
    if (wireframe && grid < 0.3 && !is_on_wire(to_edge, face_reach.z, pixel)) discard;

    vec3 lit = light_surface(surface, normal, to_eye, shadow_position);
    float opacity = opacity_of(look, to_edge, face_reach.z, pixel);
    colour = vec4(fade(lit, look, world_position, gl_FragCoord.y), opacity);
}
