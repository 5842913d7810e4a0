// SPDX-License-Identifier: MIT
// One invocation is a manifold in the order of colours: the impulses of the whole step, hits included, go where its
// pair is. Launched only where contacts are watched, and for no fewer than there are: for all pairs of the graph.
// Reads: Counters, Constraints.
// Writes: ContactImpulses, of the pairs that the solver treats.
// Needs: a barrier after the last pass of the solver.
// Overflow: none; launched empty after a step that did not fit.
#include "finish/contact_report.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer Constraints { ContactConstraintCellBlock constraints[]; };
layout(std430) writeonly buffer ContactImpulses { ContactImpulseCells contact_impulses[]; };

void main()
{
    uint index = item_index();
    if (index >= counters[k_counter_manifold_count]) return;
    ContactConstraint c = unpack_ContactConstraint(constraints, index);
    ContactImpulse gathered;
    gathered.normal_impulse = c.total_impulse;
    contact_impulses[c.manifold] = pack(gathered);
}
