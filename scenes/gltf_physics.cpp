// SPDX-License-Identifier: MIT
// Reads colliders, triggers, materials and motions. Defaults are those of the extensions' schemas.
#include "scenes/gltf_physics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace talus::scenes {

namespace {

constexpr const char* k_supported = "; Talus has boxes and spheres";

JsonValue entry(const std::optional<JsonValue>& table, const JsonValue& reference, const GltfTables& tables,
                const char* noun, const char* plural) {
    const std::size_t index = reference.index(table ? table->size() : 0, plural);
    return table->named_element(index, tables.file, noun);
}

/// A length in the world as a float, refused where it is none.
float length(double value, const JsonValue& place, const char* what) {
    const auto result = static_cast<float>(value);
    if (!std::isfinite(result) || result < std::numeric_limits<float>::min())
        place.fail(std::string(what) + " must be positive and finite, not " + std::to_string(value) + " m");
    return result;
}

Shape read_shape(const JsonValue& shape, const Placement& placement, const JsonValue& collider) {
    const std::string type = shape.member("type").text();
    const std::optional<JsonValue> values = shape.find(type.c_str());
    if (type == "box") {
        const auto size = values ? values->find("size") : std::nullopt;
        const auto edges = size ? size->numbers<3>() : std::array{1.0, 1.0, 1.0};
        return Box{{length(edges[0] * placement.scale.x, shape, "the box's size along x"),
                    length(edges[1] * placement.scale.y, shape, "the box's size along y"),
                    length(edges[2] * placement.scale.z, shape, "the box's size along z")}};
    }
    if (type == "sphere") {
        const auto radius = values ? values->find("radius") : std::nullopt;
        const auto [least, greatest] = std::minmax({placement.scale.x, placement.scale.y, placement.scale.z});
        if (greatest - least > 1e-4 * greatest)
            throw UnsupportedShape(
                collider.at("its sphere is scaled by different factors along its axes, which makes it an ellipsoid" +
                            std::string(k_supported)));
        return Sphere{length((radius ? radius->number() : 0.5) * placement.scale.x, shape, "the sphere's radius")};
    }
    throw UnsupportedShape(collider.at("its shape is a " + type + k_supported));
}

Shape read_geometry(const JsonValue& collider, const Placement& placement, const GltfTables& tables) {
    const JsonValue geometry = collider.member("geometry");
    const auto shape = geometry.find("shape");
    for (const char* key : {"node", "mesh"}) {
        if (!geometry.find(key)) continue;
        if (shape) geometry.fail(std::string("names both a shape and a ") + key);
        const auto hull = geometry.find("convexHull");
        throw UnsupportedShape(collider.at(std::string("its shape is ") +
                                           (hull && hull->boolean() ? "the convex hull of a mesh" : "a mesh") +
                                           k_supported));
    }
    if (!shape) geometry.fail("names no shape");
    return read_shape(entry(tables.shapes, *shape, tables, "shape", "shapes"), placement, collider);
}

Combine read_combine(const JsonValue& material, const char* key) {
    const auto json = material.find(key);
    if (!json) return Combine::Average;
    const std::string rule = json->text();
    if (rule == "average") return Combine::Average;
    if (rule == "minimum") return Combine::Minimum;
    if (rule == "maximum") return Combine::Maximum;
    if (rule == "multiply") return Combine::Multiply;
    json->fail("must be average, minimum, maximum or multiply, not '" + rule + "'");
}

float read_factor(const JsonValue& material, const char* key, float default_value, float maximum) {
    const auto json = material.find(key);
    if (!json) return default_value;
    const auto value = static_cast<float>(json->number());
    if (value < 0.0f) json->fail("must not be negative");
    if (value > maximum) json->fail("must be from 0 to 1");
    return value;
}

void read_material(const JsonValue& json, GltfCollider& collider) {
    constexpr float k_no_maximum = std::numeric_limits<float>::max();
    collider.material.friction = read_factor(json, "dynamicFriction", 0.6f, k_no_maximum);
    collider.two_frictions = read_factor(json, "staticFriction", 0.6f, k_no_maximum) != collider.material.friction;
    collider.material.restitution = read_factor(json, "restitution", 0.0f, 1.0f);
    collider.material.friction_combine = read_combine(json, "frictionCombine");
    collider.material.restitution_combine = read_combine(json, "restitutionCombine");
}

/// A node's axes in the world, unit length; left-handed below a mirroring scale.
glm::dmat3 unit_axes(const Placement& placement) {
    glm::dmat3 axes = glm::mat3_cast(placement.rotation);
    if (placement.mirrored) axes[2] = -axes[2];
    return axes;
}

glm::dvec3 read_vector(const JsonValue& object, const char* key) {
    const auto json = object.find(key);
    if (!json) return glm::dvec3(0.0);
    const auto [x, y, z] = json->numbers<3>();
    return {x, y, z};
}

Vec3 to_vec3(const glm::dvec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Empty where the file gives none, or gives zeros: infinite.
std::optional<glm::dmat3> read_inertia(const JsonValue& motion, const glm::dmat3& axes, double& largest) {
    const auto json = motion.find("inertiaDiagonal");
    largest = -1.0;
    if (!json) return std::nullopt;
    const auto diagonal = json->numbers<3>();
    const auto [least, greatest] = std::minmax({diagonal[0], diagonal[1], diagonal[2]});
    if (least < 0.0) json->fail("must not be negative");
    largest = greatest;
    if (greatest == 0.0) return std::nullopt;
    if (static_cast<float>(least) < std::numeric_limits<float>::min())
        json->fail("is infinite (0) about some axes only, which a body of Talus cannot be");

    glm::dmat3 orientation(1.0);
    if (const auto rotation = motion.find("inertiaOrientation")) {
        const auto [x, y, z, w] = rotation->numbers<4>();
        const glm::dquat quaternion(w, x, y, z);
        if (std::abs(glm::length(quaternion) - 1.0) > 0.01) rotation->fail("is not a unit quaternion");
        orientation = glm::mat3_cast(glm::normalize(quaternion));
    }
    const glm::dmat3 principal = axes * orientation;
    glm::dmat3 scaled = principal;
    for (int i = 0; i < 3; ++i)
        scaled[i] *= diagonal[static_cast<std::size_t>(i)];
    return scaled * glm::transpose(principal);
}

} // namespace

GltfTables::GltfTables(const JsonValue& document, std::string file_name) : file(std::move(file_name)) {
    if (const auto implicit = document.extension("KHR_implicit_shapes")) shapes = implicit->find("shapes");
    if (!shapes) shapes = document.find("shapes");
    if (const auto physics = document.extension("KHR_physics_rigid_bodies")) {
        materials = physics->find("physicsMaterials");
        filters = physics->find("collisionFilters");
    }
}

std::optional<GltfCollider> read_collider(const JsonValue& json, const std::vector<GltfNode>& nodes, std::size_t node,
                                          const GltfTables& tables) {
    GltfCollider collider;
    collider.node = node;
    collider.placement = take_apart(nodes[node]);
    if (collider.placement.scale == glm::dvec3(0.0)) return std::nullopt;
    collider.shape = read_geometry(json, collider.placement, tables);
    if (const auto material = json.find("physicsMaterial"))
        read_material(entry(tables.materials, *material, tables, "physics material", "physics materials"), collider);
    if (const auto filter = json.find("collisionFilter"))
        collider.filter = filter->index(tables.filters ? tables.filters->size() : 0, "collision filters");
    return collider;
}

GltfMotion read_motion(const JsonValue& motion, const GltfNode& node) {
    GltfMotion result;
    const Placement placement = take_apart(node);
    const glm::dmat3 axes = unit_axes(placement);

    // Node space gives the direction, m/s and rad/s the size: a velocity is turned with its node but not scaled. Spin
    // is an axial vector, so it changes its sign in a mirror.
    const double handedness = placement.mirrored ? -1.0 : 1.0;
    result.velocity.linear = to_vec3(axes * read_vector(motion, "linearVelocity"));
    result.velocity.angular = to_vec3(handedness * (axes * read_vector(motion, "angularVelocity")));
    if (motion.find("centerOfMass"))
        result.centre_of_mass = glm::dvec3(node.world * glm::dvec4(read_vector(motion, "centerOfMass"), 1.0));

    const auto gravity_factor = motion.find("gravityFactor");
    const float gravity_scale = gravity_factor ? static_cast<float>(gravity_factor->number()) : 1.0f;
    const auto mass_json = motion.find("mass");
    const double mass = mass_json ? mass_json->number() : 1.0;
    if (mass < 0.0) mass_json->fail("must not be negative");
    double largest_inertia = 0.0;
    result.inertia = read_inertia(motion, axes, largest_inertia);

    const auto kinematic = motion.find("isKinematic");
    if (kinematic && kinematic->boolean()) {
        // Its velocity stays what it is, whatever the gravity factor.
        result.kind = BodyKind::Kinematic;
        result.inertia.reset();
        return result;
    }
    result.gravity_scale = gravity_scale;
    if (mass == 0.0) {
        if (result.inertia)
            motion.fail("has an infinite mass (0) but a finite inertia, which a body of Talus cannot be; leave "
                        "inertiaDiagonal out, or give a mass");
        result.kind = BodyKind::Kinematic;
        return result;
    }
    if (largest_inertia == 0.0)
        motion.fail("has an infinite inertia (0) but a finite mass, which a body of Talus cannot be; leave "
                    "inertiaDiagonal out, or give one that is positive");
    if (mass_json) {
        result.mass = static_cast<float>(mass);
        if (*result.mass < std::numeric_limits<float>::min()) mass_json->fail("is too small");
    }
    return result;
}

Vec3 principal_inertia(const glm::dmat3& world_inertia, const glm::dquat& rotation, const GltfNode& node) {
    const glm::dmat3 axes = glm::mat3_cast(rotation);
    const glm::dmat3 local = glm::transpose(axes) * world_inertia * axes;
    const double largest = std::max({local[0][0], local[1][1], local[2][2]});
    const double mixed = std::max({std::abs(local[0][1]), std::abs(local[0][2]), std::abs(local[1][2])});
    if (mixed > 1e-4 * largest)
        node.json.fail("its inertia's principal axes (inertiaOrientation) are not the axes of its shape, which a body "
                       "of Talus needs");
    return to_vec3({local[0][0], local[1][1], local[2][2]});
}

} // namespace talus::scenes
