// SPDX-License-Identifier: MIT
// Walks the node tree without recursion, since files decide its depth, and checks each step.
#include "scenes/gltf_nodes.h"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

namespace talus::scenes {

namespace {

glm::dquat read_rotation(const JsonValue& json) {
    const auto [x, y, z, w] = json.numbers<4>();
    const double length = std::sqrt(x * x + y * y + z * z + w * w);
    if (std::abs(length - 1.0) > 0.01) json.fail("is not a unit quaternion: its length is " + std::to_string(length));
    return {w / length, x / length, y / length, z / length};
}

glm::dvec3 read_vector(const JsonValue& json) {
    const auto [x, y, z] = json.numbers<3>();
    return {x, y, z};
}

glm::dmat4 read_local_transform(const JsonValue& node) {
    const auto translation = node.find("translation");
    const auto rotation = node.find("rotation");
    const auto scale = node.find("scale");
    if (const auto matrix = node.find("matrix")) {
        if (translation || rotation || scale) node.fail("has both a matrix and a translation, rotation or scale");
        const auto columns = matrix->numbers<16>();
        glm::dmat4 result;
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                result[column][row] = columns[static_cast<std::size_t>(4 * column + row)];
        if (result[0][3] != 0.0 || result[1][3] != 0.0 || result[2][3] != 0.0 || result[3][3] != 1.0)
            matrix->fail("its fourth row must be 0, 0, 0, 1");
        return result;
    }
    glm::dmat4 result(1.0);
    if (translation) result = glm::translate(result, read_vector(*translation));
    if (rotation) result *= glm::mat4_cast(read_rotation(*rotation));
    if (scale) result = glm::scale(result, read_vector(*scale));
    return result;
}

/// Indices of the nodes that the tree starts from.
std::vector<std::size_t> read_roots(const JsonValue& document, const std::string& file, const JsonValue& nodes) {
    const std::size_t node_count = nodes.size();
    std::vector<std::size_t> roots;
    const auto scenes = document.find("scenes");
    if (scenes && scenes->size() > 0) {
        const auto chosen = document.find("scene");
        const std::size_t index = chosen ? chosen->index(scenes->size(), "scenes") : 0;
        const auto list = scenes->named_element(index, file, "scene").find("nodes");
        for (std::size_t i = 0; list && i < list->size(); ++i)
            roots.push_back(list->element(i).index(node_count, "nodes"));
        return roots;
    }
    std::vector<bool> is_child(node_count, false);
    for (std::size_t i = 0; i < node_count; ++i) {
        const auto children = nodes.named_element(i, file, "node").find("children");
        for (std::size_t c = 0; children && c < children->size(); ++c)
            is_child[children->element(c).index(node_count, "nodes")] = true;
    }
    for (std::size_t i = 0; i < node_count; ++i)
        if (!is_child[i]) roots.push_back(i);
    return roots;
}

} // namespace

std::vector<GltfNode> read_gltf_nodes(const JsonValue& document, const std::string& file) {
    std::vector<GltfNode> result;
    const auto nodes = document.find("nodes");
    if (!nodes) return result;
    const std::size_t node_count = nodes->size();

    struct Visit {
        std::size_t node, parent;
    };
    std::vector<Visit> pending;
    const std::vector<std::size_t> roots = read_roots(document, file, *nodes);
    for (auto root = roots.rbegin(); root != roots.rend(); ++root)
        pending.push_back({*root, k_no_node});

    std::vector<bool> seen(node_count, false);
    while (!pending.empty()) {
        const Visit visit = pending.back();
        pending.pop_back();
        JsonValue json = nodes->named_element(visit.node, file, "node");
        if (seen[visit.node]) json.fail("stands at two places of the node tree");
        seen[visit.node] = true;

        const auto name = json.find("name");
        GltfNode node{json, visit.node, name ? name->text() : std::string{}, read_local_transform(json), visit.parent};
        if (node.name.empty()) node.name = "node " + std::to_string(visit.node);
        if (visit.parent != k_no_node) node.world = result[visit.parent].world * node.world;
        result.push_back(std::move(node));

        if (const auto children = json.find("children"))
            for (std::size_t i = children->size(); i-- > 0;)
                pending.push_back({children->element(i).index(node_count, "nodes"), result.size() - 1});
    }
    return result;
}

Placement take_apart(const GltfNode& node) {
    constexpr double k_square = 1e-4; // cosine between two axes that still counts as a right angle
    Placement result;
    result.position = glm::dvec3(node.world[3]);
    glm::dmat3 axes(node.world);
    for (int i = 0; i < 3; ++i)
        result.scale[i] = glm::length(axes[i]);
    if (result.scale == glm::dvec3(0.0)) return result;
    for (int i = 0; i < 3; ++i) {
        if (result.scale[i] == 0.0) node.json.fail("its scale is zero along some axes and not along all");
        axes[i] /= result.scale[i];
    }
    for (int i = 0; i < 3; ++i)
        if (std::abs(glm::dot(axes[i], axes[(i + 1) % 3])) > k_square)
            node.json.fail("is sheared: it is rotated below a node whose scale is not the same along all axes; "
                           "a box or sphere stays one only without shear");
    result.mirrored = glm::determinant(axes) < 0.0;
    if (result.mirrored) axes[2] = -axes[2];
    result.rotation = glm::normalize(glm::quat_cast(axes));
    return result;
}

} // namespace talus::scenes
