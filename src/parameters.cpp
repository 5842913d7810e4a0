// SPDX-License-Identifier: MIT
#include "parameters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace talus::engine {
namespace {

// A contact is seen this far ahead of touching (m).
constexpr float k_speculative_distance = 0.012f;
// Overlap that Baumgarte's bias leaves alone, so that contacts at rest do not come and go (m).
constexpr float k_baumgarte_slop = 0.005f;

// What stays where it is may be so many times as fast as what goes somewhere, and still be said to rest.
constexpr float k_jitter = 5.0f;

// Contacts of a body that are more than so many share it, where the caller says nothing. A small world with such a body
// is no longer solved by work groups, to which 62 colours are nothing. In a large world each colour of each pass is
// a wait of all groups, and a hub's contacts cost as many as four.
constexpr uint k_hub_contacts_of_small = 1000;
constexpr uint k_hub_contacts_of_large = 32;

// Loads are counted in weights; without gravity, in those of the Earth (m/s²).
constexpr float k_standard_gravity = 9.81f;

} // namespace

Passes passes_of(const Settings& settings) {
    if (settings.stabilisation == Stabilisation::Baumgarte) return {1, 1, settings.iterations, false};
    return {settings.substeps, std::max(settings.substeps, settings.max_substeps), settings.iterations, true};
}

/// At least one, so that what begins at rest still falls; and no more than a body can count.
static uint rest_steps_of(const Settings& settings) {
    constexpr uint most = (~0u >> k_rest_shift) / 2; // a body counts to twice as many
    return std::clamp(static_cast<uint>(std::ceil(settings.sleep_time / settings.dt)), 1u, most);
}

static uint hub_contacts_of(const Settings& settings, const StepPlan& plan) {
    if (settings.hub_contacts > 0) return settings.hub_contacts;
    return plan.small ? k_hub_contacts_of_small : k_hub_contacts_of_large;
}

Parameters make_parameters(const Settings& settings, const StepPlan& plan) {
    Parameters p{};
    p.gravity = vec3(settings.gravity.x, settings.gravity.y, settings.gravity.z);
    const float gravity = glm::length(p.gravity);
    p.dt = settings.dt;
    p.inv_dt = 1.0f / settings.dt;
    p.inverse_weight = p.inv_dt / (gravity > 0.0f ? gravity : k_standard_gravity);
    p.restitution_threshold = settings.restitution_threshold;
    p.contact_push_speed = settings.contact_push_speed;
    p.max_linear_speed = settings.max_linear_speed;
    p.max_angular_speed = settings.max_angular_speed;
    p.speculative_distance = k_speculative_distance;

    if (settings.stabilisation == Stabilisation::Soft) {
        p.contact_frequency = 2.0f * std::numbers::pi_v<float> * settings.contact_hertz;
        p.contact_damping_ratio = settings.contact_damping_ratio;
    } else { // equation 3.17
        p.baumgarte = settings.baumgarte;
        p.linear_slop = k_baumgarte_slop;
    }

    p.body_count = plan.body_count;
    p.least_substeps = plan.least_substeps;
    p.fewest_substeps = plan.fewest_substeps();
    p.most_substeps = plan.most_substeps;
    p.substep_capacity = plan.substep_capacity;
    p.iterations = plan.iterations;
    p.relax = plan.relax ? 1 : 0;
    p.pair_capacity = plan.pair_capacity;
    p.manifold_capacity = plan.manifold_capacity;
    p.colour_capacity = plan.colour_capacity;
    p.table_size = plan.table_size;
    const bool coloured = settings.solve_order == SolveOrder::Coloured;
    p.usable_colours = coloured ? k_first_hub_colour : 0;
    p.hub_contacts = coloured && !plan.bounces ? hub_contacts_of(settings, plan) : k_none;
    p.hub_capacity = plan.hub_capacity;
    p.rest_steps = settings.sleeping ? rest_steps_of(settings) : 0;
    p.rest_distance = settings.sleep_speed * settings.dt * static_cast<float>(rest_steps_of(settings));
    p.rest_way = k_jitter * settings.sleep_speed * settings.dt;
    return p;
}

} // namespace talus::engine
