// SPDX-License-Identifier: MIT
// CPU twin of prepare_bodies.comp.glsl.
#include <atomic>

#include "device/cpu/cpu_state.h"
#include "resolution/resolution.h"
#include "resolution/stored_hits.h"
#include "state/formulas.h"

namespace talus::engine {

static void prepare_bodies_on_cpu(CpuState& state, const Launch& launch) {
    state.parallel(state.parameters.body_count, [&](uint body) {
        if (launch.args[2] == 1) put_hits(state, body, no_hits(no_warm_start()));
        state.told_loads[k_told_words * body + k_told_mass] = 0;
        state.told_loads[k_told_words * body + k_told_height] = 0;
        state.told_loads[told_foot_word(body, state.parameters.body_count)] = 0;
        BodyPose& pose = state.poses[body];
        const bool asleep =
            state.parameters.rest_steps > 0 && is_movable(state.shapes[body]) && state.substeps[body] == 0;
        const bool slept = is_asleep(pose);
        const uint kept = asleep && (launch.args[3] & k_with_parts) != 0 ? state.island_sizes[body] : 0;
        const bool was_in_part = (pose.flags & k_body_in_part) != 0;
        pose.flags = flags_in_step(pose, state.shapes[body], asleep, kept != 0, state.parameters);
        if (asleep) std::atomic_ref(state.counters[k_counter_sleeping_bodies]).fetch_add(1, std::memory_order_relaxed);
        if (asleep && !slept) state.velocities[body] = stop(state.velocities[body]);
        if (asleep && keeps_anew(kept, slept && was_in_part, state.counters[k_counter_pairs_changed] != 0))
            state.rests[body] = with_calm(state.rests[body], kept);
        else if (asleep && !slept)
            state.rests[body] = with_calm(state.rests[body], state.parameters.rest_steps);
        if (asleep && slept && (launch.args[3] & k_with_records) != 0) return;
        state.deltas[body] = no_delta();
        const uint traits = traits_of_body(state.shapes[body], pose);
        const vec3& inverse_inertia = state.properties[body].inverse_inertia;
        if (asleep) {
            state.inertias[body] = inertia_asleep(pose.rotation, inverse_inertia, traits);
            return;
        }
        const uint ticks = state.counters[k_counter_launched_substeps];
        const uint word = launch.args[0] == 1 ? state.substeps[body] : ticks;
        const uint substeps = number_of_substeps(word);
        state.inertias[body] = world_inertia(pose.rotation, inverse_inertia, traits, substeps);
        const uint* const words = &state.body_colours[body_word(body, 0)];
        state.inertias[body].traits |=
            traits_in_graph(state.inertias[body].traits, words[k_used_low], words[k_used_high], words[k_hub_word]);
        if (word != substeps) state.inertias[body].traits |= slowness_trait(ticks, substeps);
        if ((word & k_multirate_tall) != 0) state.inertias[body].traits |= k_trait_of_tall;
        if ((launch.args[3] & k_with_loads) != 0 && is_loaded(state.loads[body]))
            state.inertias[body].traits |= k_trait_loaded;
        if (launch.args[1] == 1 && state.island_groups[body] != k_launched)
            state.inertias[body].traits |= k_trait_grouped;
        if (is_in_launched_bodies(state.inertias[body])) {
            const uint place = std::atomic_ref(state.counters[k_counter_launched_bodies]).fetch_add(1);
            state.launched_bodies[place] = body;
        }
        state.warm_starts[body] = kept_warm_start(no_warm_start(), state.velocities[body]);
    });
}

const Kernel prepare_bodies{"resolution/prepare_bodies", prepare_bodies_on_cpu};

} // namespace talus::engine
