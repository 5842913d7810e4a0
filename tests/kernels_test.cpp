// SPDX-License-Identifier: MIT
// The kernels as a set: each has its CPU twin, two compilers accept each, and both languages lay the records out alike.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <type_traits>

#include <epoxy/gl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "device/device.h"
#include "device/gl/gl_context.h"
#include "device/gl/gl_device.h"
#include "device/gl/gl_program.h"
#include "device/gl/kernel_source.h"
#include "device/gl/record_blocks.h"
#include "tests/devices.h"

namespace talus::engine {
namespace {

namespace fs = std::filesystem;

const fs::path k_source_folder = fs::path(TALUS_SOURCE_FOLDER) / "src";

std::string text_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Files below src/ with an ending, as paths below src/ without it.
std::set<std::string> files_ending_in(const std::string& ending) {
    std::set<std::string> paths;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(k_source_folder)) {
        const std::string path = fs::relative(entry.path(), k_source_folder).generic_string();
        if (path.ends_with(ending)) paths.insert(path.substr(0, path.size() - ending.size()));
    }
    return paths;
}

// ---- twins ----

TEST(Kernels, are_all_embedded) {
    const std::vector<std::string> embedded = kernel_paths();
    EXPECT_EQ(std::set<std::string>(embedded.begin(), embedded.end()), files_ending_in(".comp.glsl"));
    EXPECT_GT(embedded.size(), 20u);
}

TEST(Kernels, have_a_twin_of_the_same_name_beside_them) {
    const std::regex definition(R"re(const Kernel (\w+)\{"([^"]+)")re");
    std::set<std::string> twins;
    for (const std::string& path : files_ending_in(".cpp")) {
        const std::string text = text_of(k_source_folder / (path + ".cpp"));
        for (std::sregex_iterator match(text.begin(), text.end(), definition), end; match != end; ++match) {
            EXPECT_EQ((*match)[2], path) << "the kernel of " << path << ".cpp runs another shader";
            EXPECT_EQ((*match)[1], fs::path(path).filename().string()) << path << ".cpp";
            twins.insert((*match)[2]);
        }
    }
    EXPECT_EQ(twins, files_ending_in(".comp.glsl"));
}

// ---- a folder to read them from ----

class KernelFolder : public testing::Test {
protected:
    KernelFolder() { fs::create_directories(folder); }
    ~KernelFolder() override {
        unsetenv("TALUS_KERNEL_PATH");
        fs::remove_all(folder);
    }

    static std::string refusal(const fs::path& named) {
        setenv("TALUS_KERNEL_PATH", named.c_str(), 1);
        return tests::error_of(check_kernel_folder);
    }

    const fs::path folder = fs::path(testing::TempDir()) / ("talus_kernel_folder_" + std::to_string(getpid()));
};

TEST_F(KernelFolder, is_refused_where_it_can_change_nothing) {
    EXPECT_NE(refusal(folder / "none").find("none', and there is no such folder"), std::string::npos);
    EXPECT_NE(refusal(folder).find("holds no shader of Talus"), std::string::npos);
    EXPECT_EQ(refusal(""), "no error");
    EXPECT_EQ(refusal(k_source_folder), "no error");
}

TEST_F(KernelFolder, replaces_the_files_that_it_holds) {
    const std::string path = kernel_paths().front(), other = kernel_paths().back();
    const std::string before = kernel_source(other).text;
    fs::create_directories((folder / path).parent_path());
    std::ofstream(folder / (path + ".comp.glsl")) << "// changed by a test\n";
    EXPECT_EQ(refusal(folder), "no error");
    EXPECT_NE(kernel_source(path).text.find("changed by a test"), std::string::npos);
    EXPECT_EQ(kernel_source(other).text, before);
}

// ---- compilers ----

TEST(Kernels, are_accepted_by_glslang) {
    if (std::system("glslangValidator --version > /dev/null 2>&1") != 0)
        GTEST_SKIP() << "NOT TESTED, there is no glslangValidator here (package glslang-tools)";
    const fs::path folder = fs::path(testing::TempDir()) / ("talus_kernels_" + std::to_string(getpid()));
    const KernelTarget of_hardware{.waits_freely = true, .in_step = 32};
    for (const KernelTarget& target : {KernelTarget(), of_hardware})
        for (const std::string& path : kernel_paths()) {
            const fs::path file = folder / (path + ".comp");
            fs::create_directories(file.parent_path());
            const KernelSource source = kernel_source(path, target);
            // Of `precise` glslang 12 follows every expression back to where it began, which takes memory without end
            // in the kernels of the solver. The word changes none of the rules that are checked here.
            std::ofstream(file) << std::regex_replace(source.text, std::regex("\\bprecise "), "");
            const fs::path log = folder / "log";
            const std::string command = "glslangValidator '" + file.string() + "' > '" + log.string() + "' 2>&1";
            EXPECT_EQ(std::system(command.c_str()), 0) << path << ":\n" << trace_log(text_of(log), source);
        }
    fs::remove_all(folder);
}

class GlKernels : public testing::TestWithParam<DeviceKind> {
protected:
    void SetUp() override {
        TALUS_SKIP_WITHOUT(DeviceKind::Gpu);
        context = OpenGlContext::own();
        context->make_current();
    }
    std::unique_ptr<OpenGlContext> context;
};

TEST_P(GlKernels, are_not_made_from_a_folder_that_is_not_there) {
    setenv("TALUS_KERNEL_PATH", "/none/such", 1);
    const std::string error = tests::error_of([] { const World refused({}, tests::options_on(DeviceKind::Gpu)); });
    unsetenv("TALUS_KERNEL_PATH");
    EXPECT_NE(error.find("/none/such"), std::string::npos) << error;
}

TEST_P(GlKernels, compile_and_use_no_more_buffers_than_every_driver_has) {
    for (const std::string& path : kernel_paths()) {
        try {
            GlProgram program(path, find_kernel_target(*context), ProgramCache(false));
            program.finish(ProgramCache(false));
            EXPECT_LE(program.blocks().size(), k_max_storage_blocks) << path;
            GLint size[3]{};
            glGetProgramiv(program.name(), GL_COMPUTE_WORK_GROUP_SIZE, size);
            EXPECT_LE(size[0] * size[1] * size[2], 1024) << path;
        } catch (const Error& error) {
            ADD_FAILURE() << error.what();
        }
    }
}

// ---- layouts ----

struct Member {
    std::string name;
    std::string letters; ///< a letter a word: f float, u uint
};

using Record = std::vector<Member>;

/// The structs of records.shared.glsl, which both compilers read.
std::map<std::string, Record> records() {
    const std::string text =
        std::regex_replace(text_of(k_source_folder / "state/records.shared.glsl"), std::regex("//[^\n]*"), "");
    const std::map<std::string, std::string> types{{"float", "f"}, {"uint", "u"}, {"vec3", "fff"}, {"vec4", "ffff"}};
    std::map<std::string, Record> result;
    const std::regex record_pattern(R"(struct (\w+) \{([^}]*)\};)"), member_pattern(R"((\w+) (\w+);)");
    for (std::sregex_iterator record(text.begin(), text.end(), record_pattern), end; record != end; ++record) {
        const std::string body = (*record)[2];
        for (std::sregex_iterator member(body.begin(), body.end(), member_pattern); member != end; ++member)
            result[(*record)[1]].push_back({(*member)[2], types.at((*member)[1])});
    }
    return result;
}

std::string letters_of(const Record& record) {
    std::string letters;
    for (const Member& member : record)
        letters += member.letters;
    return letters;
}

struct BufferRecord {
    const char* block;
    const char* record;
};
constexpr BufferRecord k_buffer_records[]{
#define X(block, field, element, layout, role) {#block, #element},
    TALUS_BUFFERS(X)
#undef X
};

// Members of four-byte words that follow each other without a gap: so a member's offset is the number of words before
// it, four bytes each.
#define X(block, field, element, layout, role)                                                                         \
    static_assert(std::is_standard_layout_v<element> && alignof(element) == 4);                                        \
    static_assert(sizeof(element) == 4 * (sizeof(layout) - 1), #element " and its layout differ in size");
TALUS_BUFFERS(X)
#undef X
static_assert(std::is_standard_layout_v<Parameters> && alignof(Parameters) == 4);

TEST(Records, have_the_layout_that_the_table_of_buffers_says) {
    const std::map<std::string, Record> known = records();
    for (std::size_t i = 0; i < k_buffers.size(); ++i) {
        const std::string record = k_buffer_records[i].record;
        const std::string expected = record == "uint" ? "u" : letters_of(known.at(record));
        EXPECT_EQ(k_buffers[i].layout, expected) << record << " of the buffer " << k_buffers[i].block;
        EXPECT_EQ(k_buffers[i].stride, 4 * expected.size()) << record;
    }
    EXPECT_EQ(sizeof(Parameters), 4 * letters_of(known.at("Parameters")).size());
}

TEST(Records, are_rows_of_sixteen_bytes) {
    for (const auto& [name, record] : records()) {
        if (name == "Pair") continue; // two words
        EXPECT_EQ(letters_of(record).size() % 4, 0u) << name;
        std::size_t word = 0;
        for (const Member& member : record) {
            if (member.letters.size() > 1) {
                EXPECT_EQ(word % 4, 0u) << name << "::" << member.name;
            }
            word += member.letters.size();
        }
    }
}

GLuint link(const std::string& source) {
    const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
    const char* text = source.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    const GLuint program = glCreateProgram();
    glAttachShader(program, shader);
    glLinkProgram(program);
    glDeleteShader(shader);
    GLint linked = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    EXPECT_EQ(linked, GL_TRUE) << source;
    return program;
}

GLint property_of(GLuint program, GLenum interface, const std::string& name, GLenum property) {
    const GLuint index = glGetProgramResourceIndex(program, interface, name.c_str());
    EXPECT_NE(index, GL_INVALID_INDEX) << name << " is not in the program";
    GLint value = -1;
    if (index != GL_INVALID_INDEX) glGetProgramResourceiv(program, interface, index, 1, &property, 1, nullptr, &value);
    return value;
}

GLenum gl_type_of(const Member& member) {
    if (member.letters == "u") return GL_UNSIGNED_INT;
    return member.letters == "f" ? GL_FLOAT : member.letters == "fff" ? GL_FLOAT_VEC3 : GL_FLOAT_VEC4;
}

TEST_P(GlKernels, find_each_member_where_cpp_has_it) {
    const std::string head = "#version 450 core\n#define inline\nlayout(local_size_x = 1) in;\n" +
                             text_of(k_source_folder / "state/constants.shared.glsl") +
                             text_of(k_source_folder / "state/records.shared.glsl");
    for (const auto& [name, record] : records()) {
        SCOPED_TRACE(name);
        const bool uniform = name == "Parameters";
        const GLenum interface = uniform ? GL_UNIFORM : GL_BUFFER_VARIABLE;
        const std::string first = record.front().name, prefix = uniform ? "Block.record." : "records[0].";
        const GLuint program = link(uniform ? head +
                                                  "layout(std140) uniform Block { Parameters record; } block;\n"
                                                  "layout(std430) buffer Target { vec3 target; };\n"
                                                  "void main() { target = block.record." +
                                                  first + "; }\n"
                                            : head + "layout(std430) buffer Block { " + name +
                                                  " records[]; };\n"
                                                  "void main() { records[0]." +
                                                  first + " = records[1]." + first + "; }\n");
        std::size_t offset = 0;
        for (const Member& member : record) {
            const std::string path = prefix + member.name;
            EXPECT_EQ(property_of(program, interface, path, GL_OFFSET), static_cast<GLint>(offset)) << path;
            EXPECT_EQ(static_cast<GLenum>(property_of(program, interface, path, GL_TYPE)), gl_type_of(member)) << path;
            offset += 4 * member.letters.size();
        }
        if (uniform) {
            EXPECT_EQ(property_of(program, GL_UNIFORM_BLOCK, "Block", GL_BUFFER_DATA_SIZE), static_cast<GLint>(offset));
        } else {
            EXPECT_EQ(property_of(program, interface, prefix + first, GL_TOP_LEVEL_ARRAY_STRIDE),
                      static_cast<GLint>(offset));
        }
        glDeleteProgram(program);
    }
}

TEST(Records, in_blocks_lie_cell_by_cell) {
    constexpr std::size_t k_record_bytes = 48, k_cell = 16;
    std::vector<std::byte> records(k_record_bytes * 70);
    for (std::size_t i = 0; i < records.size(); ++i)
        records[i] = static_cast<std::byte>(i / k_cell % 251);
    const std::vector<std::byte> blocks = in_blocks(records, k_record_bytes);
    ASSERT_EQ(blocks.size(), k_record_bytes * 96) << "whole blocks of 32";
    const auto cell_at = [&](std::size_t block, std::size_t cell, std::size_t record) {
        return blocks[((block * 3 + cell) * 32 + record) * k_cell];
    };
    EXPECT_EQ(cell_at(0, 0, 0), records[0]);
    EXPECT_EQ(cell_at(0, 2, 31), records[31 * k_record_bytes + 2 * k_cell]);
    EXPECT_EQ(cell_at(2, 1, 5), records[69 * k_record_bytes + k_cell]);
    EXPECT_EQ(cell_at(2, 1, 6), std::byte{0}) << "there is no such record";
    for (const std::size_t bytes : {records.size(), std::size_t{100}, std::size_t{4}}) {
        std::vector<std::byte> back(bytes);
        out_of_blocks(blocks, k_record_bytes, back);
        EXPECT_TRUE(std::equal(back.begin(), back.end(), records.begin())) << bytes << " bytes";
    }
}

INSTANTIATE_TEST_SUITE_P(Devices, GlKernels, testing::Values(DeviceKind::Gpu),
                         [](const auto& test) { return tests::name_of(test.param); });

} // namespace
} // namespace talus::engine
