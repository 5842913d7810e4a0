// SPDX-License-Identifier: MIT
// One instance is a box, drawn from the solver's own buffers.
#include "shaders/surface.glsl"
#include "shaders/box_vertex.glsl"

layout(location = 0) out vec3 world_position;
layout(location = 1) out vec2 face_position; // m from the middle of the face
layout(location = 2) out vec3 shadow_position;
layout(location = 3) flat out vec3 normal;
layout(location = 4) flat out vec3 face_reach; // m; xy: from the middle of the face to its sides, z: least of the box
layout(location = 5) flat out vec3 albedo;
layout(location = 6) flat out uint look;

void main()
{
    uint slot = slots[first_instance + uint(gl_InstanceID)];
    BodyPose pose = poses[slot];
    BodyShape shape = shapes[slot];
    vec3 h = shape.half_extents;

    vec3 corner;
    uint axis;
    float side;
    box_vertex(uint(gl_VertexID), corner, axis, side);
    vec3 local = corner * h;
    vec3 local_normal = side * vec3(axis == 0u ? 1.0 : 0.0, axis == 1u ? 1.0 : 0.0, axis == 2u ? 1.0 : 0.0);
    world_position = pose.position + rotate(pose.rotation, local);
    normal = rotate(pose.rotation, local_normal);
    face_position = axis == 0u ? local.yz : axis == 1u ? local.zx : local.xy;
    face_reach = vec3(axis == 0u ? h.yz : axis == 1u ? h.zx : h.xy, min(min(h.x, h.y), h.z));
    look = look_of(shape);
    albedo = colour_of(slot, look);

    vec3 lower, upper;
    shadow_bounds(lower, upper);
    shadow_position = shadow_place(world_position, normal, lower, upper);
    gl_Position = view_projection * vec4(world_position, 1.0);
}
