// SPDX-License-Identifier: MIT
// Compiled programs on disk: found again, and never trusted. A file counts as used where it stays as it is, and as
// replaced where it does not.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

#include "device/gl/gl_context.h"
#include "device/gl/gl_program.h"
#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/environment.h"

namespace talus::tests {
namespace {

namespace fs = std::filesystem;
using engine::GlProgram;
using engine::ProgramCache;

std::string bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const fs::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

class ProgramsOnDisk : public testing::TestWithParam<DeviceKind> {
protected:
    void SetUp() override {
        TALUS_SKIP_WITHOUT(DeviceKind::Gpu);
        context = engine::OpenGlContext::own();
        context->make_current();
        fs::create_directories(home); // only now: Mesa has chosen its own folder by the same variable
        cache_home.emplace("XDG_CACHE_HOME", home.string());
        allowed.emplace("TALUS_PROGRAM_CACHE", "1");
        GLint formats = 0;
        glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
        if (formats == 0) GTEST_SKIP() << "NOT TESTED, the driver gives no programs away";
    }
    ~ProgramsOnDisk() override { fs::remove_all(home); }

    std::vector<fs::path> files() const {
        std::vector<fs::path> found;
        if (!fs::is_directory(home / "talus")) return found;
        for (const auto& entry : fs::directory_iterator(home / "talus"))
            found.push_back(entry.path());
        return found;
    }

    /// Makes the kernel's program, which must work.
    void make_program(bool wanted = true, const char* kernel = k_kernel) const {
        const ProgramCache cache(wanted);
        GlProgram program(kernel, {}, cache);
        program.finish(cache);
        GLint linked = GL_FALSE;
        glGetProgramiv(program.name(), GL_LINK_STATUS, &linked);
        EXPECT_EQ(linked, GL_TRUE);
        EXPECT_EQ(program.blocks().size(), 7u); // Counters, Poses, Velocities, Shapes, Strays, OrientedBoxes, Aabbs
        EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    }

    fs::path only_file() const {
        const std::vector<fs::path> found = files();
        EXPECT_EQ(found.size(), 1u);
        return found.empty() ? fs::path() : found.front();
    }

    /// Whether the cache holds the kernel's program: one that is not there is not found.
    bool has_program(const std::string& source) const {
        const GLuint program = ProgramCache(true).load(k_kernel, source);
        if (program != 0) glDeleteProgram(program);
        return program != 0;
    }
    bool has_program() const { return has_program(engine::kernel_source(k_kernel).text); }

    static constexpr const char* k_kernel = "broad_phase/update_aabbs";
    const fs::path home = fs::path(testing::TempDir()) / ("talus cache " + std::to_string(getpid()));
    std::optional<Variable> cache_home, allowed;
    std::unique_ptr<engine::OpenGlContext> context;
};

TEST_P(ProgramsOnDisk, are_written_once_and_found_again) {
    EXPECT_FALSE(has_program());
    make_program(); // cold
    EXPECT_TRUE(has_program());
    const auto written = fs::last_write_time(only_file());
    make_program(); // warm
    EXPECT_EQ(fs::last_write_time(only_file()), written);
}

TEST_P(ProgramsOnDisk, that_are_broken_are_ignored_and_replaced) {
    make_program();
    const fs::path file = only_file();
    const std::string good = bytes_of(file);
    ASSERT_GT(good.size(), 100u);
    std::string flipped = good, lengthened = good + "more", other_format = good;
    flipped[good.size() / 2] = static_cast<char>(flipped[good.size() / 2] ^ 4);
    const std::vector<std::pair<std::string, std::string>> broken{
        {"empty", ""},
        {"cut in the head", good.substr(0, 20)},
        {"cut in the program", good.substr(0, good.size() - 1)},
        {"longer", lengthened},
        {"one bit is another", flipped},
        {"another program's file", "#!/bin/sh\n" + std::string(200, 'x')},
    };
    for (const auto& [what, bytes] : broken) {
        SCOPED_TRACE(what);
        write_bytes(file, bytes);
        EXPECT_FALSE(has_program());
        make_program();
        EXPECT_TRUE(has_program());
        EXPECT_EQ(bytes_of(only_file()).size(), good.size());
    }
}

TEST_P(ProgramsOnDisk, of_another_source_or_kernel_do_not_count) {
    make_program();
    const std::string source = engine::kernel_source(k_kernel).text;
    EXPECT_TRUE(has_program(source));
    EXPECT_FALSE(has_program(source + "\n")); // a changed kernel
    const fs::path file = only_file();
    {
        const ProgramCache cache(true);
        GlProgram other("finish/finish_bodies", {}, cache);
        other.finish(cache);
    }
    for (const fs::path& path : files())
        if (path != file) fs::rename(path, file);
    EXPECT_FALSE(has_program(source));
    make_program();
    EXPECT_TRUE(has_program(source));
    EXPECT_EQ(files().size(), 1u);
}

TEST_P(ProgramsOnDisk, which_the_driver_refuses_are_compiled) {
    // The right key and checksum around bytes that the driver cannot have made.
    constexpr std::size_t k_checksum = 24, k_head = 48;
    make_program();
    const fs::path file = only_file();
    const std::string good = bytes_of(file);
    std::string refused = good;
    refused.replace(k_head, 64, std::string(64, '\0'));
    const std::uint64_t checksum = XXH3_64bits(refused.data() + k_head, refused.size() - k_head);
    refused.replace(k_checksum, sizeof checksum, reinterpret_cast<const char*>(&checksum), sizeof checksum);
    write_bytes(file, refused);
    EXPECT_FALSE(has_program());
    make_program();
    EXPECT_EQ(bytes_of(file).size(), good.size());
    EXPECT_TRUE(has_program());
}

TEST_P(ProgramsOnDisk, are_not_kept_where_nobody_wants_them) {
    make_program(false);
    EXPECT_TRUE(files().empty());
    {
        const Variable forbidden("TALUS_PROGRAM_CACHE", "0");
        make_program();
    }
    EXPECT_TRUE(files().empty());
    {
        const Variable relative("XDG_CACHE_HOME", "not/a/place"), nowhere("HOME", "");
        make_program();
    }
    EXPECT_FALSE(fs::exists("not"));
}

TEST_P(ProgramsOnDisk, do_without_a_folder_that_can_be_written) {
    write_bytes(home / "talus", "a file where the folder would be"); // root may write to any folder
    make_program();
    EXPECT_FALSE(has_program());
    EXPECT_TRUE(fs::is_regular_file(home / "talus"));
    fs::remove(home / "talus");
    if (geteuid() == 0) return;
    chmod(home.c_str(), 0500);
    make_program();
    chmod(home.c_str(), 0700);
    EXPECT_TRUE(files().empty());
}

TEST_P(ProgramsOnDisk, are_also_of_kernels_that_were_prepared_and_never_ran) {
    {
        World world({}, options_on(DeviceKind::Gpu));
        world.add(bodies_of("pool:boxes=5"));
        world.step(1);
    }
    // The search for pairs of the first step runs anew for all bodies.
    const auto is_of_later_steps = [](const fs::path& file) {
        return file.filename().string().starts_with("broad_phase.find_strays");
    };
    EXPECT_TRUE(std::ranges::any_of(files(), is_of_later_steps));
}

TEST_P(ProgramsOnDisk, give_worlds_the_same_bits_and_leave_no_parts) {
    std::vector<std::uint64_t> hashes;
    for (const bool wanted : {false, true, true}) {
        WorldOptions options = options_on(DeviceKind::Gpu);
        options.program_cache = wanted;
        World world({}, options);
        world.add(bodies_of("pool:boxes=5"));
        world.step(3);
        hashes.push_back(world.state_hash());
        EXPECT_EQ(files().empty(), !wanted);
    }
    EXPECT_EQ(hashes[1], hashes[0]);
    EXPECT_EQ(hashes[2], hashes[0]);
    for (const fs::path& file : files())
        EXPECT_EQ(file.filename().string().size() - file.stem().string().size(), 17u) << file; // .<16 digits>
}

INSTANTIATE_TEST_SUITE_P(Devices, ProgramsOnDisk, testing::Values(DeviceKind::Gpu), [](const auto&) { return "gl"; });

} // namespace
} // namespace talus::tests
