// SPDX-License-Identifier: MIT
// Arithmetic with the same bits on every device. Only +, -, *, comparisons and integer operations are rounded alike
// everywhere: hardware rounds a / b and sqrt each in its own way, and compilers reorder dot and length. So these are
// written out here, and every computed value is `precise`. docs/conventions.md gives the rules.

// y, with its sign turned over where x has a minus; bit by bit, as to compare and to choose takes longer.
inline float turned_as(float x, float y)
{
    return uintBitsToFloat(floatBitsToUint(y) ^ (floatBitsToUint(x) & 0x80000000u));
}

// 1 / x to within 2 units in the last place, for normal x. Newton's method on f(y) = 1/y - x; the first guess flips the
// exponent and is good to 12 %, and each round squares the error.
inline float reciprocal(float x)
{
    float size = abs(x);
    precise float y = uintBitsToFloat(0x7ef311c7u - floatBitsToUint(size));
    y = y * (2.0f - size * y);
    y = y * (2.0f - size * y);
    y = y * (2.0f - size * y);
    y = y * (2.0f - size * y);
    return turned_as(x, y);
}

// 1 / sqrt(x) to within 2 units in the last place, for x from 2^-125 on; finite at 0. Newton's method on f(y) = 1/y^2 - x
// from the guess that halves the exponent (3.4 %). As a correction to y each round errs less than as a factor on it, which
// leaves 2.2 units.
inline float inverse_sqrt(float x)
{
    precise float y = uintBitsToFloat(0x5f375a86u - (floatBitsToUint(x) >> 1));
    precise float half_x = 0.5f * x;
    y = y + y * (0.5f - half_x * y * y);
    y = y + y * (0.5f - half_x * y * y);
    y = y + y * (0.5f - half_x * y * y);
    return y;
}

inline float square_root(float x)
{
    precise float r = x * inverse_sqrt(x);
    return r;
}

inline bool is_finite(float x) { return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u; }

// The sum of the components' sizes: finite where all are, up to a few below the largest float.
inline float size3(vec3 v)
{
    precise float size = abs(v.x) + abs(v.y) + abs(v.z);
    return size;
}

inline bool is_finite3(vec3 v) { return is_finite(size3(v)); }

inline float clamp_to(float x, float lower, float upper) { return min(max(x, lower), upper); }

// ---- vectors ----

inline float dot3(vec3 a, vec3 b)
{
    precise float r = a.x * b.x + a.y * b.y + a.z * b.z;
    return r;
}

inline vec4 min4(vec4 a, vec4 b)
{
    return vec4(min(a.x, b.x), min(a.y, b.y), min(a.z, b.z), min(a.w, b.w));
}

inline float sum4(vec4 v)
{
    precise float r = (v.x + v.y) + (v.z + v.w);
    return r;
}

inline vec3 cross3(vec3 a, vec3 b)
{
    precise float x = a.y * b.z - a.z * b.y;
    precise float y = a.z * b.x - a.x * b.z;
    precise float z = a.x * b.y - a.y * b.x;
    return vec3(x, y, z);
}

inline vec3 scale3(vec3 v, float s)
{
    precise vec3 r = v * s;
    return r;
}

// a + b s
inline vec3 add_scaled(vec3 a, vec3 b, float s)
{
    precise vec3 r = a + b * s;
    return r;
}

inline vec3 multiply3(vec3 a, vec3 b)
{
    precise vec3 r = a * b;
    return r;
}

inline float length3(vec3 v) { return square_root(dot3(v, v)); }

inline float component(vec3 v, uint axis) { return choose(axis == 0u, v.x, choose(axis == 1u, v.y, v.z)); }

// ---- rotations: unit quaternions (x, y, z, w) ----

inline vec4 multiply_quaternions(vec4 a, vec4 b)
{
    precise float x = a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y;
    precise float y = a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x;
    precise float z = a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w;
    precise float w = a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z;
    return vec4(x, y, z, w);
}

inline vec4 normalise_quaternion(vec4 q)
{
    precise float square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    precise float scale = inverse_sqrt(square);
    precise vec4 r = q * scale;
    return r;
}

// v + 2 w (u x v) + 2 u x (u x v), with q = (u, w)
inline vec3 rotate(vec4 q, vec3 v)
{
    vec3 u = vec3(q.x, q.y, q.z);
    precise vec3 t = 2.0f * cross3(u, v);
    precise vec3 r = v + q.w * t + cross3(u, t);
    return r;
}

inline vec3 rotate_back(vec4 q, vec3 v) { return rotate(vec4(-q.x, -q.y, -q.z, q.w), v); }

// The axes of a rotated frame: the columns of its rotation matrix.
struct Axes {
    vec3 x;
    vec3 y;
    vec3 z;
};

inline Axes rotation_axes(vec4 q)
{
    precise float xx = q.x * q.x;
    precise float yy = q.y * q.y;
    precise float zz = q.z * q.z;
    precise float xy = q.x * q.y;
    precise float xz = q.x * q.z;
    precise float yz = q.y * q.z;
    precise float wx = q.w * q.x;
    precise float wy = q.w * q.y;
    precise float wz = q.w * q.z;
    precise vec3 x = vec3(1.0f - 2.0f * (yy + zz), 2.0f * (xy + wz), 2.0f * (xz - wy));
    precise vec3 y = vec3(2.0f * (xy - wz), 1.0f - 2.0f * (xx + zz), 2.0f * (yz + wx));
    precise vec3 z = vec3(2.0f * (xz + wy), 2.0f * (yz - wx), 1.0f - 2.0f * (xx + yy));
    Axes axes;
    axes.x = x;
    axes.y = y;
    axes.z = z;
    return axes;
}

inline vec3 axis_of(Axes axes, uint i) { return choose(i == 0u, axes.x, choose(i == 1u, axes.y, axes.z)); }

// From the frame of `axes` to the world.
inline vec3 to_world(Axes axes, vec3 v)
{
    precise vec3 r = axes.x * v.x + axes.y * v.y + axes.z * v.z;
    return r;
}

inline vec3 to_local(Axes axes, vec3 v) { return vec3(dot3(axes.x, v), dot3(axes.y, v), dot3(axes.z, v)); }

// The rotation after turning with the angular velocity w (world axes, rad/s) for the time h. The quaternion of the turn
// is (tan(a/2) axis, 1) up to its length; tan(a/2) = a/2 + a^3/24 to fifth order.
inline vec4 integrate_rotation(vec4 q, vec3 w, float h)
{
    precise vec3 turn = w * h;
    precise float scale = 0.5f + dot3(turn, turn) * (1.0f / 24.0f);
    precise vec3 axis = turn * scale;
    return normalise_quaternion(multiply_quaternions(vec4(axis.x, axis.y, axis.z, 1.0f), q));
}
