// SPDX-License-Identifier: MIT
// Draws from the public results alone, so that it serves as an example too.
#include <talus/debug_draw.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>

#include "body_table.h"
#include "state/formulas.h"

namespace talus {

DebugDraw::~DebugDraw() = default;

namespace {

using engine::from_glm;
using engine::to_glm;
using glm::vec3;

constexpr Colour k_static{0.5f, 0.5f, 0.5f, 1.0f};
constexpr Colour k_rigid{0.9f, 0.9f, 0.9f, 1.0f};
constexpr Colour k_kinematic{0.3f, 0.6f, 1.0f, 1.0f};
constexpr Colour k_sensor{0.3f, 0.9f, 0.4f, 1.0f};
constexpr Colour k_aabb{0.9f, 0.8f, 0.2f, 1.0f};
constexpr Colour k_pair{1.0f, 0.1f, 0.1f, 1.0f};
constexpr Colour k_contact{1.0f, 0.4f, 0.7f, 1.0f};
constexpr Colour k_impulse{1.0f, 0.6f, 0.1f, 1.0f};
constexpr Colour k_velocity{0.2f, 0.8f, 0.9f, 1.0f};
constexpr float k_point_size = 6.0f; // pixels
constexpr int k_circle_segments = 24;

Colour colour_of(const World& world, BodyId body) {
    if (world.is_sensor(body)) return k_sensor;
    switch (world.kind(body)) {
    case BodyKind::Static:
        return k_static;
    case BodyKind::Kinematic:
        return k_kinematic;
    case BodyKind::Rigid:
        break;
    }
    return k_rigid;
}

/// A box, given by its centre and the three vectors from there to the middles of its sides.
void draw_box(DebugDraw& draw, vec3 centre, const std::array<vec3, 3>& half, const Colour& colour) {
    const auto corner = [&](unsigned bits) {
        vec3 result = centre;
        for (unsigned axis = 0; axis < 3; ++axis)
            result += (bits >> axis & 1u) != 0 ? half[axis] : -half[axis];
        return from_glm(result);
    };
    for (unsigned bits = 0; bits < 8; ++bits)
        for (unsigned axis = 0; axis < 3; ++axis)
            if ((bits >> axis & 1u) == 0) draw.line(corner(bits), corner(bits | 1u << axis), colour);
}

void draw_circle(DebugDraw& draw, vec3 centre, vec3 x, vec3 y, const Colour& colour) {
    const auto at = [&](int segment) {
        const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(segment) / k_circle_segments;
        return from_glm(centre + x * std::cos(angle) + y * std::sin(angle));
    };
    for (int i = 0; i < k_circle_segments; ++i)
        draw.line(at(i), at(i + 1), colour);
}

struct Placed {
    vec3 centre;
    std::array<vec3, 3> axes; // unit
};

Placed placed(const Pose& pose) {
    const engine::Axes axes = engine::rotation_axes(to_glm(pose.rotation));
    return {to_glm(pose.position), {axes.x, axes.y, axes.z}};
}

void draw_shape(DebugDraw& draw, const Placed& body, const Shape& shape, const Colour& colour) {
    if (const auto* box = std::get_if<Box>(&shape)) {
        const vec3 half = 0.5f * to_glm(box->size);
        draw_box(draw, body.centre, {body.axes[0] * half.x, body.axes[1] * half.y, body.axes[2] * half.z}, colour);
        return;
    }
    const float radius = std::get<Sphere>(shape).radius;
    for (unsigned i = 0; i < 3; ++i)
        draw_circle(draw, body.centre, radius * body.axes[i], radius * body.axes[(i + 1) % 3], colour);
}

void draw_aabb(DebugDraw& draw, const Placed& body, const Shape& shape) {
    vec3 extent(0.0f);
    if (const auto* box = std::get_if<Box>(&shape)) {
        const vec3 half = 0.5f * to_glm(box->size);
        extent = glm::abs(body.axes[0]) * half.x + glm::abs(body.axes[1]) * half.y + glm::abs(body.axes[2]) * half.z;
    } else {
        extent = vec3(std::get<Sphere>(shape).radius);
    }
    draw_box(draw, body.centre, {vec3(extent.x, 0, 0), vec3(0, extent.y, 0), vec3(0, 0, extent.z)}, k_aabb);
}

void draw_contacts(const World& world, DebugDraw& draw, const DebugDrawOptions& options) {
    for (const Contact& contact : world.contacts()) {
        const vec3 normal = to_glm(contact.normal);
        for (const ContactPoint& point : contact.points) {
            const vec3 position = to_glm(point.position);
            if (options.contacts) {
                draw.point(point.position, k_point_size, k_contact);
                draw.line(point.position, from_glm(position + options.normal_length * normal), k_contact);
            }
            if (options.impulses && point.normal_impulse > 0.0f)
                draw.line(point.position, from_glm(position + options.impulse_scale * point.normal_impulse * normal),
                          k_impulse);
        }
    }
}

} // namespace

void draw_debug(const World& world, DebugDraw& draw, const DebugDrawOptions& options) {
    const std::vector<BodyId> bodies = world.bodies();
    const std::vector<Pose> poses = world.poses();
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const BodyId id = bodies[i];
        const Placed body = placed(poses[i]);
        if (options.shapes) draw_shape(draw, body, world.shape(id), colour_of(world, id));
        if (options.aabbs) draw_aabb(draw, body, world.shape(id));
        if (options.indices) draw.text(poses[i].position, std::to_string(id.index), colour_of(world, id));
        if (options.velocities && world.kind(id) != BodyKind::Static) {
            const vec3 way = options.velocity_scale * to_glm(world.velocity(id).linear);
            draw.line(poses[i].position, from_glm(body.centre + way), k_velocity);
        }
    }
    if (options.pairs)
        for (const CollisionPair& pair : world.collision_pairs())
            draw.line(world.pose(pair.a).position, world.pose(pair.b).position, k_pair);
    if (options.contacts || options.impulses) draw_contacts(world, draw, options);
}

} // namespace talus
