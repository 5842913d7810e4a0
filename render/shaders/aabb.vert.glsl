// SPDX-License-Identifier: MIT
// One instance is a body's bounding box along the world's axes: twelve lines.

void main()
{
    uint slot = slots[first_instance + uint(gl_InstanceID)];
    BodyPose pose = poses[slot];
    BodyShape shape = shapes[slot];
    vec3 h = shape.half_extents;
    vec3 extent = h;
    if (!is_sphere(shape)) {
        extent = abs(rotate(pose.rotation, vec3(h.x, 0.0, 0.0))) + abs(rotate(pose.rotation, vec3(0.0, h.y, 0.0))) +
                 abs(rotate(pose.rotation, vec3(0.0, 0.0, h.z)));
    }
    // Line i of four along each axis: the other two coordinates are the bits of i.
    uint axis = uint(gl_VertexID) / 8u;
    uint i = (uint(gl_VertexID) / 2u) & 3u;
    float end = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
    vec2 others = vec2((i & 1u) == 0u ? -1.0 : 1.0, (i & 2u) == 0u ? -1.0 : 1.0);
    vec3 corner = axis == 0u ? vec3(end, others) : axis == 1u ? vec3(others.y, end, others.x) : vec3(others, end);
    gl_Position = view_projection * vec4(pose.position + corner * extent, 1.0);
    gl_Position.z -= 1e-5 * gl_Position.w; // in front of faces that lie in the box's own sides
}
