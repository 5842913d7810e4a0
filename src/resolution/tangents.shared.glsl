// SPDX-License-Identifier: MIT
// The two directions of friction.

struct Tangents {
    vec3 t1;
    vec3 t2;
};

// Two directions that make a right-handed frame with n (equations 3.18, 3.19). Duff et al., "Building an Orthonormal
// Basis, Revisited" (2017): no square root, and continuous but for n.z = 0.
inline Tangents contact_tangents(vec3 n)
{
    float sign = n.z < 0.0f ? -1.0f : 1.0f;
    precise float a = -reciprocal(sign + n.z);
    precise float b = n.x * n.y * a;
    precise vec3 t1 = vec3(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
    precise vec3 t2 = vec3(b, sign + n.y * n.y * a, -n.y);
    Tangents t;
    t.t1 = t1;
    t.t2 = t2;
    return t;
}
