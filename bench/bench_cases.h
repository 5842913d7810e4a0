// SPDX-License-Identifier: MIT
// Which scenes run on which devices.
#pragma once

#include <string>
#include <vector>

#include <talus/world.h>

#include "bench/bench_options.h"

namespace talus::bench {

struct Case {
    std::string scene; ///< as Scene::name has it
    DeviceKind device = DeviceKind::Cpu;
};

/// What the devices that were asked for turn out to be, each once. Throws Error where one cannot be had.
std::vector<DeviceInfo> find_devices(const BenchOptions&);

/// Scene by scene. Throws Error for a scene that cannot be made.
std::vector<Case> make_cases(const BenchOptions&, const std::vector<DeviceInfo>& devices);

} // namespace talus::bench
