// SPDX-License-Identifier: MIT
// The list for those who name no scene: seconds on any CPU, and for a real GPU also what keeps one busy.
#include "bench/bench_cases.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include <fmt/format.h>

#include "scenes/scene.h"

namespace talus::bench {
namespace {

constexpr std::array k_small_scenes{"stack", "pool:boxes=200", "extreme_stack", "pyramid", "wall", "columns:side=10"};
constexpr std::array k_large_scenes{"pool:boxes=8000", "grid",    "pile:boxes=32000",
                                    "many_pyramids",   "columns", "brick_ring"};

bool suits_large_scenes(const DeviceInfo& device) {
    return device.kind == DeviceKind::Gpu && !device.in_software;
}

/// Its name with the parameters in their one form; what is wrong with it is said before anything runs.
std::string checked_name(const std::string& specification) {
    const scenes::Scene scene = scenes::make_scene(specification);
    for (const std::string& warning : scene.warnings)
        fmt::print(stderr, "talus: {}: {}\n", scene.name, warning);
    return scene.name;
}

} // namespace

std::vector<DeviceInfo> find_devices(const BenchOptions& options) {
    std::vector<DeviceInfo> devices;
    for (const DeviceKind kind : options.devices) {
        WorldOptions world_options;
        world_options.device = kind;
        world_options.threads = options.simulation.threads;
        const DeviceInfo device = World({}, world_options).device();
        const bool known =
            std::ranges::any_of(devices, [&](const DeviceInfo& other) { return other.kind == device.kind; });
        if (!known) devices.push_back(device);
    }
    return devices;
}

std::vector<Case> make_cases(const BenchOptions& options, const std::vector<DeviceInfo>& devices) {
    std::vector<Case> cases;
    const auto add = [&](const std::string& scene, const auto& suits) {
        for (const DeviceInfo& device : devices)
            if (suits(device)) cases.push_back({scene, device.kind});
    };
    const auto any = [](const DeviceInfo&) { return true; };
    for (const std::string& scene : options.scenes)
        add(checked_name(scene), any);
    if (!options.scenes.empty()) return cases;
    for (const char* scene : k_small_scenes)
        add(checked_name(scene), any);
    if (std::ranges::none_of(devices, suits_large_scenes)) return cases;
    for (const char* scene : k_large_scenes)
        add(checked_name(scene), suits_large_scenes);
    return cases;
}

} // namespace talus::bench
