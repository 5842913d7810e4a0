// SPDX-License-Identifier: MIT
// Temporary names: hidden, beside the target so that the rename stays on one file system, and with the process in them
// so that two programs which write the same target do not meet.
#include "render/partial_file.h"

#include <string>
#include <system_error>
#include <utility>

#include <unistd.h>

#include <talus/types.h>

namespace talus::render {

PartialFile::PartialFile(std::filesystem::path target) : target_(std::move(target)) {
    if (target_.filename().empty()) throw Error("cannot write to '" + target_.string() + "': it names no file");
    std::string name(".");
    name.append(target_.filename().string()).append(".").append(std::to_string(getpid())).append(".partial");
    temporary_ = target_;
    temporary_.replace_filename(name);
}

PartialFile::~PartialFile() {
    std::error_code ignored;
    if (!committed_) std::filesystem::remove(temporary_, ignored);
}

void PartialFile::commit() {
    std::error_code error;
    std::filesystem::rename(temporary_, target_, error);
    if (error) throw Error("cannot write " + target_.string() + ": " + error.message());
    committed_ = true;
}

} // namespace talus::render
