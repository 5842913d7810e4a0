// SPDX-License-Identifier: MIT
// The part of the world that the shadow map covers, in the light's axes, as fit_shadow found it.

#ifdef WRITES_SHADOW_BOUNDS
layout(std430, binding = 4) buffer ShadowBounds
#else
layout(std430, binding = 4) readonly buffer ShadowBounds
#endif
{
    uint lower_keys[4]; // ordered like the floats that they stand for, so that atomics can compare them
    uint upper_keys[4];
};

const vec4 k_outside = vec4(2.0, 2.0, 0.0, 1.0); // of the map, in clip space: what lies there is not drawn

uint key_of(float x)
{
    uint bits = floatBitsToUint(x);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

float from_key(uint key) { return uintBitsToFloat((key & 0x80000000u) != 0u ? key ^ 0x80000000u : ~key); }

vec3 in_light_axes(vec3 p) { return vec3(dot(light_right.xyz, p), dot(light_up.xyz, p), dot(light_sun.xyz, p)); }

// Rounded outwards in steps, so that the map does not shift with every small movement.
void shadow_bounds(out vec3 lower, out vec3 upper)
{
    if (lower_keys[0] > upper_keys[0]) { // no body in sight
        lower = in_light_axes(target.xyz) - 0.5 * target.w;
        upper = lower + target.w;
        return;
    }
    float grain = target.w / 16.0;
    lower = grain * floor(vec3(from_key(lower_keys[0]), from_key(lower_keys[1]), from_key(lower_keys[2])) / grain);
    upper = grain * ceil(vec3(from_key(upper_keys[0]), from_key(upper_keys[1]), from_key(upper_keys[2])) / grain);
}

// From world space to the map: xy 0 to 1 inside it, z 0 (nearest to the sun) to 1.
vec3 in_shadow_map(vec3 p, vec3 lower, vec3 upper)
{
    vec3 unit = (in_light_axes(p) - lower) / max(upper - lower, vec3(1e-6));
    return vec3(unit.xy, 1.0 - unit.z);
}
