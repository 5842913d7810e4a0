// SPDX-License-Identifier: MIT
#include "checks.h"

#include <atomic>
#include <cmath>

#include <fmt/format.h>

#include "body_table.h"
#include "host_loops.h"

namespace talus::engine {
namespace {

constexpr float k_largest_coordinate = 1.0e6f; // m: beyond it floats are coarser than the contact margin
constexpr float k_largest_size = 1.0e5f;       // m
constexpr float k_smallest_size = 1.0e-4f;     // m
constexpr float k_largest_value = 1.0e12f;     // forces, masses, inertia: their squares still fit a float
constexpr float k_smallest_value = 1.0e-30f;   // masses, inertia: their inverses still fit a float

[[noreturn]] void refuse(const Where& where, const std::string& message) {
    throw Error(where.in_words() + ": " + message);
}

void check_range(float value, float lowest, float highest, const Where& where, const char* what, const char* unit) {
    if (value >= lowest && value <= highest) return;
    refuse(where, fmt::format("{} is {}{}; allowed is {} to {}{}", what, value, unit, lowest, highest, unit));
}

void check_positive(float value, const Where& where, const char* what, const char* unit) {
    check_range(value, k_smallest_value, k_largest_value, where, what, unit);
}

void check_size(float value, const Where& where, const char* what) {
    check_range(value, k_smallest_size, k_largest_size, where, what, " m");
}

void check_capacity(std::uint32_t value, std::uint32_t highest, const char* what) {
    if (value > highest)
        refuse({"options"},
               fmt::format("capacities.{} is {}; allowed is 0 (the usual room) to {}", what, value, highest));
}

void check_combine(Combine rule, const Where& where, const char* what) {
    if (static_cast<std::uint32_t>(rule) > static_cast<std::uint32_t>(Combine::Multiply))
        refuse(where, fmt::format("{} is {}, which is no rule of Combine", what, static_cast<std::uint32_t>(rule)));
}

void check_shape(const Shape& shape, const Where& where) {
    if (const auto* box = std::get_if<Box>(&shape)) {
        check_size(box->size.x, where, "size.x of the box");
        check_size(box->size.y, where, "size.y of the box");
        check_size(box->size.z, where, "size.z of the box");
    } else {
        check_size(std::get<Sphere>(shape).radius, where, "radius of the sphere");
    }
}

} // namespace

std::string Where::in_words() const {
    return fmt::format(fmt::runtime(words), call, number);
}

Where body_of_call(const char* call, BodyId id) {
    return {"{0}: body {1}", call, id.index};
}

std::string to_words(BodyKind kind) {
    switch (kind) {
    case BodyKind::Static:
        return "static";
    case BodyKind::Rigid:
        return "rigid";
    case BodyKind::Kinematic:
        return "kinematic";
    }
    return "of unknown kind";
}

void check_finite(float value, const Where& where, const char* what) {
    if (!std::isfinite(value)) refuse(where, fmt::format("{} is {}; it must be a finite number", what, value));
    if (std::abs(value) > k_largest_value)
        refuse(where, fmt::format("{} is {}; at most {} is allowed", what, value, k_largest_value));
}

void check_finite(Vec3 v, const Where& where, const char* what) {
    if (std::abs(v.x) <= k_largest_value && std::abs(v.y) <= k_largest_value && std::abs(v.z) <= k_largest_value)
        return;
    check_finite(v.x, where, fmt::format("{}.x", what).c_str());
    check_finite(v.y, where, fmt::format("{}.y", what).c_str());
    check_finite(v.z, where, fmt::format("{}.z", what).c_str());
}

void check_pose(const Pose& pose, const Where& where) {
    const float limit = k_largest_coordinate;
    check_range(pose.position.x, -limit, limit, where, "position.x", " m");
    check_range(pose.position.y, -limit, limit, where, "position.y", " m");
    check_range(pose.position.z, -limit, limit, where, "position.z", " m");
    const float length = length_of(pose.rotation);
    if (!(std::abs(length - 1.0f) < 1.0e-2f)) {
        const auto [x, y, z, w] = pose.rotation;
        refuse(where, fmt::format("rotation ({}, {}, {}, {}) has the length {}; a unit quaternion is wanted", x, y, z,
                                  w, length));
    }
}

void check_velocity(const Velocity& velocity, const Where& where) {
    check_finite(velocity.linear, where, "linear velocity");
    check_finite(velocity.angular, where, "angular velocity");
}

void check_material(const Material& material, const Where& where) {
    check_range(material.friction, 0.0f, 1.0e6f, where, "friction", "");
    check_range(material.restitution, 0.0f, 1.0f, where, "restitution", "");
    check_combine(material.friction_combine, where, "friction_combine");
    check_combine(material.restitution_combine, where, "restitution_combine");
}

void check_definition(const BodyDefinition& definition, const Where& where) {
    if (static_cast<std::uint32_t>(definition.kind) > static_cast<std::uint32_t>(BodyKind::Kinematic))
        refuse(where, fmt::format("kind is {}; allowed are Static, Rigid and Kinematic",
                                  static_cast<std::uint32_t>(definition.kind)));
    check_shape(definition.shape, where);
    check_pose(definition.pose, where);
    check_velocity(definition.velocity, where);
    if (definition.kind == BodyKind::Static && definition.velocity != Velocity{})
        refuse(where, "a static body cannot have a velocity; make it kinematic");
    if (definition.mass)
        check_positive(*definition.mass, where, "mass", " kg");
    else
        check_positive(definition.density, where, "density", " kg/m³");
    if (definition.inertia) {
        check_positive(definition.inertia->x, where, "inertia.x", " kg·m²");
        check_positive(definition.inertia->y, where, "inertia.y", " kg·m²");
        check_positive(definition.inertia->z, where, "inertia.z", " kg·m²");
    }
    if (definition.kind == BodyKind::Rigid) {
        const auto [mass, inertia] = mass_properties(definition);
        check_range(mass, 1.0e-15f, 1.0e15f, where, "mass", " kg");
        check_range(inertia.x, 1.0e-24f, 1.0e24f, where, "inertia.x", " kg·m²");
        check_range(inertia.y, 1.0e-24f, 1.0e24f, where, "inertia.y", " kg·m²");
        check_range(inertia.z, 1.0e-24f, 1.0e24f, where, "inertia.z", " kg·m²");
    }
    if (definition.gravity_scale) check_finite(*definition.gravity_scale, where, "gravity_scale");
    check_range(definition.linear_damping, 0.0f, 1.0e6f, where, "linear_damping", " 1/s");
    check_range(definition.angular_damping, 0.0f, 1.0e6f, where, "angular_damping", " 1/s");
    check_material(definition.material, where);
}

void check_definitions(std::span<const BodyDefinition> definitions, unsigned threads) {
    const auto check = [&](std::size_t i) {
        const char* const words = definitions.size() == 1 ? "{0}" : "{0}: body {1} of the list";
        check_definition(definitions[i], {words, "add", i});
    };
    constexpr std::size_t k_checked_by_one = 4096;
    std::atomic<std::size_t> wrong = definitions.size(); // the first
    in_parts(definitions.size(), threads, k_checked_by_one, [&](std::size_t first, std::size_t end) {
        std::size_t i = first;
        try {
            for (; i < end && i < wrong; ++i)
                check(i);
        } catch (const Error&) {
            for (std::size_t before = wrong; i < before && !wrong.compare_exchange_weak(before, i);) {
            }
        }
    });
    if (wrong < definitions.size()) check(wrong);
}

void check_settings(const Settings& settings) {
    const Where where{"settings"};
    check_finite(settings.gravity, where, "gravity");
    check_range(settings.dt, 1.0e-6f, 1.0f, where, "dt", " s");
    check_range(static_cast<float>(settings.substeps), 1.0f, 1000.0f, where, "substeps", "");
    check_range(static_cast<float>(settings.max_substeps), 1.0f, 1000.0f, where, "max_substeps", "");
    check_range(static_cast<float>(settings.iterations), 1.0f, 10000.0f, where, "iterations", "");
    check_range(settings.contact_hertz, 1.0e-3f, 1.0e5f, where, "contact_hertz", " Hz");
    check_range(settings.contact_damping_ratio, 0.0f, 1.0e3f, where, "contact_damping_ratio", "");
    check_range(settings.contact_push_speed, 0.0f, 1.0e4f, where, "contact_push_speed", " m/s");
    check_range(settings.baumgarte, 0.0f, 1.0f, where, "baumgarte", "");
    check_range(settings.restitution_threshold, 0.0f, 1.0e4f, where, "restitution_threshold", " m/s");
    check_range(settings.max_linear_speed, 1.0e-3f, 1.0e5f, where, "max_linear_speed", " m/s");
    check_range(settings.max_angular_speed, 1.0e-3f, 1.0e5f, where, "max_angular_speed", " rad/s");
    check_range(settings.sleep_speed, 0.0f, 1.0e3f, where, "sleep_speed", " m/s");
    check_range(settings.sleep_time, 0.0f, 10.0f, where, "sleep_time", " s");
    if (settings.broad_phase > BroadPhase::Brute)
        refuse(where, "broad_phase is none of Auto, SweepAndPrune, Bvh and Brute");
    if (settings.solve_order > SolveOrder::Sequential) refuse(where, "solve_order is none of Coloured and Sequential");
    if (settings.stabilisation > Stabilisation::Baumgarte) refuse(where, "stabilisation is none of Soft and Baumgarte");
}

void check_watch(ContactWatch watch) {
    if (watch > ContactWatch::All) refuse({"watch_contacts"}, "the watch is none of None, Changes and All");
}

void check_options(const WorldOptions& options) {
    const Where where{"options"};
    if (options.device > DeviceKind::Hybrid) refuse(where, "device is none of Auto, Gpu, Cpu and Hybrid");
    if (options.gl_context > GlContext::Current) refuse(where, "gl_context is none of Own and Current");
    check_capacity(options.capacities.bodies, k_most_bodies, "bodies");
    check_capacity(options.capacities.pairs, k_most_pairs, "pairs");
    check_capacity(options.capacities.colours, k_max_colours, "colours");
}

} // namespace talus::engine
