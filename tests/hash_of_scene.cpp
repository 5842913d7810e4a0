// SPDX-License-Identifier: MIT
// Prints the state hash of a scene after some steps on the GPU: hash_of_scene SCENE STEPS [bvh]. The determinism test
// runs it to give the OpenGL driver another environment than its own.
#include <cstdio>
#include <string>

#include "scenes/scene.h"

int main(int argc, char** argv) {
    using namespace talus;
    const bool with_tree = argc == 4 && std::string(argv[3]) == "bvh";
    if (argc != 3 && !with_tree) {
        std::fprintf(stderr, "usage: hash_of_scene SCENE STEPS [bvh]\n");
        return 2;
    }
    try {
        const scenes::Scene scene = scenes::make_scene(argv[1]);
        WorldOptions options;
        options.device = DeviceKind::Gpu;
        options.wait_for_kernels = true;
        Settings settings = scene.settings;
        if (with_tree) settings.broad_phase = BroadPhase::Bvh;
        World world(settings, options);
        for (const scenes::NamedBody& body : scene.bodies)
            world.add(body.definition);
        world.step(static_cast<std::uint32_t>(std::stoul(argv[2])));
        std::printf("%016llx\n", static_cast<unsigned long long>(world.state_hash()));
        return 0;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "hash_of_scene: %s\n", error.what());
        return 1;
    }
}
