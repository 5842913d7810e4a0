// SPDX-License-Identifier: MIT
// Collision filters of a glTF file. Talus has none: every pair of bodies may collide. So filters are harmless where
// they let all pairs collide anyway, and are refused where they keep a pair apart.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scenes/gltf_nodes.h"

namespace talus::scenes {

struct FilteredBody {
    std::optional<std::size_t> filter;
    bool moved_by_contacts = false; ///< a pair without any such body has no contact to filter
    const GltfNode* node = nullptr;
};

/// Throws Error which names the two bodies, for the first pair that a filter keeps apart.
void require_harmless_filters(const std::vector<FilteredBody>&, const std::optional<JsonValue>& filters);

} // namespace talus::scenes
