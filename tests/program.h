// SPDX-License-Identifier: MIT
// Runs the program talus as a user does, in a folder of its own. TALUS_PROGRAM_FILE says where it is.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

namespace talus::tests {

struct Ending {
    int status = 0;
    std::string output, errors;
};

class Program : public testing::Test {
protected:
    Program() { std::filesystem::create_directories(folder); }
    ~Program() override { std::filesystem::remove_all(folder.parent_path()); }

    /// Runs a line of shell in an empty folder that has a space in its name. `talus` stands for the program.
    Ending shell(const std::string& line) const {
        const std::filesystem::path output = folder.parent_path() / "output", errors = folder.parent_path() / "errors";
        const std::string command = "cd '" + folder.string() +
                                    "' && talus() { '" TALUS_PROGRAM_FILE "' \"$@\"; } && { " + line + "; } >'" +
                                    output.string() + "' 2>'" + errors.string() + "' </dev/null";
        const int result = std::system(command.c_str());
        return {WIFEXITED(result) ? WEXITSTATUS(result) : -1, text_of(output), text_of(errors)};
    }
    Ending talus(const std::string& arguments) const { return shell("talus " + arguments); }
    Ending run_on_cpu(const std::string& arguments) const { return talus("run --device cpu " + arguments); }

    static std::string text_of(const std::filesystem::path& path) {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    nlohmann::json json_of(const std::string& name) const { return nlohmann::json::parse(text_of(folder / name)); }
    bool folder_is_empty() const { return std::filesystem::is_empty(folder); }

    const std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / ("talus program " + std::to_string(getpid())) / "an empty folder";
};

inline std::vector<std::string> keys_of(const nlohmann::json& object) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : object.items())
        keys.push_back(key);
    return keys; // in alphabetical order
}

} // namespace talus::tests
