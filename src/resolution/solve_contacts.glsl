// SPDX-License-Identifier: MIT
// One invocation is a manifold of one colour: one pass of sequential impulses over its points (thesis, section 3.4).
// args.x: the colour; args.y: the pass, k_warm_start, k_solve, ...; args.z: the tick. No two manifolds of a colour
// share a body that they could push. The overflow set is solved one after the other by a single invocation.
// Before this file the kernel defines k_hubs: whether the colour is one for contacts of hubs. Where there are hubs nothing
// bounces.
// Reads: ColourOffsets, Constraints, Inertias, Properties, Loads, Deltas.
// Writes: Velocities, WarmStarts, Constraints (impulses), HubChanges.
// Needs: a barrier after the colour before.
// Overflow: none; launched empty after a step that did not fit.
#include "state/math.shared.glsl"
#include "resolution/body.shared.glsl"
#include "resolution/contact_counts.shared.glsl"
#include "resolution/contact_frame.shared.glsl"
#include "resolution/softness.shared.glsl"
#include "resolution/multirate.shared.glsl"
#include "resolution/manifold_rows.shared.glsl"
#include "resolution/contact.shared.glsl"
#include "resolution/hub.shared.glsl"
#include "resolution/hit.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer ColourOffsets { uint colour_offsets[]; };
layout(std430) buffer Velocities { BodyVelocityCells velocities[]; };
layout(std430) writeonly buffer HubChanges { HubChange hub_changes[]; };

uint slot_of(uint body) { return body; }
BodyVelocity load_velocity(uint body) { return unpack(velocities[body]); }
void store_velocity(uint body, BodyVelocity velocity) { velocities[body] = pack(velocity); }

#include "resolution/stored_deltas.glsl"

BodyDelta load_delta(uint body, uint slot) { return load_stored_delta(body); }

const bool k_bounces = !k_hubs;
const bool k_multirate_islands = true;

void put_change(uint index, HubChange change)
{
    hub_changes[index - colour_offsets[k_first_hub_colour]] = change;
}

void look_early() {}

#include "resolution/contact_passes.glsl"

Substep substep_in_hand(float present_load_speed)
{
    return make_substep(substeps, is_against_static(traits), present_load_speed, parameters);
}

void main()
{
    uint index = colour_offsets[args.x] + item_index();
    uint end = colour_offsets[args.x + 1u];
    if (args.x == k_overflow_colour) {
        if (item_index() != 0u) return;
    } else {
        end = min(end, index + 1u);
    }
    for (; index < end; ++index) {
        uint substep = substep_at(args.z, cell_in_block(constraints, index, 4u).w); // its traits
        if (substep >= substeps_of_contact(cell_in_block(constraints, index, 0u).w)) continue;
        take_constraint(index, k_hubs);
        PassTarget target;
        if (args.y != k_warm_start) target = target_of_pass(args.y, have_moved(args.y, args.z));
        pass_over_constraint(args.y, args.z, index, target);
        put_back_impulses(index);
    }
}
