// SPDX-License-Identifier: MIT
// The table of shape pairs. Needs narrow_phase/collide_boxes.shared.glsl and narrow_phase/collide_spheres.shared.glsl.

// One entry a pair of shapes. A new shape adds its entries here.
inline ContactGeometry collide_shapes(BodyPose pose_a, BodyShape shape_a, BodyPose pose_b, BodyShape shape_b,
                                      Carriers carriers, float max_separation)
{
    precise vec3 offset = pose_b.position - pose_a.position;
    uint type_a = shape_a.type & 255u;
    uint type_b = shape_b.type & 255u;
    ContactGeometry g;
    if (type_a == k_shape_box && type_b == k_shape_box) {
        g = collide_boxes(make_box_pair(pose_a, shape_a, pose_b, shape_b), carriers, max_separation);
    } else if (type_a == k_shape_box || type_b == k_shape_box) {
        vec4 rotation_of_box = pose_a.rotation;
        BodyShape box = shape_a;
        BodyShape sphere = shape_b;
        vec3 from_box = offset;
        if (type_a != k_shape_box) {
            rotation_of_box = pose_b.rotation;
            box = shape_b;
            sphere = shape_a;
            from_box = vec3(-offset.x, -offset.y, -offset.z);
        }
        g = collide_box_sphere(rotation_axes(rotation_of_box), box.half_extents, sphere.half_extents.x, from_box,
                               max_separation);
        if (type_a != k_shape_box) g = swap_bodies(g, from_box);
    } else {
        g = collide_spheres(shape_a.half_extents.x, shape_b.half_extents.x, offset, max_separation);
    }
    return g;
}
