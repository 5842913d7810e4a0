// SPDX-License-Identifier: MIT
// A file is a Header and the driver's bytes. Its name tells kernel and driver, the key in its header also the source:
// so there is one file a kernel and driver, however often the kernel changes. Drivers need not survive what is not
// theirs, so they are given only bytes with the right key and checksum, and still may refuse them.
#include "device/gl/program_cache.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <random>
#include <system_error>

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace talus::engine {
namespace {

constexpr std::array k_magic{'T', 'A', 'L', 'U', 'S', 'G', 'L', '1'};

struct Header {
    std::array<char, 8> magic;
    std::array<std::uint64_t, 2> key; // of the driver and the source
    std::uint64_t checksum;           // of the bytes
    std::uint64_t byte_count;
    std::uint64_t format;
};

struct Binary {
    GLenum format = 0;
    std::vector<char> bytes;
};

bool allowed_by_environment() {
    const char* value = std::getenv("TALUS_PROGRAM_CACHE");
    return value == nullptr || std::strcmp(value, "0") != 0;
}

/// Empty where the environment names none. By the rules of the XDG folders a relative path does not count.
std::filesystem::path users_cache_folder() {
    const auto folder = [](const char* variable) {
        const char* value = std::getenv(variable);
        const std::filesystem::path path = value != nullptr ? value : "";
        return path.is_absolute() ? path : std::filesystem::path();
    };
    if (const std::filesystem::path cache = folder("XDG_CACHE_HOME"); !cache.empty()) return cache;
    const std::filesystem::path home = folder("HOME");
    return home.empty() ? home : home / ".cache";
}

std::string driver_strings() {
    std::string strings;
    for (const GLenum name : {GL_VENDOR, GL_RENDERER, GL_VERSION}) {
        const auto* text = reinterpret_cast<const char*>(glGetString(name));
        strings += text != nullptr ? text : "unknown";
        strings += '\0';
    }
    return strings;
}

std::array<std::uint64_t, 2> key_of(const std::string& driver, std::string_view source) {
    const XXH128_hash_t hash =
        XXH3_128bits_withSeed(source.data(), source.size(), XXH3_64bits(driver.data(), driver.size()));
    return {hash.low64, hash.high64};
}

std::optional<Binary> read_binary(const std::filesystem::path& path, const std::array<std::uint64_t, 2>& key) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    const std::streamoff size = file ? static_cast<std::streamoff>(file.tellg()) : 0;
    Header header{};
    if (size < static_cast<std::streamoff>(sizeof header)) return {};
    file.seekg(0);
    file.read(reinterpret_cast<char*>(&header), sizeof header);
    if (header.magic != k_magic || header.key != key ||
        header.byte_count != static_cast<std::uint64_t>(size) - sizeof header)
        return {};
    Binary binary{static_cast<GLenum>(header.format), std::vector<char>(header.byte_count)};
    file.read(binary.bytes.data(), static_cast<std::streamsize>(binary.bytes.size()));
    if (!file || XXH3_64bits(binary.bytes.data(), binary.bytes.size()) != header.checksum) return {};
    return binary;
}

/// Writes beside the place and moves the file there, so that no reader sees a part of it.
void write_binary(const std::filesystem::path& path, const std::array<std::uint64_t, 2>& key, const Binary& binary) {
    const Header header{k_magic, key, XXH3_64bits(binary.bytes.data(), binary.bytes.size()), binary.bytes.size(),
                        binary.format};
    std::error_code failed;
    std::filesystem::create_directories(path.parent_path(), failed);
    std::random_device random;
    const std::filesystem::path part = fmt::format("{}.{:08x}{:08x}", path.string(), random(), random());
    std::ofstream file(part, std::ios::binary);
    file.write(reinterpret_cast<const char*>(&header), sizeof header);
    file.write(binary.bytes.data(), static_cast<std::streamsize>(binary.bytes.size()));
    file.close();
    if (file) std::filesystem::rename(part, path, failed);
    if (!file || failed) std::filesystem::remove(part, failed);
}

} // namespace

ProgramCache::ProgramCache(bool wanted) {
    if (!wanted || !allowed_by_environment()) return;
    GLint count = 0;
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &count);
    const std::filesystem::path cache = users_cache_folder();
    if (count <= 0 || cache.empty()) return;
    formats_.resize(static_cast<std::size_t>(count));
    glGetIntegerv(GL_PROGRAM_BINARY_FORMATS, formats_.data());
    driver_ = driver_strings();
    folder_ = cache / "talus";
}

std::filesystem::path ProgramCache::file_of(const std::string& kernel) const {
    std::string name = kernel;
    std::ranges::replace(name, '/', '.');
    return folder_ / fmt::format("{}.{:016x}", name, XXH3_64bits(driver_.data(), driver_.size()));
}

GLuint ProgramCache::load(const std::string& kernel, std::string_view source) const {
    if (folder_.empty()) return 0;
    const std::optional<Binary> binary = read_binary(file_of(kernel), key_of(driver_, source));
    if (!binary || std::ranges::find(formats_, static_cast<GLint>(binary->format)) == formats_.end()) return 0;
    const GLuint program = glCreateProgram();
    glProgramBinary(program, binary->format, binary->bytes.data(), static_cast<GLsizei>(binary->bytes.size()));
    GLint linked = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked == GL_TRUE) return program;
    glDeleteProgram(program);
    return 0;
}

void ProgramCache::store(const std::string& kernel, std::string_view source, GLuint linked_program) const {
    if (folder_.empty()) return;
    GLint size = 0;
    glGetProgramiv(linked_program, GL_PROGRAM_BINARY_LENGTH, &size);
    if (size <= 0) return;
    Binary binary{0, std::vector<char>(static_cast<std::size_t>(size))};
    GLsizei written = 0;
    glGetProgramBinary(linked_program, size, &written, &binary.format, binary.bytes.data());
    if (written <= 0) return;
    binary.bytes.resize(static_cast<std::size_t>(written));
    write_binary(file_of(kernel), key_of(driver_, source), binary);
}

} // namespace talus::engine
