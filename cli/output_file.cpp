// SPDX-License-Identifier: MIT
// A file is written beside its target and renamed. What exists and is not itself a file (a pipe, a device, a link such
// as /dev/stdout) is written to directly: renaming would put a file in its place.
#include "cli/output_file.h"

#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>

#include <talus/types.h>
#include <unistd.h>

#include "render/partial_file.h"

namespace talus::cli {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
    throw Error("cannot write " + path.string() + ": " + reason);
}

[[noreturn]] void fail_for_system_reason(const fs::path& path) {
    fail(path, std::error_code(errno, std::generic_category()).message());
}

bool is_something_else(const fs::path& path) {
    std::error_code ignored;
    const fs::file_status status = fs::symlink_status(path, ignored);
    return fs::exists(status) && !fs::is_regular_file(status);
}

void write_to(const fs::path& path, const fs::path& shown_path, std::string_view text) {
    errno = 0;
    std::ofstream file(path, std::ios::binary);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    file.close();
    if (!file) fail_for_system_reason(shown_path);
}

} // namespace

void check_output(const fs::path& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) fail(path, "it is a folder");
    if (fs::exists(path, ignored) && is_something_else(path)) {
        if (access(path.c_str(), W_OK) != 0) fail_for_system_reason(path);
        return;
    }
    const render::PartialFile partial(path);
    write_to(partial.temporary(), path, "");
}

void check_replaceable_output(const fs::path& path) {
    if (is_something_else(path)) fail(path, "there is something of that name which is not a file");
    check_output(path);
}

void write_output(const fs::path& path, std::string_view text) {
    if (is_something_else(path)) {
        write_to(path, path, text);
        return;
    }
    render::PartialFile partial(path);
    write_to(partial.temporary(), path, text);
    partial.commit();
}

} // namespace talus::cli
