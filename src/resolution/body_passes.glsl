// SPDX-License-Identifier: MIT
// What a sub-step does to one body. Before this file the kernel defines slot_of and what loads and stores by slots, as
// for contact_passes.glsl, and declares Inertias and Counters. The CPU's counterpart is body_passes.h.
// Reads: Shapes, Properties, Loads, Inertias. Reads and writes: Poses (its flags).

layout(std430) buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Properties { BodyPropertiesCells properties[]; };
layout(std430) readonly buffer Loads { BodyLoadCells loads[]; };

// Ends the sub-step before `substep` with its movement, and begins `substep` with its forces: between the two nothing
// happens. A body whose sub-steps are all done is left alone. All is loaded first, so that no load waits for another.
void integrate_body(uint body, uint slot, uint substep)
{
    BodyInertia inertia = unpack(inertias[body]);
    BodyShape shape = unpack(shapes[body]);
    BodyPose pose = unpack(poses[body]);
    BodyVelocity velocity = load_velocity(slot);
    BodyDelta delta = load_delta(slot);
    BodyWarmStart warm = load_warm_start(slot);
    BodyProperties its_properties = unpack(properties[body]);
    BodyLoad load = unpack(loads[body]);
    if (substep > inertia.substeps || !is_mover(shape) || (pose.flags & k_body_frozen) != 0u) return;
    float h = substep_length(inertia.substeps, parameters);
    if (substep > 0u) {
        delta = integrate_position(delta, warm, velocity, h);
        store_delta(slot, delta);
    }
    if (substep == inertia.substeps) return;

    vec4 rotation = multiply_quaternions(delta.rotation, pose.rotation);
    warm = gather_impulses(warm, velocity);
    velocity = integrate_velocity(velocity, warm, rotation, its_properties, inertia, load, is_movable(shape), h,
                                  parameters);
    if (!is_finite3(velocity.linear) || !is_finite3(velocity.angular)) {
        velocity = frozen_velocity();
        warm = no_warm_start(velocity);
        pose.flags |= k_body_frozen;
        poses[body] = pack(pose);
        atomicAdd(counters[k_counter_frozen_bodies], 1u);
    }
    warm.linear_before = velocity.linear;
    warm.angular_before = velocity.angular;
    store_warm_start(slot, warm);
    store_velocity(slot, velocity);
}
