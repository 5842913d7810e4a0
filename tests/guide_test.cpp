// SPDX-License-Identifier: MIT
// The guide: each piece of C++ compiles, runs, and prints the block of text that stands behind it; no page is left out
// of the index, and each built-in scene has its picture.
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <talus/types.h>

#include "scenes/scene.h"
#include "tests/guide_examples.h"
#include "tests/text_of.h"

namespace talus::tests {
namespace {

namespace fs = std::filesystem;

const fs::path k_guide = TALUS_SOURCE_FOLDER "/docs/guide";

/// For each piece of C++ on a page what it is said to print.
std::vector<std::string> outputs_on(const fs::path& page) {
    const std::string text = text_of(page), code = "\n```cpp", output = "\n```\n\n```text\n";
    std::vector<std::string> outputs;
    for (std::size_t at = text.find(code); at != std::string::npos; at = text.find(code, at + 1)) {
        const std::size_t end = text.find("\n```", at + 1);
        outputs.emplace_back();
        if (text.compare(end, output.size(), output) != 0) continue;
        const std::size_t begin = end + output.size();
        outputs.back() = text.substr(begin, text.find("```", begin) - begin);
    }
    return outputs;
}

TEST(Guide, examples_print_what_stands_behind_them) {
    std::string page;
    std::vector<std::string> outputs;
    std::size_t place = 0, printing = 0;
    ASSERT_GE(guide_examples().size(), 20u);
    for (const GuideExample& example : guide_examples()) {
        if (page != example.page) {
            page = example.page;
            outputs = outputs_on(k_guide / page);
            place = 0;
        }
        SCOPED_TRACE(page + ", example " + std::to_string(place + 1));
        ASSERT_LT(place, outputs.size());
        const std::string& expected = outputs[place++];
        printing += !expected.empty();
        if (example.run == nullptr) continue;
        testing::internal::CaptureStdout();
        try {
            example.run();
        } catch (const Error& error) {
            ADD_FAILURE() << error.what();
        }
        const std::string printed = testing::internal::GetCapturedStdout();
        if (!expected.empty()) {
            EXPECT_EQ(printed, expected);
        }
    }
    EXPECT_GE(printing, 12u);
}

TEST(Guide, has_every_page_in_its_index) {
    const std::string index = text_of(k_guide / "README.md");
    for (const fs::directory_entry& entry : fs::directory_iterator(k_guide)) {
        const std::string name = entry.path().filename().string();
        if (name != "README.md") {
            EXPECT_NE(index.find("(" + name + ")"), std::string::npos) << name;
        }
    }
    for (const fs::directory_entry& entry : fs::directory_iterator(TALUS_SOURCE_FOLDER "/examples"))
        if (entry.path().extension() == ".cpp") {
            const std::string name = entry.path().filename().string();
            EXPECT_NE(index.find("(../../examples/" + name + ")"), std::string::npos) << name;
        }
}

TEST(Guide, has_a_picture_of_every_scene_and_a_script_makes_it) {
    const std::string page = text_of(k_guide / "scenes.md"), script = text_of(k_guide / "../make_pictures.sh");
    for (const scenes::SceneInfo& scene : scenes::list_scenes()) {
        EXPECT_NE(page.find("(../images/scenes/" + scene.name + ".png)"), std::string::npos) << scene.name;
        EXPECT_TRUE(fs::exists(k_guide / "../images/scenes" / (scene.name + ".png"))) << scene.name;
        EXPECT_NE(script.find("\n" + scene.name + " "), std::string::npos) << scene.name;
    }
}

} // namespace
} // namespace talus::tests
