// SPDX-License-Identifier: MIT
// The spring is critically damped and as stiff for a heavy body as for a light one: its force is the effective mass at
// the grip, a matrix, times an acceleration. So it is stable whatever the body's shape and wherever it is held, as long
// as the spring's own time is long against the step.
#include "viewer/hand.h"

#include <algorithm>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>

namespace talus::viewer {

namespace {

constexpr float k_frequency = 15.0f;      // rad/s, at a step of 1/60 s or less
constexpr float k_angular_damping = 2.0f; // 1/s: what hangs from one point comes to rest
constexpr float k_largest_pull = 500.0f;  // m/s², times the body's mass: what is stuck is not torn through walls

glm::vec3 to_glm(Vec3 v) {
    return {v.x, v.y, v.z};
}
Vec3 from_glm(glm::vec3 v) {
    return {v.x, v.y, v.z};
}
glm::quat to_glm(Quat q) {
    return {q.w, q.x, q.y, q.z};
}

glm::mat3 cross_matrix(glm::vec3 r) {
    return {0.0f, r.z, -r.y, -r.z, 0.0f, r.x, r.y, -r.x, 0.0f};
}

} // namespace

void Hand::hold(const World& world, const Hit& hit) {
    if (world.kind(hit.body) != BodyKind::Rigid) return;
    const Pose pose = world.pose(hit.body);
    grip = Grip{hit.body, glm::conjugate(to_glm(pose.rotation)) * (hit.point - to_glm(pose.position)), hit.point};
}

void Hand::pull_to(glm::vec3 target) {
    if (grip) grip->target = target;
}

std::optional<std::pair<glm::vec3, glm::vec3>> Hand::pull(const World& world) const {
    if (!grip || !world.contains(grip->body)) return {};
    const Pose pose = world.pose(grip->body);
    return std::pair(to_glm(pose.position) + to_glm(pose.rotation) * grip->point, grip->target);
}

bool Hand::apply(World& world) {
    if (!grip) return false;
    if (!world.contains(grip->body)) {
        grip.reset();
        return false;
    }
    const Pose pose = world.pose(grip->body);
    const Velocity velocity = world.velocity(grip->body);
    const float mass = world.mass(grip->body);
    const glm::mat3 axes = glm::mat3_cast(to_glm(pose.rotation));
    const glm::vec3 moments = to_glm(world.inertia(grip->body));
    const glm::mat3 inertia =
        axes * glm::mat3(moments.x, 0, 0, 0, moments.y, 0, 0, 0, moments.z) * glm::transpose(axes);
    const glm::vec3 arm = axes * grip->point;
    const glm::vec3 point = to_glm(pose.position) + arm;
    const glm::vec3 spin = to_glm(velocity.angular);
    const glm::vec3 point_velocity = to_glm(velocity.linear) + glm::cross(spin, arm);

    // What a unit of impulse at the point changes of its velocity: 1/m − [r] I⁻¹ [r].
    const glm::mat3 r = cross_matrix(arm);
    const glm::mat3 mobility = glm::mat3(1.0f / mass) - r * glm::inverse(inertia) * r;
    const float frequency = std::min(k_frequency, 0.25f / world.settings().dt);
    const glm::vec3 acceleration = frequency * frequency * (grip->target - point) - 2.0f * frequency * point_velocity;
    glm::vec3 force = glm::inverse(mobility) * acceleration;
    const float strength = glm::length(force);
    if (strength > k_largest_pull * mass) force *= k_largest_pull * mass / strength;
    force -= world.gravity_scale(grip->body) * mass * to_glm(world.settings().gravity); // what is held weighs nothing
    world.add_force(grip->body, from_glm(force), from_glm(point));
    // Of its swinging about the grip.
    const glm::mat3 swing_inertia = inertia - mass * r * r;
    world.add_torque(grip->body, from_glm(-k_angular_damping * (swing_inertia * spin)));
    return true;
}

BodyDefinition ball_along(const Ray& ray, const Projectile& wanted) {
    BodyDefinition ball;
    ball.shape = Sphere{0.5f * wanted.size};
    ball.density = wanted.density;
    ball.pose.position = from_glm(ray.origin + wanted.size * ray.direction);
    ball.velocity.linear = from_glm(wanted.speed * ray.direction);
    return ball;
}

BodyDefinition box_above(glm::vec3 place, const Projectile& wanted) {
    BodyDefinition box;
    box.shape = Box{{wanted.size, wanted.size, wanted.size}};
    box.density = wanted.density;
    box.pose.position = from_glm(place + glm::vec3(0.0f, 3.0f * wanted.size, 0.0f));
    return box;
}

std::optional<BodyId> find_kinematic(const World& world) {
    for (const BodyId id : world.bodies())
        if (world.kind(id) == BodyKind::Kinematic) return id;
    return {};
}

BodyDefinition platform_at(glm::vec3 place, float size) {
    BodyDefinition platform;
    platform.kind = BodyKind::Kinematic;
    platform.shape = Box{{3.0f * size, 0.5f * size, 3.0f * size}};
    platform.pose.position = from_glm(place);
    return platform;
}

} // namespace talus::viewer
