// SPDX-License-Identifier: MIT
// What every shader of the renderer knows: the camera, the light, and the buffers to draw from.

layout(std140, binding = 0) uniform View {
    mat4 view_projection;
    vec4 eye;         // xyz m, world; w: height of a pixel at a distance of 1 m
    vec4 target;      // xyz m, world; w: distance from the eye, the length that the picture is scaled by
    vec4 light_right; // the light's axes in world space, orthonormal
    vec4 light_up;
    vec4 light_sun;   // towards the sun
    vec4 sizes;       // x: size of a typical body, y: distance of grid lines (m), z: shadow map texels a side,
                      // w: places a side that a shadow is averaged over
    vec4 viewport;    // xy: pixels
};

layout(std430, binding = 0) readonly buffer Poses { BodyPose poses[]; };
layout(std430, binding = 1) readonly buffer Shapes { BodyShape shapes[]; };
layout(std430, binding = 2) readonly buffer Slots { uint slots[]; }; // the body slots to draw: boxes, then spheres
layout(std430, binding = 3) readonly buffer Tints { uint tints[]; }; // a body slot: packed colour, 0: the body's own

uniform uint first_instance; // entry of Slots that the draw call or launch starts at

vec3 rotate(vec4 rotation, vec3 v)
{
    vec3 t = 2.0 * cross(rotation.xyz, v);
    return v + rotation.w * t + cross(rotation.xyz, t);
}

uint kind_of(BodyShape shape) { return (shape.type >> 8) & 0xffu; }

bool is_sensor(BodyShape shape) { return (shape.type & k_sensor_bit) != 0u; }

bool is_sphere(BodyShape shape) { return (shape.type & 0xffu) == k_shape_sphere; }

// Radius of a ball around the body's centre that holds all of it.
float reach_of(BodyShape shape) { return is_sphere(shape) ? shape.half_extents.x : length(shape.half_extents); }

// The sky, and what the far ground fades into; y from 0 (bottom of the picture) to 1. Linear colour.
vec3 background(float y) { return mix(vec3(0.56, 0.62, 0.69), vec3(0.86, 0.90, 0.94), smoothstep(0.0, 1.0, y)); }
