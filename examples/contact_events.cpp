// SPDX-License-Identifier: MIT
// Game logic: a sensor counts the balls that fall through a hoop, and hard impacts make a sound.
#include <cstdio>

#include <talus/talus.h>

int main() {
    try {
        talus::World world;
        talus::BodyDefinition floor;
        floor.kind = talus::BodyKind::Static;
        floor.shape = talus::Box{{20.0f, 1.0f, 20.0f}};
        floor.pose.position = {0.0f, -0.5f, 0.0f};
        world.add(floor);

        talus::BodyDefinition hoop;
        hoop.kind = talus::BodyKind::Static;
        hoop.sensor = true; // reports, and does not push
        hoop.shape = talus::Box{{1.0f, 0.1f, 1.0f}};
        hoop.pose.position = {0.0f, 3.0f, 0.0f};
        const talus::BodyId hoop_id = world.add(hoop);

        talus::BodyDefinition ball;
        ball.shape = talus::Sphere{0.12f};
        ball.mass = 0.6f;
        ball.material.restitution = 0.7f;
        for (const float x : {-2.0f, 0.0f, 0.3f}) { // the first one misses
            ball.pose.position = {x, 4.0f, 0.0f};
            world.add(ball);
        }

        world.watch_contacts(talus::ContactWatch::Changes);
        int score = 0;
        for (int frame = 0; frame < 120; ++frame) {
            world.step();
            // Those of the steps that the device has finished: the frame does not wait for the GPU.
            const auto events = frame < 119 ? world.take_finished_contact_events() : world.take_contact_events();
            for (const talus::ContactEvent& event : events) {
                if (event.phase != talus::ContactPhase::Begin) continue;
                if (event.a == hoop_id || event.b == hoop_id)
                    std::printf("step %3d: score %d\n", static_cast<int>(event.step), ++score);
                else if (event.points.front().normal_impulse > 5.0f)
                    std::printf("step %3d: thud of %.1f N s\n", static_cast<int>(event.step),
                                event.points.front().normal_impulse);
            }
        }
    } catch (const talus::Error& error) {
        std::fprintf(stderr, "contact_events: %s\n", error.what());
        return 1;
    }
}
