// SPDX-License-Identifier: MIT
// Runs a line of shell and keeps what it prints.
#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace talus::tests {

struct ShellEnding {
    int status;
    std::string output; ///< and errors
};

inline ShellEnding run_in_shell(const std::string& command) {
    std::FILE* pipe = popen(("{ " + command + "\n} 2>&1 </dev/null").c_str(), "r");
    if (pipe == nullptr) return {-1, "cannot be started"};
    std::string output;
    std::array<char, 4096> part;
    while (const std::size_t count = std::fread(part.data(), 1, part.size(), pipe))
        output.append(part.data(), count);
    return {pclose(pipe), output};
}

} // namespace talus::tests
