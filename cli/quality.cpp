// SPDX-License-Identifier: MIT
// Sums in double precision over all bodies, and the overlap of every two that may touch.
#include "quality.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "candidate_pairs.h"
#include "overlap.h"

namespace talus::cli {
namespace {

glm::dvec3 wide(const Vec3& v) {
    return {v.x, v.y, v.z};
}

bool is_finite(const Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool is_finite(const BodySample& body) {
    const Quat& q = body.pose.rotation;
    return is_finite(body.pose.position) && std::isfinite(q.x) && std::isfinite(q.y) && std::isfinite(q.z) &&
           std::isfinite(q.w) && is_finite(body.velocity.linear) && is_finite(body.velocity.angular);
}

bool is_inside(const Vec3& p, const scenes::Bounds& bounds) {
    return p.x >= bounds.lower.x && p.x <= bounds.upper.x && p.y >= bounds.lower.y && p.y <= bounds.upper.y &&
           p.z >= bounds.lower.z && p.z <= bounds.upper.z;
}

Region region_of(const PlacedShape& shape) {
    glm::dvec3 reach = shape.half;
    if (!shape.sphere) {
        reach = glm::abs(shape.axes[0]) * shape.half.x + glm::abs(shape.axes[1]) * shape.half.y +
                glm::abs(shape.axes[2]) * shape.half.z;
    }
    return {shape.centre - reach, shape.centre + reach};
}

void measure_penetration(std::span<const BodySample> bodies, Quality& quality) {
    std::vector<PlacedShape> shapes;
    std::vector<Region> regions;
    std::vector<bool> dynamic;
    for (const BodySample& body : bodies) {
        if (!is_finite(body) || body.sensor) continue;
        shapes.push_back(place(body.shape, body.pose));
        regions.push_back(region_of(shapes.back()));
        dynamic.push_back(body.kind == BodyKind::Rigid);
    }
    double sum = 0.0;
    for_each_overlap(regions, [&](std::uint32_t a, std::uint32_t b) {
        if (!dynamic[a] && !dynamic[b]) return;
        const double depth = penetration_depth(shapes[a], shapes[b]);
        if (depth <= 0.0) return;
        ++quality.overlapping_pairs;
        sum += depth;
        quality.max_penetration = std::max(quality.max_penetration, depth);
    });
    if (quality.overlapping_pairs > 0) quality.mean_penetration = sum / static_cast<double>(quality.overlapping_pairs);
}

} // namespace

std::vector<BodySample> sample_bodies(const World& world) {
    const std::vector<BodyId> ids = world.bodies();
    const std::vector<Pose> poses = world.poses();
    const std::vector<Velocity> velocities = world.velocities();
    std::vector<BodySample> samples;
    samples.reserve(ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i)
        samples.push_back({world.kind(ids[i]), world.shape(ids[i]), poses[i], velocities[i], world.mass(ids[i]),
                           world.inertia(ids[i]), world.is_sensor(ids[i])});
    return samples;
}

Quality measure_quality(std::span<const BodySample> bodies, std::span<const Vec3> starts,
                        const scenes::Bounds& bounds) {
    if (bodies.size() != starts.size()) throw Error("a start is needed for each body, no more and no fewer");
    Quality quality;
    glm::dvec3 linear_momentum(0.0), angular_momentum(0.0);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const BodySample& body = bodies[i];
        if (!is_finite(body)) {
            ++quality.nonfinite_bodies;
            continue;
        }
        if (body.kind != BodyKind::Rigid) continue;

        const glm::dvec3 position = wide(body.pose.position);
        const glm::dvec3 drift = position - wide(starts[i]);
        quality.max_drift = std::max(quality.max_drift, glm::length(drift));
        quality.max_drift_sideways = std::max(quality.max_drift_sideways, std::hypot(drift.x, drift.z));
        if (!is_inside(body.pose.position, bounds)) ++quality.escaped_bodies;

        const glm::dvec3 velocity = wide(body.velocity.linear);
        const glm::dmat3 axes = place(body.shape, body.pose).axes;
        const glm::dvec3 spin = glm::transpose(axes) * wide(body.velocity.angular); // about the body's own axes
        const glm::dvec3 spin_momentum = wide(body.inertia) * spin;
        const double mass = body.mass;
        quality.max_speed = std::max(quality.max_speed, glm::length(velocity));
        quality.kinetic_energy += 0.5 * mass * glm::dot(velocity, velocity) + 0.5 * glm::dot(spin, spin_momentum);
        linear_momentum += mass * velocity;
        angular_momentum += glm::cross(position, mass * velocity) + axes * spin_momentum;
    }
    quality.linear_momentum = {linear_momentum.x, linear_momentum.y, linear_momentum.z};
    quality.angular_momentum = {angular_momentum.x, angular_momentum.y, angular_momentum.z};
    measure_penetration(bodies, quality);
    return quality;
}

} // namespace talus::cli
