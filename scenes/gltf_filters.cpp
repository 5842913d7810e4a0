// SPDX-License-Identifier: MIT
// Compares filters, not bodies: files have few filters and many bodies.
#include "scenes/gltf_filters.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>

namespace talus::scenes {

namespace {

using Systems = std::set<std::string>;

struct Filter {
    Systems member_of;
    std::optional<Systems> only_with;
    Systems never_with;
};

std::optional<Systems> read_systems(const JsonValue& filter, const char* key) {
    const auto json = filter.find(key);
    if (!json) return std::nullopt;
    Systems systems;
    for (std::size_t i = 0; i < json->size(); ++i)
        systems.insert(json->element(i).text());
    return systems;
}

Filter read_filter(const JsonValue& json) {
    return {read_systems(json, "collisionSystems").value_or(Systems{}), read_systems(json, "collideWithSystems"),
            read_systems(json, "notCollideWithSystems").value_or(Systems{})};
}

/// Whether `other` is certain to be let through. Readers of the draft differ on a body in several systems of which only
/// some are allowed, and on one in none; these count as kept apart, since a scene must not depend on the reader.
bool lets_through(const Filter& filter, const Filter& other) {
    if (filter.only_with && (other.member_of.empty() || !std::ranges::includes(*filter.only_with, other.member_of)))
        return false;
    return std::ranges::none_of(other.member_of,
                                [&](const auto& system) { return filter.never_with.contains(system); });
}

/// The bodies that share one filter: enough of them to find a pair.
struct Group {
    Filter filter;
    std::vector<const FilteredBody*> moved, others;
};

void require_pair(const std::vector<const FilteredBody*>& a, const std::vector<const FilteredBody*>& b, bool same) {
    if (a.empty() || b.empty() || (same && a.size() < 2)) return;
    const GltfNode& other = *(same ? b[1] : b[0])->node;
    a[0]->node->json.fail("a collision filter keeps it apart from '" + other.name +
                          "'; Talus has no filters, so the two would collide");
}

} // namespace

void require_harmless_filters(const std::vector<FilteredBody>& bodies, const std::optional<JsonValue>& filters) {
    std::map<std::optional<std::size_t>, Group> groups;
    for (const FilteredBody& body : bodies) {
        const auto [group, added] = groups.try_emplace(body.filter);
        if (added && body.filter) group->second.filter = read_filter(filters->element(*body.filter));
        (body.moved_by_contacts ? group->second.moved : group->second.others).push_back(&body);
    }
    for (auto a = groups.begin(); a != groups.end(); ++a)
        for (auto b = a; b != groups.end(); ++b) {
            const Group& first = a->second;
            const Group& second = b->second;
            if (lets_through(first.filter, second.filter) && lets_through(second.filter, first.filter)) continue;
            require_pair(first.moved, second.moved, a == b);
            require_pair(first.moved, second.others, false);
            if (a != b) require_pair(second.moved, first.others, false);
        }
}

} // namespace talus::scenes
