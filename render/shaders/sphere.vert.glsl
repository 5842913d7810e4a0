// SPDX-License-Identifier: MIT
// One instance is a sphere: a square that faces the eye and just holds the sphere's outline.

layout(location = 0) out vec3 place; // m, world, on the square
layout(location = 1) flat out uint slot;

void main()
{
    slot = slots[first_instance + uint(gl_InstanceID)];
    vec3 centre = poses[slot].position;
    float radius = shapes[slot].half_extents.x;
    vec3 away = centre - eye.xyz;
    float eye_distance = length(away);
    away /= eye_distance;

    // The rays that touch the sphere cross the plane through its centre a little outside it; one pixel more for the
    // soft outline.
    float ratio = min(radius / eye_distance, 0.99);
    float reach = radius / sqrt(1.0 - ratio * ratio) + 1.5 * eye.w * eye_distance;
    vec3 across = normalize(abs(away.y) < 0.99 ? cross(away, vec3(0.0, 1.0, 0.0)) : cross(away, vec3(1.0, 0.0, 0.0)));
    vec3 along = cross(across, away);
    place = centre + reach * ((gl_VertexID & 1) == 0 ? -1.0 : 1.0) * across +
            reach * ((gl_VertexID & 2) == 0 ? -1.0 : 1.0) * along;
    gl_Position = view_projection * vec4(place, 1.0);
}
