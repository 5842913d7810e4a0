// SPDX-License-Identifier: MIT
// The softness of contacts. A soft row is a spring and a damper between the bodies, stepped implicitly, so that it is
// stable however stiff: with angular frequency w, damping ratio z and sub-step h
//   bias_rate = w / (2 z + h w),  mass_scale = h w (2 z + h w) / (1 + h w (2 z + h w)),
//   impulse_scale = 1 / (1 + h w (2 z + h w)).
// Catto, "Soft Contacts" (2023) and "Solver2D" (2024).
#include "parameters.h"

#include <algorithm>
#include <numbers>

namespace talus::engine {
namespace {

// A contact is seen this far ahead of touching (m).
constexpr float k_speculative_distance = 0.02f;
// Overlap that Baumgarte's bias leaves alone, so that contacts at rest do not come and go (m).
constexpr float k_baumgarte_slop = 0.005f;

struct SoftRow {
    float bias_rate, mass_scale, impulse_scale;
};

SoftRow soft_row(float hertz, float damping_ratio, float h) {
    const float w = 2.0f * std::numbers::pi_v<float> * hertz;
    const float a = 2.0f * damping_ratio + h * w;
    const float b = h * w * a;
    return {w / a, b / (1.0f + b), 1.0f / (1.0f + b)};
}

} // namespace

Passes passes_of(const Settings& settings) {
    if (settings.stabilisation == Stabilisation::Baumgarte) return {1, settings.iterations, false};
    return {settings.substeps, settings.iterations, true};
}

Parameters make_parameters(const Settings& settings, const StepPlan& plan) {
    Parameters p{};
    p.gravity = vec3(settings.gravity.x, settings.gravity.y, settings.gravity.z);
    p.dt = settings.dt;
    p.h = settings.dt / static_cast<float>(plan.substeps);
    p.inv_h = 1.0f / p.h;
    p.restitution_threshold = settings.restitution_threshold;
    p.contact_push_speed = settings.contact_push_speed;
    p.max_linear_speed = settings.max_linear_speed;
    p.max_angular_speed = settings.max_angular_speed;
    p.speculative_distance = k_speculative_distance;

    if (settings.stabilisation == Stabilisation::Soft) {
        // A spring faster than a quarter of the sub-step rate would ring.
        const float hertz = std::min(settings.contact_hertz, 0.25f * p.inv_h);
        const SoftRow soft = soft_row(hertz, settings.contact_damping_ratio, p.h);
        const SoftRow against_static = soft_row(2.0f * hertz, settings.contact_damping_ratio, p.h);
        p.bias_rate = soft.bias_rate;
        p.mass_scale = soft.mass_scale;
        p.impulse_scale = soft.impulse_scale;
        p.static_bias_rate = against_static.bias_rate;
        p.static_mass_scale = against_static.mass_scale;
        p.static_impulse_scale = against_static.impulse_scale;
    } else { // equation 3.17
        p.bias_rate = p.static_bias_rate = settings.baumgarte * p.inv_h;
        p.mass_scale = p.static_mass_scale = 1.0f;
        p.impulse_scale = p.static_impulse_scale = 0.0f;
        p.linear_slop = k_baumgarte_slop;
    }

    p.body_count = plan.body_count;
    p.substeps = plan.substeps;
    p.iterations = plan.iterations;
    p.relax = plan.relax ? 1 : 0;
    p.pair_capacity = plan.pair_capacity;
    p.colour_capacity = plan.colour_capacity;
    p.overflow_capacity = plan.overflow ? 1 : 0;
    p.table_size = plan.table_size;
    return p;
}

} // namespace talus::engine
