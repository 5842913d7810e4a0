// SPDX-License-Identifier: MIT
// Debug drawing by whatever the program draws with: here lines of an SVG file, seen along the z axis.
#include <cstdio>
#include <fstream>

#include <talus/talus.h>

namespace {

class SvgDraw final : public talus::DebugDraw {
public:
    explicit SvgDraw(const char* path) : file(path) {
        file << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='-3 -5 6 6' width='600' height='600'>\n"
             << "<rect x='-3' y='-5' width='6' height='6' fill='#202020'/>\n";
    }
    void line(talus::Vec3 from, talus::Vec3 to, const talus::Colour& colour) override {
        file << "<line x1='" << from.x << "' y1='" << -from.y << "' x2='" << to.x << "' y2='" << -to.y << "' stroke='"
             << rgb(colour) << "' stroke-width='0.015'/>\n";
    }
    void point(talus::Vec3 position, float size, const talus::Colour& colour) override {
        file << "<circle cx='" << position.x << "' cy='" << -position.y << "' r='" << size / 200.0f << "' fill='"
             << rgb(colour) << "'/>\n";
    }
    void text(talus::Vec3 position, std::string_view text, const talus::Colour& colour) override {
        file << "<text x='" << position.x << "' y='" << -position.y << "' font-size='0.2' fill='" << rgb(colour) << "'>"
             << text << "</text>\n";
    }
    void finish() {
        file << "</svg>\n";
        file.close();
        if (!file) throw talus::Error("debug_draw.svg cannot be written");
    }

private:
    static std::string rgb(const talus::Colour& colour) {
        const auto percent = [](float part) { return std::to_string(static_cast<int>(100.0f * part)) + "%"; };
        return "rgb(" + percent(colour.red) + "," + percent(colour.green) + "," + percent(colour.blue) + ")";
    }
    std::ofstream file;
};

} // namespace

int main() {
    try {
        talus::World world;
        talus::BodyDefinition body;
        body.kind = talus::BodyKind::Static;
        body.shape = talus::Box{{5.0f, 0.5f, 2.0f}};
        body.pose.position = {0.0f, -0.25f, 0.0f};
        world.add(body);
        body.kind = talus::BodyKind::Rigid;
        body.shape = talus::Box{};
        for (int i = 0; i < 3; ++i) {
            body.pose.position = {0.2f * static_cast<float>(i), 0.5f + static_cast<float>(i), 0.0f};
            world.add(body);
        }
        body.shape = talus::Sphere{0.4f};
        body.pose.position = {-1.5f, 2.0f, 0.0f};
        world.add(body);
        world.step(45);

        SvgDraw svg("debug_draw.svg");
        talus::DebugDrawOptions options;
        options.indices = options.velocities = true;
        talus::draw_debug(world, svg, options);
        svg.finish();
    } catch (const talus::Error& error) {
        std::fprintf(stderr, "debug_draw: %s\n", error.what());
        return 1;
    }
}
