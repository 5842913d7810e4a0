// SPDX-License-Identifier: MIT
// Sphere against sphere, and box against sphere.

// `offset`: from A's centre to B's (m, world).
inline ContactGeometry collide_spheres(float radius_a, float radius_b, vec3 offset, float max_separation)
{
    float square = dot3(offset, offset);
    float inverse_length = inverse_sqrt(square);
    precise float separation = square * inverse_length - radius_a - radius_b;
    // Centres that coincide leave the direction open: any will do, so long as it is always the same.
    precise vec3 towards_b = offset * inverse_length;
    vec3 normal = choose(square > 1.0e-12f, towards_b, vec3(0.0f, 1.0f, 0.0f));
    precise vec3 point = normal * (radius_a + 0.5f * separation);
    return contact_within(max_separation, normal, point, separation);
}

// A is the box; `offset` leads from its centre to the sphere's.
inline ContactGeometry collide_box_sphere(Axes box, vec3 half_extents, float radius, vec3 offset, float max_separation)
{
    vec3 h = half_extents;
    vec3 centre = to_local(box, offset);
    vec3 closest = vec3(clamp_to(centre.x, -h.x, h.x), clamp_to(centre.y, -h.y, h.y), clamp_to(centre.z, -h.z, h.z));
    precise vec3 gap = centre - closest;
    float square = dot3(gap, gap);
    vec3 normal; // as the point, in the box's axes
    vec3 point;
    float separation;
    if (square > 1.0e-12f) { // the sphere's centre is outside the box
        float inverse_length = inverse_sqrt(square);
        precise float distance = square * inverse_length - radius;
        precise vec3 outwards = gap * inverse_length;
        precise vec3 between = closest + outwards * (0.5f * distance);
        separation = distance;
        normal = outwards;
        point = between;
    } else { // inside: out through the nearest face
        precise vec3 depth = h - abs(centre);
        uint axis = 0u;
        if (depth.y < depth.x) axis = 1u;
        if (depth.z < min(depth.x, depth.y)) axis = 2u;
        float side = choose(component(centre, axis) < 0.0f, -1.0f, 1.0f);
        normal = vec3(choose(axis == 0u, side, 0.0f), choose(axis == 1u, side, 0.0f), choose(axis == 2u, side, 0.0f));
        precise float distance = -component(depth, axis) - radius;
        precise vec3 between = centre + normal * (0.5f * (component(depth, axis) - radius));
        separation = distance;
        point = between;
    }
    return contact_within(max_separation, to_world(box, normal), to_world(box, point), separation);
}
