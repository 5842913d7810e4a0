// SPDX-License-Identifier: MIT
// CPU twin of weigh_sleepers.comp.glsl.
#include <atomic>

#include "device/cpu/cpu_state.h"
#include "finish/finish.h"
#include "state/formulas.h"

namespace talus::engine {
namespace {

void add_push(CpuState& state, uint body, const Push& push) {
    const float inverse_mass = state.properties[body].inverse_mass;
    const vec3 impulse = scale3(push.impulse, inverse_mass);
    const vec3 moment =
        speeds_by_moment(push.moment, state.poses[body].rotation, state.properties[body], state.shapes[body]);
    uint* const words = &state.balances[std::size_t{k_balance_words} * body];
    const auto add = [&](uint word, float speed) {
        std::atomic_ref(words[word]).fetch_add(balance_word(speed), std::memory_order_relaxed);
    };
    for (uint i = 0; i < 3; ++i) {
        add(k_balance_impulse + i, impulse[static_cast<int>(i)]);
        add(k_balance_moment + i, moment[static_cast<int>(i)]);
    }
    add(k_balance_load, push.size * inverse_mass);
}

void weigh_sleepers_on_cpu(CpuState& state, const Launch&) {
    if ((state.counters[k_counter_did_not_fit] & ~k_fit_reports) != 0) return;
    const auto is_weighed = [&](uint body) { return (state.island_fill[body] & k_pressed) != 0; };
    state.parallel(state.counters[k_counter_graph_pairs], [&](uint entry) {
        const uint pair = state.listed_pairs[entry];
        const Manifold& manifold = state.manifolds[pair];
        const uint a = manifold.body_a, b = manifold.body_b;
        if (!is_active(manifold) || !(is_weighed(a) || is_weighed(b))) return;
        const vec4 normal = state.point_impulses[pair].normal;
        vec3 anchors[4];
        for (uint i = 0; i < 4; ++i)
            anchors[i] = state.manifold_points[std::size_t{4} * pair + i].anchor;
        if (is_weighed(a)) add_push(state, a, push_of_contact(manifold, normal, anchors, vec3(0.0f), -1.0f));
        if (!is_weighed(b)) return;
        const vec3 offset =
            offset_at_meeting(state.poses[a].position, state.poses[b].position, state.point_separations[pair].shift);
        add_push(state, b, push_of_contact(manifold, normal, anchors, offset, 1.0f));
    });
}

} // namespace

const Kernel weigh_sleepers{"finish/weigh_sleepers", weigh_sleepers_on_cpu};

} // namespace talus::engine
