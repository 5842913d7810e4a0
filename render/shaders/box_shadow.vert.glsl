// SPDX-License-Identifier: MIT
// Boxes as the sun sees them; sensors it does not see. What lies outside the map along the sun's direction is clamped to its ends.
#include "shaders/box_vertex.glsl"

void main()
{
    uint slot = slots[first_instance + uint(gl_InstanceID)];
    if (is_sensor(shapes[slot])) {
        gl_Position = k_outside;
        return;
    }
    BodyPose pose = poses[slot];
    vec3 corner;
    uint axis;
    float side;
    box_vertex(uint(gl_VertexID), corner, axis, side);
    vec3 lower, upper;
    shadow_bounds(lower, upper);
    vec3 position = pose.position + rotate(pose.rotation, corner * shapes[slot].half_extents);
    gl_Position = vec4(in_shadow_map(position, lower, upper) * 2.0 - 1.0, 1.0);
}
