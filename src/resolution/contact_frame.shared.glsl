// SPDX-License-Identifier: MIT
// The frame of a contact: z along the normal, x and y the two directions of friction (equations 3.18, 3.19).

// A right-handed frame whose z is the unit vector n. Duff et al., "Building an Orthonormal Basis, Revisited" (2017): no
// square root, and continuous but for n.z = 0.
inline Axes contact_frame(vec3 n)
{
    float sign = choose(n.z < 0.0f, -1.0f, 1.0f);
    precise float a = -reciprocal(sign + n.z);
    precise float b = n.x * n.y * a;
    precise vec3 t1 = vec3(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
    precise vec3 t2 = vec3(b, sign + n.y * n.y * a, -n.y);
    Axes frame;
    frame.x = t1;
    frame.y = t2;
    frame.z = n;
    return frame;
}
