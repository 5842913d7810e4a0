// SPDX-License-Identifier: MIT
// Uses something of each public header, so that a name that a shared library hides by mistake is missed here.
#include <cstdio>

#include <talus/talus.h>

struct Lines final : talus::DebugDraw {
    void line(talus::Vec3, talus::Vec3, const talus::Colour&) override { ++count; }
    void point(talus::Vec3, float, const talus::Colour&) override {}
    void text(talus::Vec3, std::string_view, const talus::Colour&) override {}
    int count = 0;
};

int main() {
    talus::set_log_hook({});
    talus::set_assertion_hook({});
    talus::WorldOptions options;
    options.device = talus::DeviceKind::Cpu;
    talus::World world({}, options);
    const talus::BodyId box = world.add(talus::BodyDefinition{});
    world.step(60);
    world.restore(world.snapshot());
    Lines lines;
    talus::draw_debug(world, lines);
    try {
        world.remove({});
    } catch (const talus::Error&) { // its type has to be the library's own
        std::printf("talus %s: %.3f m, %zu stages, %d lines\n", talus::version(), world.pose(box).position.y,
                    talus::stage_names().size(), lines.count);
    }
    try {
        talus::RecordingReader("/none/such");
    } catch (const talus::Error& error) {
        std::printf("%s\n", error.what());
    }
    return talus::list_devices().empty() ? 1 : 0;
}
