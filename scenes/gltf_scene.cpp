// SPDX-License-Identifier: MIT
// From a glTF file to a scene. The rule: what would make the bodies move differently is refused with one error; what
// only is to be seen (meshes, materials, lights, cameras, skins) is passed over. Triggers become sensors. Those that
// cannot, push nothing, and animations move nothing here: each kind is left out with one warning.
#include "scenes/gltf_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scenes/camera.h"
#include "scenes/gltf_file.h"
#include "scenes/gltf_filters.h"
#include "scenes/gltf_physics.h"
#include "scenes/parameters.h"

namespace talus::scenes {

namespace {

/// A node's part in the physics.
struct Role {
    std::optional<JsonValue> collider, trigger, motion;
    std::size_t owner = k_no_node; ///< position of the node whose motion carries this one
};

/// What is left out with a warning: the names of the nodes that have it.
struct LeftOut {
    std::vector<std::string> unsupported_triggers, carried_triggers, trigger_filters, without_collider, turned_off,
        two_frictions;
};

std::vector<Role> read_roles(const std::vector<GltfNode>& nodes) {
    std::vector<Role> roles(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const GltfNode& node = nodes[i];
        Role& role = roles[i];
        if (node.parent != k_no_node) role.owner = roles[node.parent].owner;
        const auto physics = node.json.extension("KHR_physics_rigid_bodies");
        if (!physics) continue;
        if (physics->find("joint"))
            node.json.fail("is a joint; Talus has no joints, and the scene would fall apart without it");
        role.trigger = physics->find("trigger");
        role.collider = physics->find("collider");
        role.motion = physics->find("motion");
        if (role.motion) role.owner = i;
    }
    return roles;
}

/// The file's names where they are unique; a repeated one gets a number: "Cube (2)".
class UniqueNames {
public:
    std::string make(const std::string& name) {
        std::string result = name;
        for (int number = 2; !used.insert(result).second; ++number)
            result = name + " (" + std::to_string(number) + ")";
        return result;
    }

private:
    std::set<std::string> used;
};

/// One body: a static collider, or a motion and the one collider that it carries.
BodyDefinition make_body(const GltfCollider& collider, const GltfNode& node, const GltfMotion* motion) {
    BodyDefinition body;
    body.kind = motion ? motion->kind : BodyKind::Static;
    body.shape = collider.shape;
    body.material = collider.material;
    const glm::dvec3& position = collider.placement.position;
    const glm::dquat& rotation = collider.placement.rotation;
    body.pose.position = {static_cast<float>(position.x), static_cast<float>(position.y),
                          static_cast<float>(position.z)};
    body.pose.rotation = {static_cast<float>(rotation.x), static_cast<float>(rotation.y),
                          static_cast<float>(rotation.z), static_cast<float>(rotation.w)};
    if (!std::isfinite(glm::dot(position, position)) || !std::isfinite(body.pose.position.x) ||
        !std::isfinite(body.pose.position.y) || !std::isfinite(body.pose.position.z))
        node.json.fail("its position in the world is not finite");
    if (!motion) return body;

    if (motion->centre_of_mass) {
        const double offset = glm::distance(*motion->centre_of_mass, position);
        const glm::dvec3& scale = collider.placement.scale;
        if (!(offset <= 1e-4 * std::max({scale.x, scale.y, scale.z})))
            node.json.fail("its centre of mass (centerOfMass) is " + std::to_string(offset) +
                           " m from the middle of its shape; in Talus both are at one place");
    }
    body.velocity = motion->velocity;
    body.mass = motion->mass;
    body.gravity_scale = motion->gravity_scale;
    if (motion->inertia) body.inertia = principal_inertia(*motion->inertia, rotation, node);
    return body;
}

struct Region {
    glm::dvec3 lower{std::numeric_limits<double>::infinity()};
    glm::dvec3 upper{-std::numeric_limits<double>::infinity()};

    bool empty() const { return lower.x > upper.x; }
    double extent() const {
        const glm::dvec3 size = upper - lower;
        return std::max({size.x, size.y, size.z});
    }
    void add(const glm::dvec3& low, const glm::dvec3& high) {
        lower = glm::min(lower, low);
        upper = glm::max(upper, high);
    }
    void add(const BodyDefinition& body) {
        const Vec3& p = body.pose.position;
        const Quat& q = body.pose.rotation;
        glm::dvec3 half;
        if (const Sphere* sphere = std::get_if<Sphere>(&body.shape)) {
            half = glm::dvec3(sphere->radius);
        } else {
            const Vec3& size = std::get<Box>(body.shape).size;
            const glm::dmat3 axes = glm::mat3_cast(glm::dquat(q.w, q.x, q.y, q.z));
            half = 0.5 *
                   (glm::abs(axes[0]) * static_cast<double>(size.x) + glm::abs(axes[1]) * static_cast<double>(size.y) +
                    glm::abs(axes[2]) * static_cast<double>(size.z));
        }
        const glm::dvec3 centre(p.x, p.y, p.z);
        add(centre - half, centre + half);
    }
    Bounds bounds(const glm::dvec3& below, const glm::dvec3& above) const {
        const glm::dvec3 low = lower - below;
        const glm::dvec3 high = upper + above;
        return {{static_cast<float>(low.x), static_cast<float>(low.y), static_cast<float>(low.z)},
                {static_cast<float>(high.x), static_cast<float>(high.y), static_cast<float>(high.z)}};
    }
};

/// Bounds: files say nothing of their own, so only what has plainly left the scene counts as escaped. Camera: all
/// bodies, or only those that move where the ground is so large that they would be specks on it.
void look_at_bodies(Scene& scene) {
    constexpr double k_room = 50.0;        // m
    constexpr double k_large_ground = 3.0; // times the extent of what moves
    Region all, moving;
    for (const NamedBody& body : scene.bodies) {
        all.add(body.definition);
        if (body.definition.kind != BodyKind::Static) moving.add(body.definition);
    }
    const double sideways = k_room + all.extent();
    scene.bounds = all.bounds({sideways, k_room, sideways}, glm::dvec3(sideways));
    const bool specks = !moving.empty() && all.extent() > k_large_ground * moving.extent();
    const glm::dvec3 margin(specks ? 0.5 * moving.extent() : 0.0);
    scene.camera = frame((specks ? moving : all).bounds(margin, margin), {0.5f, 0.4f, 1.0f});
}

void warn(Scene& scene, const std::vector<std::string>& names, const char* singular, const char* plural,
          const char* consequence) {
    if (names.empty()) return;
    constexpr std::size_t k_most_names = 3;
    std::vector<std::string> shown(names.begin(),
                                   names.begin() + static_cast<std::ptrdiff_t>(std::min(names.size(), k_most_names)));
    if (names.size() > k_most_names) shown.push_back("and " + std::to_string(names.size() - k_most_names) + " more");
    scene.warnings.push_back(std::to_string(names.size()) + " " + (names.size() == 1 ? singular : plural) + " (" +
                             join(shown) + ") " + consequence);
}

/// Other ways to write physics into glTF, which are not read.
std::vector<std::string> other_physics_extensions(const JsonValue& document) {
    std::vector<std::string> result;
    const auto used = document.find("extensionsUsed");
    for (std::size_t i = 0; used && i < used->size(); ++i) {
        const std::string name = used->element(i).text();
        if (name.starts_with("OMI_physics") || name == "MSFT_rigid_bodies" || name == "MSFT_physics")
            result.push_back(name);
    }
    return result;
}

/// What belongs to one body: the colliders and triggers of a node without motion, or of all that its motion carries.
struct Volumes {
    std::vector<GltfCollider> colliders, triggers;
};

std::optional<GltfCollider> read_trigger(const JsonValue& json, const std::vector<GltfNode>& nodes, std::size_t node,
                                         const GltfTables& tables, LeftOut& left_out) {
    try {
        std::optional<GltfCollider> trigger = read_collider(json, nodes, node, tables);
        if (trigger && trigger->filter) left_out.trigger_filters.push_back(nodes[node].name);
        if (!trigger) left_out.turned_off.push_back(nodes[node].name);
        return trigger;
    } catch (const UnsupportedShape&) {
        left_out.unsupported_triggers.push_back(nodes[node].name);
        return std::nullopt;
    }
}

std::vector<Volumes> read_volumes(const std::vector<Role>& roles, const std::vector<GltfNode>& nodes,
                                  const GltfTables& tables, LeftOut& left_out) {
    std::vector<Volumes> volumes(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        Volumes& volume = volumes[roles[i].owner == k_no_node ? i : roles[i].owner];
        if (roles[i].collider) {
            std::optional<GltfCollider> collider = read_collider(*roles[i].collider, nodes, i, tables);
            if (!collider) left_out.turned_off.push_back(nodes[i].name);
            if (collider && collider->two_frictions) left_out.two_frictions.push_back(nodes[i].name);
            if (collider) volume.colliders.push_back(*std::move(collider));
        }
        // A compound trigger names nodes in the place of a geometry: those are triggers themselves.
        if (!roles[i].trigger || (roles[i].trigger->find("nodes") && !roles[i].trigger->find("geometry"))) continue;
        if (auto trigger = read_trigger(*roles[i].trigger, nodes, i, tables, left_out))
            volume.triggers.push_back(*std::move(trigger));
    }
    return volumes;
}

void read_bodies(Scene& scene, const std::vector<GltfNode>& nodes, const GltfTables& tables, LeftOut& left_out) {
    const std::vector<Role> roles = read_roles(nodes);
    const std::vector<Volumes> volumes = read_volumes(roles, nodes, tables, left_out);
    UniqueNames names;
    std::vector<FilteredBody> filtered;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto& [colliders, triggers] = volumes[i];
        if (colliders.size() > 1)
            nodes[i].json.fail("its motion carries " + std::to_string(colliders.size()) + " colliders ('" +
                               nodes[colliders[0].node].name + "', '" + nodes[colliders[1].node].name +
                               "'...); a body of Talus has one shape");
        std::optional<GltfMotion> motion;
        if (roles[i].motion) motion = read_motion(*roles[i].motion, nodes[i]);
        const GltfMotion* moved_by = motion ? &*motion : nullptr;
        if (motion && colliders.empty() && triggers.empty()) left_out.without_collider.push_back(nodes[i].name);
        if (!colliders.empty()) {
            const BodyDefinition body = make_body(colliders[0], nodes[i], moved_by);
            scene.bodies.push_back({names.make(nodes[i].name), body});
            filtered.push_back({colliders[0].filter, body.kind == BodyKind::Rigid, &nodes[i]});
        }
        const bool sole_shape = colliders.empty() && triggers.size() == 1;
        for (const GltfCollider& trigger : triggers) {
            if (motion && !sole_shape) {
                left_out.carried_triggers.push_back(nodes[trigger.node].name);
                continue;
            }
            BodyDefinition sensor = make_body(trigger, nodes[i], moved_by);
            sensor.sensor = true;
            scene.bodies.push_back({names.make(nodes[i].name), sensor});
        }
    }
    require_harmless_filters(filtered, tables.filters);
}

} // namespace

Scene read_gltf_scene(std::string_view path) {
    const std::string file(path);
    const nlohmann::json json = read_gltf_file(file);
    const JsonValue document(json, file);
    const std::vector<GltfNode> nodes = read_gltf_nodes(document, file);

    Scene scene;
    scene.name = file;
    LeftOut left_out;
    read_bodies(scene, nodes, GltfTables(document, file), left_out);

    const std::vector<std::string> others = other_physics_extensions(document);
    if (scene.bodies.empty())
        document.fail("has no body: no node of its scene has a collider or a trigger of KHR_physics_rigid_bodies" +
                      (others.empty() ? "" : "; it uses " + join(others) + ", which Talus does not read"));

    const auto animations = document.find("animations");
    if (animations && animations->size() > 0)
        scene.warnings.push_back(std::to_string(animations->size()) +
                                 (animations->size() == 1 ? " animation is" : " animations are") +
                                 " left out: only forces, contacts and velocities move bodies");
    if (!others.empty()) scene.warnings.push_back(join(others) + ": left out; only KHR_physics_rigid_bodies is read");
    warn(scene, left_out.unsupported_triggers, "trigger", "triggers", "left out: of another shape than box or sphere");
    warn(scene, left_out.carried_triggers, "trigger", "triggers",
         "left out: carried by a motion that has another shape; a body of Talus has one");
    warn(scene, left_out.trigger_filters, "trigger", "triggers",
         "with a collision filter, which is left out: it reports all bodies");
    warn(scene, left_out.without_collider, "motion", "motions", "left out: no collider, so nothing can touch it");
    warn(scene, left_out.turned_off, "shape", "shapes", "left out: a scale of 0 turns it off");
    warn(scene, left_out.two_frictions, "collider", "colliders",
         "with a static friction that differs from the dynamic one: the dynamic one is used for both");
    look_at_bodies(scene);
    return scene;
}

} // namespace talus::scenes
