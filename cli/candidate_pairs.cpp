// SPDX-License-Identifier: MIT
// A binary tree of regions, split at the median centre along the axis on which the centres spread most. Its nodes lie
// in one array, each inner node followed by its left subtree.
#include "candidate_pairs.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include <glm/common.hpp>

namespace talus::cli {
namespace {

constexpr std::uint32_t k_leaf_size = 4;

bool overlap(const Region& a, const Region& b) {
    return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y && b.lower.y <= a.upper.y &&
           a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
}

struct Node {
    Region region;
    std::uint32_t first = 0;
    std::uint32_t count = 0; ///< items of a leaf; 0 for an inner node
    std::uint32_t right = 0; ///< of an inner node: index of the right child
};

class Tree {
public:
    explicit Tree(std::span<const Region> all) : regions(all), order(all.size()) {
        std::iota(order.begin(), order.end(), 0u);
        nodes.reserve(all.size());
        build(0, static_cast<std::uint32_t>(all.size()));
    }

    template <typename Visit> void for_each_above(std::uint32_t item, const Visit& visit) {
        const Region& region = regions[item];
        stack.assign(1, 0u);
        while (!stack.empty()) {
            const std::uint32_t index = stack.back();
            const Node& node = nodes[index];
            stack.pop_back();
            if (!overlap(region, node.region)) continue;
            if (node.count == 0) {
                stack.push_back(node.right);
                stack.push_back(index + 1);
            }
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
                if (order[i] > item && overlap(region, regions[order[i]])) visit(item, order[i]);
        }
    }

private:
    void build(std::uint32_t first, std::uint32_t last) {
        const std::uint32_t index = static_cast<std::uint32_t>(nodes.size());
        nodes.emplace_back();
        Region whole = regions[order[first]];
        Region centres{twice_centre(order[first]), twice_centre(order[first])};
        for (std::uint32_t i = first + 1; i < last; ++i) {
            whole.lower = glm::min(whole.lower, regions[order[i]].lower);
            whole.upper = glm::max(whole.upper, regions[order[i]].upper);
            centres.lower = glm::min(centres.lower, twice_centre(order[i]));
            centres.upper = glm::max(centres.upper, twice_centre(order[i]));
        }
        nodes[index].region = whole;
        if (last - first <= k_leaf_size) {
            nodes[index].first = first;
            nodes[index].count = last - first;
            return;
        }
        const glm::dvec3 spread = centres.upper - centres.lower;
        const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
        const std::uint32_t middle = first + (last - first) / 2;
        std::nth_element(
            order.begin() + first, order.begin() + middle, order.begin() + last,
            [&](std::uint32_t a, std::uint32_t b) { return twice_centre(a)[axis] < twice_centre(b)[axis]; });
        build(first, middle);
        nodes[index].right = static_cast<std::uint32_t>(nodes.size());
        build(middle, last);
    }

    glm::dvec3 twice_centre(std::uint32_t item) const { return regions[item].lower + regions[item].upper; }

    std::span<const Region> regions;
    std::vector<std::uint32_t> order;
    std::vector<Node> nodes;
    std::vector<std::uint32_t> stack;
};

} // namespace

void for_each_overlap(std::span<const Region> regions, const std::function<void(std::uint32_t, std::uint32_t)>& visit) {
    if (regions.empty()) return;
    Tree tree(regions);
    for (std::uint32_t item = 0; item < regions.size(); ++item)
        tree.for_each_above(item, visit);
}

} // namespace talus::cli
