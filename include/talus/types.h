// SPDX-License-Identifier: MIT
// The values that pass between a program and Talus. SI units: metres, kilograms, seconds, radians. y is up,
// frames are right-handed.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include <talus/export.h>

namespace talus {

/// A vector or a point; what it measures, and in which frame, stands where it is used.
struct Vec3 {
    float x = 0.0f; ///< to the right
    float y = 0.0f; ///< up
    float z = 0.0f; ///< towards who looks
    /// Bit for bit, but for the sign of zero.
    friend bool operator==(const Vec3&, const Vec3&) = default;
};

/// A rotation as a unit quaternion; the identity unless said otherwise.
struct Quat {
    float x = 0.0f; ///< of the axis times the sine of half the angle
    float y = 0.0f; ///< of the same
    float z = 0.0f; ///< of the same
    float w = 1.0f; ///< the cosine of half the angle
    /// Bit for bit, but for the sign of zero: q and −q are different.
    friend bool operator==(const Quat&, const Quat&) = default;
};

/// Where a body is: its centre of mass (m) and the rotation from body axes to world axes.
struct Pose {
    Vec3 position; ///< m, world space
    Quat rotation; ///< body axes to world axes
    /// Bit for bit, but for the sign of zero.
    friend bool operator==(const Pose&, const Pose&) = default;
};

/// How a body moves, in world axes: linear in m/s, angular in rad/s.
struct Velocity {
    Vec3 linear;  ///< m/s, of the centre of mass
    Vec3 angular; ///< rad/s
    /// Bit for bit, but for the sign of zero.
    friend bool operator==(const Velocity&, const Velocity&) = default;
};

/// What moves a body, and what pushes it.
enum class BodyKind : std::uint32_t {
    Static,    ///< never moves; infinite mass
    Rigid,     ///< moved by forces and contacts; finite mass
    Kinematic, ///< moved by its own velocity (and gravity, if asked for) alone; contacts see an infinite mass
};

/// A box by its edge lengths along the body's axes (m).
struct Box {
    Vec3 size{1.0f, 1.0f, 1.0f}; ///< m
};

/// A sphere about the body's centre of mass.
struct Sphere {
    float radius = 0.5f; ///< m
};

/// What a body looks like to others.
using Shape = std::variant<Box, Sphere>;

/// How the values of two touching bodies become the contact's one. Where the two bodies ask for different rules,
/// the one listed first wins.
enum class Combine : std::uint32_t {
    Average,  ///< half the sum
    Minimum,  ///< the smaller one
    Maximum,  ///< the larger one
    Multiply, ///< the product
};

/// How a body's surface behaves in contacts.
struct Material {
    float friction = 0.5f;                          ///< Coulomb's coefficient, 0 or more
    float restitution = 0.0f;                       ///< 0: does not bounce; 1: leaves with the speed that it came with
    Combine friction_combine = Combine::Average;    ///< with the other body's friction
    Combine restitution_combine = Combine::Maximum; ///< with the other body's restitution
};

/// What `World::add` needs to know of a body.
struct BodyDefinition {
    BodyKind kind = BodyKind::Rigid;    ///< what moves it
    Shape shape = Box{};                ///< about the centre of mass
    Pose pose;                          ///< where it is
    Velocity velocity;                  ///< how it moves; none for a static body
    float density = 1000.0f;            ///< kg/m³; used where `mass` is not given
    std::optional<float> mass;          ///< kg
    std::optional<Vec3> inertia;        ///< principal moments about the body's axes, kg·m²; from the shape by default
    std::optional<float> gravity_scale; ///< factor on the world's gravity; default 1, for a kinematic body 0
    float linear_damping = 0.0f;        ///< 1/s: velocity decays as exp(−damping · t)
    float angular_damping = 0.0f;       ///< 1/s
    Material material;                  ///< its surface
    bool sensor = false;                ///< reports what it touches, and neither pushes nor is pushed by it
};

/// Names a body of one world. Stays invalid for ever once the body is removed, also when its index is used again.
struct BodyId {
    std::uint32_t index = UINT32_MAX; ///< its slot in the buffers; used again once the body is removed
    std::uint32_t generation = 0;     ///< how many bodies had the slot before
    /// Whether both name the same body, if they are of the same world.
    friend bool operator==(const BodyId&, const BodyId&) = default;
};

/// Two bodies whose boxes may touch: the broad phase's result (the thesis's CollisionPair).
struct CollisionPair {
    BodyId a; ///< has the lower index
    BodyId b; ///< the other one
};

/// One touching point between two bodies, as the last step solved it.
struct ContactPoint {
    Vec3 position;               ///< world space, midway between the two surfaces as the step began (m)
    float separation = 0.0f;     ///< m; negative where the bodies overlap
    float normal_impulse = 0.0f; ///< N·s, the sum over the step, impacts included
};

/// All that happens between two touching bodies: up to four points that share a normal (the thesis's ContactManifold).
struct Contact {
    BodyId a;                         ///< has the lower index
    BodyId b;                         ///< the other one
    Vec3 normal;                      ///< unit, world space, from a to b
    bool sensor = false;              ///< one of the two is a sensor: there are no impulses
    std::vector<ContactPoint> points; ///< one to four
    std::uint32_t colour = 0; ///< batch of the constraint graph that solved it; 64: the overflow set, one at a time
};

/// What has become of a contact in a step.
enum class ContactPhase : std::uint32_t {
    Begin,   ///< the two touch, and did not in the step before
    Persist, ///< they still touch
    End,     ///< they touched in the step before, and do so no longer; also where one of them was removed
};

/// What one step has to say of two bodies that touch, or have just touched. Two bodies touch where a point of their
/// contact carries load in the step, or where they overlap as it begins; once they touch, a gap of less than 5 mm does
/// not end it. Of a sensor, which carries no load, only the overlap counts.
struct ContactEvent {
    std::uint64_t step = 0;                   ///< as World::step_count() counts: 1 is the world's first step
    ContactPhase phase = ContactPhase::Begin; ///< what has become of it
    BodyId a;                                 ///< has the lower index; may have been removed since
    BodyId b;                                 ///< the other one; may have been removed since
    bool sensor = false;                      ///< one of the two is a sensor
    Vec3 normal;                              ///< unit, world space, from a to b; at an end as it was last
    std::vector<ContactPoint> points;         ///< none at an end
};

/// Every error that Talus reports: what was wrong, where, and what is allowed. The world is as it was before the call.
class TALUS_API Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

} // namespace talus

/// @cond
template <> struct std::hash<talus::BodyId> {
    std::size_t operator()(const talus::BodyId& id) const noexcept {
        return std::hash<std::uint64_t>{}((std::uint64_t{id.generation} << 32) | id.index);
    }
};
/// @endcond
