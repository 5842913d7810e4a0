// SPDX-License-Identifier: MIT
// What Talus says to the log, and what happens where an assertion fails.
#include <string>
#include <utility>
#include <vector>

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "device/device.h"
#include "log.h"
#include "tests/bodies.h"
#include "tests/devices.h"

namespace talus::tests {
namespace {

class Log : public OnDevice {
protected:
    Log() {
        set_log_hook([this](LogLevel level, std::string_view message) { messages.emplace_back(level, message); });
    }
    ~Log() override {
        set_log_hook({});
        set_assertion_hook({});
    }
    std::size_t count(LogLevel level, const std::string& part) const {
        std::size_t found = 0;
        for (const auto& [its_level, message] : messages)
            found += its_level == level && message.find(part) != std::string::npos;
        return found;
    }
    std::vector<std::pair<LogLevel, std::string>> messages;
};

TEST_P(Log, says_what_a_world_runs_on_and_when_buffers_grow) {
    WorldOptions options = options_on(GetParam());
    options.capacities = {1, 1, 1};
    messages.clear(); // of the world that showed that there is such a device
    World world({}, options);
    EXPECT_EQ(count(LogLevel::Info, "runs on " + world.device().name), 1u);
    world.add(bodies_of("stack:height=5"));
    world.step(5);
    world.wait();
    EXPECT_GT(world.report().growths, 0u);
    EXPECT_EQ(count(LogLevel::Info, "a step had "), world.report().growths);
    EXPECT_GT(count(LogLevel::Info, " pairs"), 0u);
    EXPECT_EQ(count(LogLevel::Warning, "") + count(LogLevel::Error, ""), 0u);
}

TEST_P(Log, warns_of_a_body_that_is_frozen) {
    World world = make_world();
    BodyDefinition feather = box_at({0.0f, 5.0f, 0.0f});
    feather.mass = 1.0e-12f; // 10¹² N on it overflow a float
    const BodyId wild = world.add(feather);
    for (int i = 0; i < 3; ++i) {
        world.add_force(wild, {1.0e12f, 0.0f, 1.0e12f});
        world.step();
    }
    ASSERT_EQ(world.report().frozen_bodies, 1u);
    EXPECT_EQ(count(LogLevel::Warning, "non-finite"), 1u);
    EXPECT_EQ(count(LogLevel::Warning, ""), 1u);
}

class LogOfOpenGl : public Log {};

TEST_P(LogOfOpenGl, has_the_driver_s_messages_with_the_stage_that_they_come_from) {
    WorldOptions options = options_on(GetParam());
    options.gl_debug = true;
    World world({}, options);
    world.add(bodies_of("stack:height=2"));
    world.step(2);
    world.wait();
    EXPECT_EQ(count(LogLevel::Error, "OpenGL"), 0u) << "Talus itself makes no errors";
    world.make_gl_current();
    glBindBuffer(0xdead, 0);
    EXPECT_EQ(count(LogLevel::Error, "OpenGL (between stages): "), 1u);
    glGetError();

    const auto device = engine::make_gl_device(GlContext::Own, false, true);
    device->begin_stage(engine::Stage::Solve);
    glBindBuffer(0xdead, 0);
    EXPECT_EQ(count(LogLevel::Error, "OpenGL (solve): "), 1u);
    glDebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_PERFORMANCE, 1, GL_DEBUG_SEVERITY_MEDIUM, -1,
                         "slow");
    EXPECT_EQ(count(LogLevel::Warning, "OpenGL (solve): slow"), 1u);
}

TALUS_ON_EVERY_DEVICE(Log);
INSTANTIATE_TEST_SUITE_P(Devices, LogOfOpenGl, testing::Values(DeviceKind::Gpu, DeviceKind::Hybrid),
                         [](const auto& test) { return name_of(test.param); });

class LogOfNoWorld : public Log {};

TEST_P(LogOfNoWorld, goes_to_stderr_without_a_hook_if_it_is_grave) {
    set_log_hook({});
    testing::internal::CaptureStderr();
    engine::log(LogLevel::Info, "quiet");
    engine::log(LogLevel::Warning, "loud");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "talus: loud\n");
}

struct Failed {
    std::string condition, message;
};

TEST_P(LogOfNoWorld, has_a_hook_for_assertions_that_may_throw) {
    set_assertion_hook([](const FailedAssertion& failed) {
        EXPECT_NE(std::string(failed.file).find("log_test.cpp"), std::string::npos);
        EXPECT_GT(failed.line, 0);
        throw Failed{failed.condition, std::string(failed.message)};
    });
    TALUS_ASSERT(1 + 1 == 2, "never");
    try {
        TALUS_ASSERT(messages.size() == 99, "a test wants to fail");
        FAIL() << "the assertion let it pass";
    } catch (const Failed& failed) {
        EXPECT_EQ(failed.condition, "messages.size() == 99");
        EXPECT_EQ(failed.message, "a test wants to fail");
    }
}

TEST_P(LogOfNoWorld, ends_the_program_where_an_assertion_has_no_hook) {
    set_log_hook({});
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_DEATH(TALUS_ASSERT(messages.size() == 99, "it had to hold"),
                 "talus: .*log_test.cpp:[0-9]+: it had to hold .messages.size.. == 99 does not hold.");
    EXPECT_DEATH(
        {
            set_assertion_hook([](const FailedAssertion&) {});
            TALUS_ASSERT(messages.size() == 99, "a hook that returns does not help");
        },
        "");
}

INSTANTIATE_TEST_SUITE_P(OnCpu, LogOfNoWorld, testing::Values(DeviceKind::Cpu),
                         [](const auto& test) { return name_of(test.param); });

} // namespace
} // namespace talus::tests
