// SPDX-License-Identifier: MIT
// The JSON of a glTF file, text (.gltf) or binary (.glb). Buffers and images are not opened: implicit shapes need
// neither.
//
// The JSON is read as it stands and not through a glTF loader: loaders pass over what has the wrong type, drop
// top-level arrays which they do not know (`shapes`), and fail where a mesh's buffer is missing.
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

namespace talus::scenes {

/// Throws Error for a file that cannot be read, is cut short, is not JSON, or is not glTF 2.
nlohmann::json read_gltf_file(const std::filesystem::path&);

} // namespace talus::scenes
