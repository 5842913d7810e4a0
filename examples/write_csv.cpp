// SPDX-License-Identifier: MIT
// A study without a screen: boxes slide down slopes of several angles, and a table of how far goes to slope.csv.
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <vector>

#include <talus/talus.h>

int main() {
    try {
        talus::World world; // all slopes side by side in one world
        struct Run {
            float degrees;
            talus::BodyId box;
            talus::Vec3 start;
        };
        std::vector<Run> runs;
        for (int i = 0; i < 8; ++i) {
            const float degrees = 5.0f * static_cast<float>(i + 1), z = 4.0f * static_cast<float>(i);
            const float angle = degrees * std::numbers::pi_v<float> / 180.0f;
            const talus::Quat tilt{0.0f, 0.0f, std::sin(angle / 2.0f), std::cos(angle / 2.0f)};
            talus::BodyDefinition slope;
            slope.kind = talus::BodyKind::Static;
            slope.shape = talus::Box{{60.0f, 1.0f, 2.0f}};
            slope.pose = {{0.0f, 0.0f, z}, tilt};
            slope.material.friction = 0.4f;
            world.add(slope);

            talus::BodyDefinition box = slope;
            box.kind = talus::BodyKind::Rigid;
            box.shape = talus::Box{};
            box.pose.position = {-std::sin(angle), std::cos(angle), z}; // 1 m above the middle of the slope
            runs.push_back({degrees, world.add(box), box.pose.position});
        }

        std::ofstream file("slope.csv");
        file << "time_s,degrees,distance_m,speed_m_per_s\n";
        for (int frame = 1; frame <= 20; ++frame) {
            world.step(6); // a tenth of a second
            for (const Run& run : runs) {
                const talus::Vec3 now = world.pose(run.box).position, v = world.velocity(run.box).linear;
                file << 0.1 * frame << ',' << run.degrees << ',' << std::hypot(now.x - run.start.x, now.y - run.start.y)
                     << ',' << std::hypot(v.x, v.y) << '\n';
            }
        }
        file.close();
        if (!file) throw talus::Error("slope.csv cannot be written");
        std::printf("slope.csv: %zu slopes, friction holds below %.1f degrees\n", runs.size(),
                    std::atan(0.4) * 180.0 / std::numbers::pi);
    } catch (const talus::Error& error) {
        std::fprintf(stderr, "write_csv: %s\n", error.what());
        return 1;
    }
}
