// SPDX-License-Identifier: MIT
// The passes over one body: integration of velocities and positions. Before this file the kernel defines load_velocity
// and store_velocity, as for contact_passes.glsl, and declares Inertias and Deltas. The CPU's counterpart is
// body_passes.h.
// Reads: Shapes, Properties, Loads, Inertias. Reads and writes: Poses (its flags), WarmStarts, Deltas.

layout(std430) buffer Poses { BodyPose poses[]; };
layout(std430) readonly buffer Shapes { BodyShape shapes[]; };
layout(std430) readonly buffer Properties { BodyProperties properties[]; };
layout(std430) readonly buffer Loads { BodyLoad loads[]; };
layout(std430) buffer WarmStarts { BodyWarmStart warm_starts[]; };

bool moves(uint body)
{
    return is_mover(shapes[body]) && (poses[body].flags & k_body_frozen) == 0u;
}

void integrate_body_velocity(uint body)
{
    if (!moves(body)) return;
    BodyDelta delta = deltas[body];
    vec4 rotation = multiply_quaternions(delta.rotation, poses[body].rotation);
    BodyVelocity velocity = load_velocity(body);
    BodyWarmStart warm = gather_impulses(warm_starts[body], velocity);
    velocity = integrate_velocity(velocity, warm, rotation, properties[body], inertias[body], loads[body],
                                  is_movable(shapes[body]), parameters);
    if (!is_finite3(velocity.linear) || !is_finite3(velocity.angular)) {
        velocity = frozen_velocity();
        warm = no_warm_start(velocity);
        poses[body].flags |= k_body_frozen;
        atomicAdd(counters[k_counter_frozen_bodies], 1u);
    }
    warm.linear_before = velocity.linear;
    warm.angular_before = velocity.angular;
    warm_starts[body] = warm;
    store_velocity(body, velocity);
}

void integrate_body_position(uint body)
{
    if (!moves(body)) return;
    BodyDelta delta = deltas[body]; // a coherent block's member is no argument: NVIDIA's compiler refuses it
    deltas[body] = integrate_position(delta, load_velocity(body), parameters.h);
}
