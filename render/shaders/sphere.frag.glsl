// SPDX-License-Identifier: MIT
// Where the ray through this pixel meets the sphere. Three rings show how the sphere turns.
#include "shaders/surface.glsl"

layout(location = 0) in vec3 place;
layout(location = 1) flat in uint slot;

layout(location = 0) out vec4 colour; // a: how much of the pixel the sphere covers, which becomes samples

void main()
{
    BodyPose pose = poses[slot];
    BodyShape shape = shapes[slot];
    float radius = shape.half_extents.x;
    vec3 ray = normalize(place - eye.xyz);
    vec3 from_eye = pose.position - eye.xyz;
    float along = dot(from_eye, ray); // to the point of the ray nearest to the centre
    vec3 nearest = ray * along - from_eye;
    float miss = length(nearest);
    float pixel = eye.w * along;
    float cover = clamp(0.5 + (radius - miss) / pixel, 0.0, 1.0);
    if (cover == 0.0) discard;

    vec3 normal = normalize(nearest - ray * sqrt(max(radius * radius - miss * miss, 0.0)));
    vec3 position = pose.position + radius * normal;
    vec4 clip = view_projection * vec4(position, 1.0);
    gl_FragDepth = 0.5 + 0.5 * clip.z / clip.w;

    vec4 to_body = vec4(-pose.rotation.xyz, pose.rotation.w);
    vec3 d = abs(rotate(to_body, radius * normal));
    uint look = look_of(shape);
    float to_ring = min(min(d.x, d.y), d.z), surface_pixel = pixel / max(0.25, -dot(normal, ray));
    if (wireframe && miss < radius - 1.5 * pixel && !is_on_wire(to_ring, radius, surface_pixel)) discard;
    vec3 surface = colour_of(slot, look) * edge_line(to_ring, radius, surface_pixel);

    vec3 lower, upper;
    shadow_bounds(lower, upper);
    vec3 lit = light_surface(surface, normal, -ray, shadow_place(position, normal, lower, upper));
    float opacity = cover * opacity_of(look, to_ring, radius, surface_pixel);
    colour = vec4(fade(lit, look, position, gl_FragCoord.y), opacity);
}
