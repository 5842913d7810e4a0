// SPDX-License-Identifier: MIT
// Spheres as the sun sees them; sensors it does not see. A disc through the centre throws the same shadow, and is never in front of the side that
// the sun lights.

layout(location = 0) out vec2 disc; // -1 to 1

void main()
{
    uint slot = slots[first_instance + uint(gl_InstanceID)];
    if (is_sensor(shapes[slot])) {
        gl_Position = k_outside;
        return;
    }
    disc = vec2((gl_VertexID & 1) == 0 ? -1.0 : 1.0, (gl_VertexID & 2) == 0 ? -1.0 : 1.0);
    vec3 lower, upper;
    shadow_bounds(lower, upper);
    vec3 position = poses[slot].position +
                    shapes[slot].half_extents.x * (disc.x * light_right.xyz + disc.y * light_up.xyz);
    gl_Position = vec4(in_shadow_map(position, lower, upper) * 2.0 - 1.0, 1.0);
}
