// SPDX-License-Identifier: MIT
// Prints the state hash of a scene after some steps: hash_of_scene SCENE cpu|gpu|hybrid STEPS. The determinism test runs
// it, to have the OpenGL driver's settings for itself.
#include <cstdio>
#include <string>

#include "scenes/scene.h"

int main(int argc, char** argv) {
    using namespace talus;
    if (argc != 4) {
        std::fprintf(stderr, "usage: hash_of_scene SCENE cpu|gpu|hybrid STEPS\n");
        return 2;
    }
    try {
        const std::string device = argv[2];
        WorldOptions options;
        options.device = device == "gpu"   ? DeviceKind::Gpu
                         : device == "cpu" ? DeviceKind::Cpu
                                           : DeviceKind::Hybrid;
        const scenes::Scene scene = scenes::make_scene(argv[1]);
        World world(scene.settings, options);
        for (const scenes::NamedBody& body : scene.bodies)
            world.add(body.definition);
        world.step(static_cast<std::uint32_t>(std::stoul(argv[3])));
        std::printf("%016llx\n", static_cast<unsigned long long>(world.state_hash()));
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "hash_of_scene: %s\n", error.what());
        return 1;
    }
}
