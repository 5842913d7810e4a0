// SPDX-License-Identifier: MIT
// What the caller does to a body in the step. Few have a load, and there may be no room for any: so those are asked alone of which
// prepare_bodies says that they have one.
// Reads: Loads.

layout(std430) readonly buffer Loads { BodyLoadCells loads[]; };

BodyLoad load_of_body(uint body, BodyInertia inertia)
{
    BodyLoad load = no_load();
    if ((inertia.traits & k_trait_loaded) != 0u) load = unpack(loads[body]);
    return load;
}
