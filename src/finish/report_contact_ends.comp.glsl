// SPDX-License-Identifier: MIT
// One invocation is a pair of the last step: a report where its bodies touched, and do so no longer. Launched only
// where contacts are watched. args.y: reports that leave with the step.
// Reads: OldManifolds, OldContactStates.
// Writes: ContactReports, in an order that depends on who comes first; Counters.
// Needs: a barrier after report_contacts.
// Overflow: as in report_contacts.
#include "finish/contact_report.shared.glsl"

layout(local_size_x = 64) in;

layout(std430) readonly buffer OldManifolds { ManifoldCells old_manifolds[]; };
layout(std430) readonly buffer OldContactStates { uint old_contact_states[]; };
layout(std430) writeonly buffer ContactReports { ContactReportCells contact_reports[]; };
layout(std430) buffer Counters { uint counters[]; };

void main()
{
    uint pair = item_index();
    if (pair >= counters[k_counter_old_pair_count]) return;
    if (old_contact_states[pair] != k_contact_touches) return;
    uint place = atomicAdd(counters[k_counter_report_count], 1u);
    contact_reports[place] = pack(make_report(unpack(old_manifolds[pair]), k_phase_end));
    if (place >= args.y) atomicOr(counters[k_counter_did_not_fit], k_fit_reports);
}
