// SPDX-License-Identifier: MIT
// The documentation: the first program of README.md runs and prints what stands there, also where it is built as
// README.md says; the commands exist, the links and the named files are there, and docs/architecture.md has the stages
// in run order.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include <talus/world.h>

#include "scenes/scene.h"
#include "tests/shell.h"
#include "tests/text_of.h"

namespace {

using talus::tests::run_in_shell;
using talus::tests::ShellEnding;

namespace fs = std::filesystem;
using talus::tests::text_of;

const fs::path k_root = TALUS_SOURCE_FOLDER;

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);)
        lines.push_back(line);
    return lines;
}

std::vector<std::string> words_of(const std::string& line) {
    std::istringstream stream(line);
    return {std::istream_iterator<std::string>(stream), {}};
}

/// The code blocks of a Markdown file that are marked with this language.
std::vector<std::string> blocks_of(const std::string& text, const std::string& language) {
    std::vector<std::string> blocks;
    bool inside = false, wanted = false;
    for (const std::string& line : lines_of(text)) {
        if (line.starts_with("```")) {
            wanted = !inside && line == "```" + language;
            inside = !inside;
            if (wanted) blocks.emplace_back();
        } else if (inside && wanted) {
            blocks.back() += line + '\n';
        }
    }
    return blocks;
}

/// The text without its code blocks.
std::string prose_of(const std::string& text) {
    std::string prose;
    bool inside = false;
    for (const std::string& line : lines_of(text)) {
        if (line.starts_with("```"))
            inside = !inside;
        else if (!inside)
            prose += line + '\n';
    }
    return prose;
}

std::vector<fs::path> documents() {
    std::vector<fs::path> files{k_root / "README.md", k_root / "CHANGELOG.md"};
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(k_root / "docs"))
        if (entry.path().extension() == ".md") files.push_back(entry.path());
    return files;
}

std::string first_program() {
    return blocks_of(text_of(k_root / "README.md"), "cpp").at(0);
}

/// Lines of README.md's shell blocks that begin with this word, without it.
std::vector<std::vector<std::string>> commands(const std::string& program) {
    std::vector<std::vector<std::string>> result;
    for (const std::string& block : blocks_of(text_of(k_root / "README.md"), "sh")) {
        for (const std::string& line : lines_of(block)) {
            std::vector<std::string> words = words_of(line);
            if (words.empty() || words.front() != program) continue;
            words.erase(words.begin());
            result.push_back(words);
        }
    }
    return result;
}

} // namespace

TEST(Readme, first_program_has_at_most_30_lines) {
    EXPECT_LE(lines_of(first_program()).size(), 30u);
}

TEST(Readme, first_program_is_the_example) {
    const std::string example = text_of(k_root / "examples/hello_world.cpp");
    EXPECT_EQ(example.substr(example.find("#include")), first_program());
}

TEST(Readme, first_program_prints_what_stands_there) {
    const ShellEnding ending = run_in_shell("'" TALUS_README_PROGRAM_FILE "'");
    EXPECT_EQ(ending.status, 0);
    EXPECT_EQ(ending.output, blocks_of(text_of(k_root / "README.md"), "text").at(0));
}

TEST(Readme, first_program_builds_as_it_says) {
    const std::string readme = text_of(k_root / "README.md");
    const std::vector<std::string> scripts = blocks_of(readme, "sh");
    const auto script = std::ranges::find_if(
        scripts, [](const std::string& block) { return block.find("./build/hello") != std::string::npos; });
    ASSERT_NE(script, scripts.end());

    const fs::path folder = fs::path(testing::TempDir()) / ("talus_readme_" + std::to_string(getpid()));
    fs::create_directories(folder);
    fs::create_directory_symlink(k_root, folder / "talus");
    std::ofstream(folder / "CMakeLists.txt") << blocks_of(readme, "cmake").at(0);
    std::ofstream(folder / "hello.cpp") << first_program();
    std::ofstream(folder / "script") << *script;
    // The compiler that built this test, and with it a compiler cache where there is one.
    setenv("CXX", TALUS_COMPILER, 1);
    setenv("CMAKE_CXX_COMPILER_LAUNCHER", TALUS_COMPILER_LAUNCHER, 1);
    const ShellEnding ending = run_in_shell("cd '" + folder.string() + "' && sh -e script");
    EXPECT_EQ(ending.status, 0) << ending.output;
    EXPECT_TRUE(ending.output.ends_with("\n" + blocks_of(readme, "text").at(0))) << ending.output;
    fs::remove_all(folder);
}

TEST(Readme, commands_of_the_program_exist) {
    const auto all = commands("./talus");
    ASSERT_FALSE(all.empty());
    const std::string launcher = text_of(k_root / "talus");
    for (const std::vector<std::string>& words : all) {
        ASSERT_FALSE(words.empty());
        const std::string& command = words.front();
        if (command == "test") { // the launcher's own
            EXPECT_NE(launcher.find("== test ]]"), std::string::npos);
            continue;
        }
        const ShellEnding help = run_in_shell("'" TALUS_PROGRAM_FILE "' " + command + " --help");
        EXPECT_EQ(help.status, 0) << command << ": " << help.output;
        for (const std::string& word : words) {
            if (!word.starts_with("--")) continue;
            EXPECT_NE(help.output.find(word + " "), std::string::npos) << "talus " << command << " has no " << word;
        }
        if (command == "run" || command == "parity") {
            EXPECT_NO_THROW(talus::scenes::make_scene(words.at(1))) << words.at(1);
        }
    }
}

TEST(Readme, cmake_presets_exist) {
    const std::string presets = text_of(k_root / "CMakePresets.json");
    for (const std::string program : {"cmake", "ctest"}) {
        for (const std::vector<std::string>& words : commands(program)) {
            const auto preset = std::ranges::find(words, "--preset");
            if (preset == words.end()) continue;
            EXPECT_NE(presets.find("\"name\": \"" + *std::next(preset) + "\""), std::string::npos)
                << *std::next(preset);
        }
    }
}

TEST(Documents, links_lead_to_files) {
    const std::regex link(R"(\]\(([^)#]+)(#[^)]*)?\))");
    for (const fs::path& document : documents()) {
        const std::string text = prose_of(text_of(document));
        for (std::sregex_iterator found(text.begin(), text.end(), link), end; found != end; ++found) {
            const std::string target = (*found)[1];
            if (target.find("://") != std::string::npos) continue;
            EXPECT_TRUE(fs::exists(document.parent_path() / target)) << document << ": no file " << target;
        }
    }
}

TEST(Documents, named_files_exist) {
    const std::regex path("`((src|include|scenes|render|cli|tests|examples|docs|cmake)/[A-Za-z0-9_./]*)`");
    for (const fs::path& document : documents()) {
        const std::string text = text_of(document);
        for (std::sregex_iterator found(text.begin(), text.end(), path), end; found != end; ++found)
            EXPECT_TRUE(fs::exists(k_root / (*found)[1].str())) << document << ": no file " << (*found)[1];
    }
}

TEST(Documents, architecture_has_the_stages_in_run_order) {
    const std::vector<std::string> lines = lines_of(text_of(k_root / "docs/architecture.md"));
    auto place = lines.begin();
    for (const char* stage : talus::stage_names()) {
        place = std::find(place, lines.end(), "## " + std::string(stage));
        EXPECT_NE(place, lines.end()) << "no heading for " << stage << " in its place";
    }
}

TEST(Documents, every_kernel_is_in_the_architecture) {
    const std::string text = text_of(k_root / "docs/architecture.md");
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(k_root / "src")) {
        const std::string name = entry.path().filename().string();
        const std::size_t ending = name.find(".comp.glsl");
        // Scans and sorts are named as such: their kernels belong to no stage.
        if (ending == std::string::npos || entry.path().parent_path().filename() == "primitives") continue;
        EXPECT_NE(text.find(name.substr(0, ending)), std::string::npos) << name << " is not mentioned";
    }
}
