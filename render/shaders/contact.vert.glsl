// SPDX-License-Identifier: MIT
// One instance is a contact point: a disc that faces the eye, and stays large enough to be seen.

layout(std430, binding = 5) readonly buffer Contacts { vec4 contacts[]; }; // xyz: m, world

layout(location = 0) out vec2 disc; // -1 to 1

void main()
{
    vec3 centre = contacts[gl_InstanceID].xyz;
    vec3 to_eye = eye.xyz - centre;
    float eye_distance = length(to_eye);
    // Contact points lie between two surfaces: a step towards the eye brings those near an edge out of the bodies.
    vec4 clip = view_projection * vec4(centre + to_eye * min(0.5, 0.12 * sizes.x / eye_distance), 1.0);
    // In pixels. Far away the points of a body must not run into each other.
    float body_size = sizes.x / (eye.w * eye_distance);
    float radius = max(0.06 * body_size, clamp(0.12 * body_size, 1.2, 3.5));
    disc = vec2((gl_VertexID & 1) == 0 ? -1.0 : 1.0, (gl_VertexID & 2) == 0 ? -1.0 : 1.0);
    clip.xy += disc * (radius + 1.0) * 2.0 / viewport.xy * clip.w;
    gl_Position = clip;
    disc *= (radius + 1.0) / radius;
}
