// SPDX-License-Identifier: MIT
// The library as others take it in: installed and found by CMake or pkg-config, as part of another project, and as
// Debian packages. What this build has made is installed; nothing is built again but the consumer.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

#include <talus/version.h>

#include "tests/shell.h"

namespace talus::tests {
namespace {

namespace fs = std::filesystem;

const std::string k_version = version();
const std::string k_build = TALUS_BUILD_FOLDER;
const std::string k_consumer = TALUS_SOURCE_FOLDER "/tests/consumer";
const std::string k_output = "talus " + k_version + ": -4.905 m, ";

class Package : public testing::Test {
protected:
    Package() { fs::create_directories(folder); }
    ~Package() override { fs::remove_all(folder); }
    static void SetUpTestSuite() {
        // The compiler that built this test, and with it a compiler cache where there is one.
        setenv("CXX", TALUS_COMPILER, 1);
        setenv("CMAKE_CXX_COMPILER_LAUNCHER", TALUS_COMPILER_LAUNCHER, 1);
        setenv("CMAKE_GENERATOR", "Ninja", 1);
    }

    /// The output of a command that must succeed.
    static std::string shell(const std::string& command) {
        const ShellEnding ending = run_in_shell(command);
        EXPECT_EQ(ending.status, 0) << command << "\n" << ending.output;
        return ending.output;
    }
    void install() const {
        for (const std::string component : {"library", "development"})
            shell("cmake --install '" + k_build + "' --prefix '" + prefix + "' --component " + component);
    }
    std::string library_folder() const { return prefix + "/" TALUS_LIBRARY_FOLDER; }

    /// What the consumer prints once it is built with these options.
    std::string consumer(const std::string& options) const {
        const std::string build = folder / "build";
        fs::remove_all(build);
        shell("cmake -S " + k_consumer + " -B " + build + " " + options + " && cmake --build " + build);
        return shell(build + "/consumer");
    }
    static std::string needs(const std::string& program) { return shell("readelf -d " + program + " | grep NEEDED"); }

    const fs::path folder = fs::path(testing::TempDir()) / ("talus_package_" + std::to_string(getpid()));
    const std::string prefix = folder / "installed";
};

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST_F(Package, is_found_by_cmake) {
    install();
    const std::string here = "-DWAY=find_package -DCMAKE_PREFIX_PATH=" + prefix;
    const std::string program = folder / "build/consumer";
    EXPECT_TRUE(contains(consumer(here + " -DVERSION=" + k_version), k_output));
    EXPECT_TRUE(contains(needs(program), "libtalus.so")) << "shared unless asked otherwise";
    EXPECT_TRUE(contains(consumer(here + " -DCOMPONENT=static"), k_output));
    EXPECT_FALSE(contains(needs(program), "libtalus.so"));
}

TEST_F(Package, is_refused_by_cmake_where_it_does_not_fit) {
    install();
    const std::string configure = "cmake -S " + k_consumer + " -B " + std::string(folder / "build") +
                                  " -DWAY=find_package -DCMAKE_PREFIX_PATH=" + prefix;
    const ShellEnding newer = run_in_shell(configure + " -DVERSION=99.0");
    EXPECT_NE(newer.status, 0);
    EXPECT_TRUE(contains(newer.output, "version: " + k_version)) << newer.output;
    const ShellEnding other = run_in_shell(configure + " -DVERSION=" + k_version + " -DCOMPONENT=dynamic");
    EXPECT_NE(other.status, 0);
    EXPECT_TRUE(contains(other.output, "no component 'dynamic'")) << other.output;
}

TEST_F(Package, is_found_by_pkg_config) {
    install();
    const std::string find = "PKG_CONFIG_PATH=" + library_folder() + "/pkgconfig pkg-config ";
    EXPECT_EQ(shell(find + "--modversion talus"), k_version + "\n");
    const std::string program = folder / "consumer", compile = std::string(TALUS_COMPILER) + " -std=c++20 " +
                                                               k_consumer + "/consumer.cpp -o " + program + " ";
    shell(compile + "$(" + find + "--cflags --libs talus)");
    EXPECT_TRUE(contains(shell("LD_LIBRARY_PATH=" + library_folder() + " " + program), k_output));
    shell(compile + "$(" + find + "--static --cflags --libs talus | sed 's/-ltalus/-l:libtalus.a/')");
    EXPECT_TRUE(contains(shell(program), k_output));
}

TEST_F(Package, is_part_of_another_project) {
    // That the library is built so is for readme_test.cpp to show: here the consumer alone is compiled.
    const std::string build = folder / "build";
    for (const std::string way : {"add_subdirectory", "fetch_content"}) {
        for (const std::string shared : {"ON", "OFF"}) {
            fs::remove_all(build);
            shell("cmake -S " + k_consumer + " -B " + build + " -DWAY=" + way + " -DBUILD_SHARED_LIBS=" + shared +
                  " -DTALUS_FOLDER=" TALUS_SOURCE_FOLDER);
            shell("ninja -C " + build + " CMakeFiles/consumer.dir/consumer.cpp.o");
            const std::string plan = shell("ninja -C " + build + " -t commands consumer");
            EXPECT_TRUE(contains(plan, shared == "ON" ? "libtalus.so" : "libtalus.a")) << plan;
            EXPECT_FALSE(contains(plan, "main.cpp")) << "neither the program nor tests are built";
        }
    }
}

TEST_F(Package, shows_its_public_names_alone) {
    const std::string names = shell("nm -DC --defined-only '" TALUS_SHARED_LIBRARY "'");
    std::istringstream lines(names);
    std::size_t count = 0;
    for (std::string line; std::getline(lines, line); ++count) {
        EXPECT_TRUE(contains(line, "talus::")) << line;
        EXPECT_FALSE(contains(line, "talus::engine::")) << line;
    }
    EXPECT_GT(count, 50u);
    EXPECT_TRUE(contains(shell("readelf -d '" TALUS_SHARED_LIBRARY "'"),
                         "[libtalus.so." + k_version.substr(0, k_version.rfind('.')) + "]"));
}

TEST_F(Package, is_made_for_debian_and_leaves_nothing_behind) {
    if (run_in_shell("command -v dpkg dpkg-shlibdeps file").status != 0)
        GTEST_SKIP() << "NOT TESTED, there is no dpkg, dpkg-shlibdeps (package dpkg-dev) or file here";
    const std::string debs = folder / "debs", root = folder / "root", log = folder / "dpkg.log";
    shell("cpack --config '" + k_build + "/CPackConfig.cmake' -B " + debs);
    shell("rm -rf " + debs + "/_CPack_Packages");
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(debs))
        names.push_back(entry.path().filename());
    std::ranges::sort(names);
    ASSERT_EQ(names.size(), 3u);
    EXPECT_TRUE(names[0].starts_with("libtalus-dev_" + k_version));
    EXPECT_TRUE(names[1].starts_with("libtalus0"));
    EXPECT_TRUE(names[2].starts_with("talus_" + k_version));
    EXPECT_TRUE(contains(shell("dpkg --field " + debs + "/libtalus0* Depends"), "libtbb"));

    // Into a system that has nothing else: what the packages need is there outside of it. The script of the library's
    // package calls ldconfig, which is to leave the system of the test alone.
    shell("mkdir -p " + root + "/var/lib/dpkg/info " + root + "/var/lib/dpkg/updates " + std::string(folder / "bin") +
          " && touch " + root + "/var/lib/dpkg/status");
    std::ofstream(folder / "bin/ldconfig")
        << "#!/bin/sh\necho called >>" << std::string(folder / "ldconfig.log") << "\n";
    fs::permissions(folder / "bin/ldconfig", fs::perms::owner_all);
    const std::string dpkg = "PATH=" + std::string(folder / "bin") + ":$PATH dpkg --log=" + log +
                             " --force-not-root --force-depends --force-script-chrootless --root=" + root + " ";
    shell(dpkg + "--install " + debs + "/*.deb");
    const std::string place = "-DWAY=find_package -DCMAKE_PREFIX_PATH=" + root + "/usr";
    EXPECT_TRUE(contains(consumer(place), k_output));
    EXPECT_EQ(shell(root + "/usr/bin/talus --version"), k_version + "\n");
    EXPECT_EQ(shell("cat " + std::string(folder / "ldconfig.log")), "called\n");
    shell(dpkg + "--purge talus libtalus-dev $(" + dpkg +
          "--get-selections | sed -n 's/^\\(libtalus[0-9][^:\t]*\\).*/\\1/p')");
    EXPECT_EQ(shell("find " + root + " -name '*talus*'"), "");
}

} // namespace
} // namespace talus::tests
