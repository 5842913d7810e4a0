// SPDX-License-Identifier: MIT
// Opens the two containers of glTF 2.0 (chapter 4 of its specification describes the binary one).
#include "scenes/gltf_file.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>

#include <talus/types.h>

namespace talus::scenes {

namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& reason) {
    throw Error("cannot read '" + path.string() + "': " + reason);
}

std::string read_bytes(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!std::filesystem::exists(status)) fail(path, "there is no such file");
    if (!std::filesystem::is_regular_file(status)) fail(path, "it is not a file");
    std::ifstream file(path, std::ios::binary);
    if (!file) fail(path, "it cannot be opened");
    std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    if (file.bad()) fail(path, "reading it failed");
    if (bytes.empty()) fail(path, "it is empty");
    return bytes;
}

/// Little-endian, as the format has it on every machine.
std::uint32_t word(std::string_view bytes, std::size_t offset) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[offset + i])) << (8 * i);
    return value;
}

/// Header: magic, version, length. Then chunks: length, type, content; the first one is the JSON.
std::string_view json_chunk(const std::filesystem::path& path, std::string_view bytes) {
    constexpr std::size_t k_header = 12, k_chunk_header = 8;
    constexpr std::uint32_t k_json = 0x4e4f534a;
    if (bytes.size() < k_header + k_chunk_header) fail(path, "it ends within the header of a binary glTF file");
    if (word(bytes, 4) != 2)
        fail(path, "it is binary glTF of version " + std::to_string(word(bytes, 4)) + "; version 2 is supported");
    if (word(bytes, 8) > bytes.size())
        fail(path,
             "it ends after " + std::to_string(bytes.size()) + " of " + std::to_string(word(bytes, 8)) + " bytes");
    if (word(bytes, 16) != k_json) fail(path, "its first chunk is not JSON");
    if (word(bytes, 12) > bytes.size() - k_header - k_chunk_header) fail(path, "it ends within its JSON");
    return bytes.substr(k_header + k_chunk_header, word(bytes, 12));
}

} // namespace

nlohmann::json read_gltf_file(const std::filesystem::path& path) {
    const std::string bytes = read_bytes(path);
    // The content decides: files of either kind are met under the other's ending.
    const bool binary = std::string_view(bytes).substr(0, 4) == "glTF";
    std::string ending = path.extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (!binary && ending == ".glb") fail(path, "it does not begin with 'glTF', so it is not binary glTF");

    nlohmann::json document;
    try {
        document = nlohmann::json::parse(binary ? json_chunk(path, bytes) : std::string_view(bytes));
    } catch (const nlohmann::json::exception& error) {
        fail(path, std::string("its JSON is broken (") + error.what() + ")");
    }
    if (!document.is_object()) fail(path, "its JSON is not an object, so it is not glTF");
    const auto asset = document.find("asset");
    if (asset == document.end() || !asset->is_object()) fail(path, "it has no 'asset', so it is not glTF");
    const auto version = asset->find("version");
    if (version == asset->end() || !version->is_string()) fail(path, "its 'asset' names no version of glTF");
    const std::string& text = version->get_ref<const std::string&>();
    if (!text.starts_with("2.")) fail(path, "it is glTF " + text + "; glTF 2 is supported");
    return document;
}

} // namespace talus::scenes
