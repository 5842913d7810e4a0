// SPDX-License-Identifier: MIT
// The parts of KHR_physics_rigid_bodies that stand at one node, read and checked: colliders with their shape and
// material, triggers, which are colliders without a material, and motions.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <talus/types.h>

#include "scenes/gltf_nodes.h"

namespace talus::scenes {

/// The file's tables that nodes refer to. Entries are checked when a node refers to them.
struct GltfTables {
    std::optional<JsonValue> shapes, materials, filters;
    std::string file;

    /// Shapes stand in the extension KHR_implicit_shapes or, as drafts of glTF 2.1 have it, in the document itself.
    GltfTables(const JsonValue& document, std::string file);
};

/// Of a shape that Talus does not have.
class UnsupportedShape : public Error {
public:
    using Error::Error;
};

struct GltfCollider {
    std::size_t node = 0; ///< position in the list of nodes
    Placement placement;
    Shape shape;
    Material material;
    bool two_frictions = false; ///< static and dynamic friction differ
    std::optional<std::size_t> filter;
};

struct GltfMotion {
    BodyKind kind = BodyKind::Rigid;
    std::optional<float> mass;
    std::optional<float> gravity_scale;
    Velocity velocity;                        ///< in world axes
    std::optional<glm::dvec3> centre_of_mass; ///< in world space
    std::optional<glm::dmat3> inertia;        ///< in world axes, about the centre of mass
};

/// Also of a trigger. Empty for a collider which its node's scale of zero turns off. Throws UnsupportedShape for a
/// shape that Talus does not have.
std::optional<GltfCollider> read_collider(const JsonValue& collider, const std::vector<GltfNode>&, std::size_t node,
                                          const GltfTables&);

/// Throws Error for what no body of Talus can be: a finite mass with an infinite inertia, or the other way round.
GltfMotion read_motion(const JsonValue& motion, const GltfNode&);

/// The inertia about the axes of a body with this rotation; throws Error, at `node`, if those are not principal axes.
Vec3 principal_inertia(const glm::dmat3& world_inertia, const glm::dquat& rotation, const GltfNode& node);

} // namespace talus::scenes
