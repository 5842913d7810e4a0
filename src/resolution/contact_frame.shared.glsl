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

// From A's centre to B's where the bodies meet; the positions are those at the start of the step.
inline vec3 offset_at_meeting(vec3 position_a, vec3 position_b, vec3 shift)
{
    precise vec3 offset = (position_b - position_a) + shift;
    return offset;
}
