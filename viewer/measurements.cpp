// SPDX-License-Identifier: MIT
#include "viewer/measurements.h"

#include <algorithm>
#include <numeric>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

namespace talus::viewer {

namespace {

constexpr std::chrono::milliseconds k_energy_interval{100};
constexpr int k_rest = 30; // times as long as it took until energy is measured again

} // namespace

void Curve::add(float value) {
    if (kept.size() == k_length) kept.erase(kept.begin());
    kept.push_back(value);
}

float Curve::largest() const noexcept {
    return kept.empty() ? 0.0f : *std::ranges::max_element(kept);
}

float Curve::mean() const noexcept {
    constexpr std::size_t k_values = 15;
    const std::size_t count = std::min(kept.size(), k_values);
    return count == 0 ? 0.0f
                      : std::accumulate(kept.end() - static_cast<std::ptrdiff_t>(count), kept.end(), 0.0f) /
                            static_cast<float>(count);
}

Energy energy_of(const World& world) {
    const std::vector<BodyId> bodies = world.bodies();
    const std::vector<Pose> poses = world.poses();
    const std::vector<Velocity> velocities = world.velocities();
    const Vec3 g = world.settings().gravity;
    Energy energy;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (world.kind(bodies[i]) != BodyKind::Rigid) continue;
        const double mass = world.mass(bodies[i]);
        const auto& [linear, angular] = velocities[i];
        const Quat& q = poses[i].rotation;
        const glm::dvec3 v(linear.x, linear.y, linear.z);
        const glm::dvec3 spin =
            glm::conjugate(glm::dquat(q.w, q.x, q.y, q.z)) * glm::dvec3(angular.x, angular.y, angular.z);
        const Vec3 inertia = world.inertia(bodies[i]);
        energy.kinetic +=
            0.5 * mass * glm::dot(v, v) +
            0.5 * (inertia.x * spin.x * spin.x + inertia.y * spin.y * spin.y + inertia.z * spin.z * spin.z);
        const Vec3& p = poses[i].position;
        energy.potential -=
            mass * world.gravity_scale(bodies[i]) * (double{g.x} * p.x + double{g.y} * p.y + double{g.z} * p.z);
    }
    return energy;
}

void Measurements::update(const World& world) {
    if (world.step_count() == step) return;
    step = world.step_count();
    const StepReport report = world.report();
    step_ms.add(static_cast<float>(report.step_ms));
    pairs.add(static_cast<float>(report.pairs));
    contacts.add(static_cast<float>(report.contacts));
    colours.add(static_cast<float>(report.colours));
    substeps.add(static_cast<float>(report.substeps));
    stage_ms.resize(report.stage_ms.size());
    for (std::size_t i = 0; i < stage_ms.size(); ++i)
        stage_ms[i].add(static_cast<float>(report.stage_ms[i]));
    memory = world.memory();

    const auto now = std::chrono::steady_clock::now();
    if (now < next_energy) return;
    const Energy energy = energy_of(world);
    const auto end = std::chrono::steady_clock::now();
    next_energy = end + std::max<std::chrono::nanoseconds>(k_energy_interval, k_rest * (end - now));
    kinetic.add(static_cast<float>(energy.kinetic));
    total.add(static_cast<float>(energy.kinetic + energy.potential));
}

} // namespace talus::viewer
