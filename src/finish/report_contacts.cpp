// SPDX-License-Identifier: MIT
// CPU twin of report_contacts.comp.glsl.
#include "device/cpu/cpu_state.h"
#include "finish/finish.h"
#include "narrow_phase/pair_table.h"
#include "state/formulas.h"

namespace talus::engine {

static void report_contacts_on_cpu(CpuState& state, const Launch& launch) {
    for (uint pair = 0; pair < state.counters[k_counter_pair_count]; ++pair) {
        state.contact_states[pair] = k_contact_apart;
        const Manifold& manifold = state.manifolds[pair];
        if (manifold.point_count == 0) continue;
        const uint old_index = find_old_manifold(state, manifold.body_a, manifold.body_b);
        const bool touched = old_index != k_none && state.old_contact_states[old_index] == k_contact_touches;

        const bool asleep =
            is_active(manifold) && sleeps_through(state.poses[manifold.body_a], state.shapes[manifold.body_a],
                                                  state.poses[manifold.body_b], state.shapes[manifold.body_b]);
        vec4 impulse(0.0f);
        if (asleep)
            impulse = state.point_impulses[pair].normal;
        else if (is_active(manifold))
            impulse = state.contact_impulses[pair].normal_impulse;
        const vec3 centre_a = state.poses[manifold.body_a].position;
        ContactReport report = make_report(manifold, touched ? k_phase_persist : k_phase_begin);
        bool touches = asleep && touched;
        for (uint i = 0; i < manifold.point_count; ++i) {
            const vec3 position = point_position(centre_a, state.manifold_points[std::size_t{4} * pair + i].anchor);
            const float separation = state.point_separations[pair].separation[static_cast<int>(i)];
            const float along_normal = impulse[static_cast<int>(i)];
            touches = touches || touches_at(separation, along_normal, touched);
            report = add_point(report, static_cast<int>(i), position, separation, along_normal);
        }
        if (!touches) continue;
        state.contact_states[pair] = k_contact_touches;
        if (touched) state.old_contact_states[old_index] = k_contact_apart;
        if (touched && launch.args[0] == 0) continue;
        const uint place = state.counters[k_counter_report_count]++;
        state.contact_reports[place] = report;
        if (place >= launch.args[1]) state.counters[k_counter_did_not_fit] |= k_fit_reports;
    }
}

const Kernel report_contacts{"finish/report_contacts", report_contacts_on_cpu};

} // namespace talus::engine
