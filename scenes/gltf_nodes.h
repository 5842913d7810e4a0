// SPDX-License-Identifier: MIT
// The node tree of a glTF file: each node of the scene with its place in the world.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "scenes/gltf_json.h"

namespace talus::scenes {

inline constexpr std::size_t k_no_node = static_cast<std::size_t>(-1);

struct GltfNode {
    JsonValue json;
    std::size_t index = 0;          ///< in the file's array of nodes
    std::string name;               ///< "node 3" where the file gives none
    glm::dmat4 world{1.0};          ///< node space to world space
    std::size_t parent = k_no_node; ///< position in the list that it is part of
};

/// A transform taken apart: scale first, then rotation, then translation.
struct Placement {
    glm::dvec3 position{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 scale{1.0}; ///< absolute values
    bool mirrored = false; ///< the axes are left-handed; `rotation` then has the third one turned round
};

/// The nodes of the scene that the file shows (its `scene`, else the first, else every root), parents before children.
/// Throws Error for wrong indices, wrong types, broken transforms, and nodes with more than one parent.
std::vector<GltfNode> read_gltf_nodes(const JsonValue& document, const std::string& file);

/// Throws Error, at the node, where the axes are not at right angles (a rotation below a non-uniform scale) or where
/// some but not all of the scale is zero. A scale of zero on all axes is returned as it is.
Placement take_apart(const GltfNode&);

} // namespace talus::scenes
