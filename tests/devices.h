// SPDX-License-Identifier: MIT
// Tests that run on every device: the fixture gives worlds on the device of its parameter, and skips the test aloud
// where there is no such device.
#pragma once

#include <map>
#include <string>

#include <gtest/gtest.h>

#include <talus/talus.h>

namespace talus::tests {

/// The end of a test's name; CMakeLists.txt tells by it which tests need OpenGL.
inline std::string name_of(DeviceKind kind) {
    switch (kind) {
    case DeviceKind::Gpu:
        return "gpu";
    case DeviceKind::Cpu:
        return "cpu";
    case DeviceKind::Hybrid:
        return "hybrid";
    case DeviceKind::Auto:
        break;
    }
    return "auto";
}

inline WorldOptions options_on(DeviceKind kind) {
    WorldOptions options;
    options.device = kind;
    options.threads = kind == DeviceKind::Gpu ? 0 : 2;
    options.wait_for_kernels = true; // so that a test is of the same kernels whenever it runs
    return options;
}

/// Why a device cannot be had here; empty where it can.
inline const std::string& why_not(DeviceKind kind) {
    static std::map<DeviceKind, std::string> reasons;
    const auto [entry, is_new] = reasons.try_emplace(kind);
    if (is_new) {
        try {
            const World world({}, options_on(kind));
        } catch (const Error& error) {
            entry->second = error.what();
        }
    }
    return entry->second;
}

#define TALUS_SKIP_WITHOUT(kind)                                                                                       \
    if (const std::string& reason = ::talus::tests::why_not(kind); !reason.empty())                                    \
    GTEST_SKIP() << "NOT TESTED, there is no device '" << ::talus::tests::name_of(kind) << "' here: " << reason

class OnDevice : public testing::TestWithParam<DeviceKind> {
protected:
    void SetUp() override { TALUS_SKIP_WITHOUT(GetParam()); }

    World make_world(const Settings& settings = {}) const { return World(settings, options_on(GetParam())); }
    bool has_gl() const { return GetParam() != DeviceKind::Cpu; }
};

#define TALUS_ON_EVERY_DEVICE(Suite)                                                                                   \
    INSTANTIATE_TEST_SUITE_P(Devices, Suite, testing::Values(DeviceKind::Cpu, DeviceKind::Gpu, DeviceKind::Hybrid),    \
                             [](const auto& test) { return ::talus::tests::name_of(test.param); })

/// For runs of thousands of steps: that other devices give the same bits is for determinism_test.cpp to show.
#define TALUS_ON_THE_CPU(Suite)                                                                                        \
    INSTANTIATE_TEST_SUITE_P(Devices, Suite, testing::Values(DeviceKind::Cpu),                                         \
                             [](const auto& test) { return ::talus::tests::name_of(test.param); })

/// The message of the Error that a call throws.
template <typename Call> std::string error_of(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

} // namespace talus::tests
