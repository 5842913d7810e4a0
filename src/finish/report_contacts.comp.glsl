// SPDX-License-Identifier: MIT
// One invocation is a pair: whether its bodies touch, and a report where that is new. Launched only where contacts are
// watched. What touched as it fell asleep goes on touching, with the impulses of then.
// args.x: 1 where contacts that persist are reported too; args.y: reports that leave with the step.
// Reads: PairTable, Poses as they were at the start of the step, OldManifolds, Manifolds, ManifoldPoints, PointSeparations,
// PointImpulses, ContactImpulses.
// Writes: ContactStates; OldContactStates, 0 where the contact goes on; ContactReports, in an order that depends on who
// comes first; Counters.
// Needs: barriers after gather_contact_impulses and fill_pair_table.
// Overflow: none in the buffer, which has room for a report of each pair, old and new. Where more reports are made than
// leave with the step, k_fit_reports holds back the steps behind it until the host has fetched the rest.
#include "state/math.shared.glsl"
#include "broad_phase/aabb.shared.glsl"
#include "resolution/sleep.shared.glsl"
#include "narrow_phase/pair_table.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "finish/contact_report.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer PairTable { uint pair_table[]; };
layout(std430) readonly buffer Poses { BodyPoseCells poses[]; };
layout(std430) readonly buffer OldManifolds { ManifoldCells old_manifolds[]; };
layout(std430) readonly buffer Shapes { BodyShapeCells shapes[]; };
layout(std430) readonly buffer Manifolds { ManifoldCells manifolds[]; };
layout(std430) readonly buffer ManifoldPoints { ManifoldPointCells manifold_points[]; };
layout(std430) readonly buffer PointSeparations { SeparationsCells point_separations[]; };
layout(std430) readonly buffer PointImpulses { NormalImpulsesCells point_impulses[]; };
layout(std430) readonly buffer ContactImpulses { ContactImpulseCells contact_impulses[]; };
layout(std430) writeonly buffer ContactStates { uint contact_states[]; };
layout(std430) buffer OldContactStates { uint old_contact_states[]; };
layout(std430) writeonly buffer ContactReports { ContactReportCells contact_reports[]; };
layout(std430) buffer Counters { uint counters[]; };

#include "narrow_phase/find_old_manifold.glsl"

void main()
{
    uint pair = item_index();
    if (pair >= counters[k_counter_pair_count] || (counters[k_counter_did_not_fit] & k_fit_groups) != 0u) return;
    contact_states[pair] = k_contact_apart;
    Manifold manifold = unpack(manifolds[pair]);
    if (manifold.point_count == 0u) return;
    uint old_index = find_old_manifold(manifold.body_a, manifold.body_b);
    bool touched = old_index != k_none && old_contact_states[old_index] == k_contact_touches;

    bool asleep =
        is_active(manifold) && sleeps_through(unpack(poses[manifold.body_a]), unpack(shapes[manifold.body_a]),
                                              unpack(poses[manifold.body_b]), unpack(shapes[manifold.body_b]));
    vec4 impulse = vec4(0.0);
    if (asleep)
        impulse = unpack(point_impulses[pair]).normal;
    else if (is_active(manifold))
        impulse = unpack(contact_impulses[pair]).normal_impulse;
    vec3 centre_a = unpack(poses[manifold.body_a]).position;
    vec4 separation = unpack(point_separations[pair]).separation;
    ContactReport report = make_report(manifold, touched ? k_phase_persist : k_phase_begin);
    bool touches = asleep && touched;
    for (uint i = 0u; i < 4u; ++i) {
        if (i >= manifold.point_count) continue;
        vec3 position = point_position(centre_a, unpack(manifold_points[4u * pair + i]).anchor);
        touches = touches || touches_at(separation[i], impulse[i], touched);
        report = add_point(report, int(i), position, separation[i], impulse[i]);
    }
    if (!touches) return;
    contact_states[pair] = k_contact_touches;
    if (touched) old_contact_states[old_index] = k_contact_apart;
    if (touched && args.x == 0u) return;
    uint place = atomicAdd(counters[k_counter_report_count], 1u);
    contact_reports[place] = pack(report);
    if (place >= args.y) atomicOr(counters[k_counter_did_not_fit], k_fit_reports);
}
