// SPDX-License-Identifier: MIT
// One invocation is a body slot: the movement that ends a sub-step, and the forces that begin the next one.
// args.x: the tick. args.y: 1 where something may bounce.
// Reads: Properties, Loads, Inertias.
// Writes: Velocities, Deltas, WarmStarts (and hits behind them); Poses (flags) and Counters where a body is frozen.
// Needs: a barrier after prepare_bodies, and after the pass before.
// Overflow: none; launched empty after a step that did not fit.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/body.shared.glsl"
#include "resolution/softness.shared.glsl"
#include "resolution/multirate.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) readonly buffer Properties { BodyPropertiesCells properties[]; };
layout(std430) readonly buffer Inertias { BodyInertiaCells inertias[]; };
layout(std430) buffer Deltas { BodyDeltaCells deltas[]; };
layout(std430) buffer WarmStarts { BodyWarmStartCells warm_starts[]; };
layout(std430) buffer Counters { uint counters[]; };

uint slot_of(uint body) { return body; }
BodyVelocity load_velocity(uint body) { return unpack(velocities[body]); }
BodyDelta load_delta(uint body, uint slot) { return unpack(deltas[body]); }
void store_delta(uint body, uint slot, BodyDelta delta) { deltas[body] = pack(delta); }
BodyWarmStart load_warm_start(uint body) { return unpack(warm_starts[body]); }
bool some_bounce() { return args.y == 1u; }
void store_velocity(uint body, BodyVelocity velocity) { velocities[body] = pack(velocity); }

const bool k_multirate_islands = true;
bool is_own(BodyInertia inertia) { return is_launched(inertia); }
BodyVelocity load_settled_velocity(uint body, uint its_traits) { return load_velocity(body); }

#include "resolution/stored_hits.glsl"
#include "resolution/body_passes.glsl"

void main()
{
    uint body = item_index();
    if (body >= parameters.body_count) return;
    integrate_body(body, args.x);
}
