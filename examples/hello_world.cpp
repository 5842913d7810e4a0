// SPDX-License-Identifier: MIT
// The first program of README.md: a ball falls onto a floor and bounces.
#include <cstdio>

#include <talus/talus.h>

int main() {
    try {
        talus::World world; // on the GPU where there is one, otherwise on the CPU
        talus::BodyDefinition floor;
        floor.kind = talus::BodyKind::Static;
        floor.shape = talus::Box{{20.0f, 1.0f, 20.0f}};
        floor.pose.position = {0.0f, -0.5f, 0.0f};
        world.add(floor);

        talus::BodyDefinition sphere;
        sphere.shape = talus::Sphere{0.5f};
        sphere.pose.position = {0.0f, 5.0f, 0.0f};
        sphere.material.restitution = 0.5f;
        const talus::BodyId ball = world.add(sphere);

        for (int second = 1; second <= 3; ++second) {
            world.step(60); // 60 steps of 1/60 s
            std::printf("after %d s: %.2f m\n", second, world.pose(ball).position.y);
        }
    } catch (const talus::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
