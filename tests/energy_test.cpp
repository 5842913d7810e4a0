// SPDX-License-Identifier: MIT
// Contacts take energy or keep it, and never give any. Each scene runs, and at no time may kinetic and potential energy
// together be more than a thousandth above what they were at the start. The potential is zero at y = 0, the ground.
#include <functional>
#include <ostream>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/mechanics.h"

namespace talus::tests {
namespace {

std::vector<BodyDefinition> pyramid_that_falls() {
    std::vector<BodyDefinition> bodies = bodies_of("pyramid:base=8");
    for (BodyDefinition& body : bodies)
        if (body.kind == BodyKind::Rigid) body.pose.position.y += 0.2f;
    return bodies;
}

/// Hubs among what lands.
std::vector<BodyDefinition> plates_that_fall() {
    std::vector<BodyDefinition> bodies = two_plates(7);
    for (std::size_t i = 1; i < bodies.size(); ++i)
        bodies[i].pose.position.y *= 1.3f;
    return bodies;
}

/// Two cards that lean against each other and a third that lies on top.
std::vector<BodyDefinition> cards() {
    constexpr float k_lean = 0.3f;
    const Vec3 size{0.1f, 2.0f, 1.2f};
    // Half the height and half the width of a leaning card.
    const float rise = std::cos(k_lean) + 0.05f * std::sin(k_lean), half = std::sin(k_lean) + 0.05f * std::cos(k_lean);
    std::vector<BodyDefinition> bodies{with_material(ground(), 0.6f)};
    for (const float side : {-1.0f, 1.0f}) {
        BodyDefinition card = with_material(box_at({side * half, rise, 0.0f}, size), 0.6f);
        card.pose.rotation = turn({0.0f, 0.0f, 1.0f}, side * k_lean);
        bodies.push_back(card);
    }
    bodies.push_back(with_material(box_at({0.0f, 2.0f * rise + 0.05f, 0.0f}, {2.0f, 0.1f, 1.2f}), 0.6f));
    return bodies;
}

std::vector<BodyDefinition> cards_that_slip() {
    std::vector<BodyDefinition> bodies = cards();
    for (BodyDefinition& body : bodies)
        body.material.friction = 0.1f;
    return bodies;
}

std::vector<BodyDefinition> boxes_thrown_at_each_other(float restitution) {
    std::vector<BodyDefinition> bodies;
    for (int i = 0; i < 12; ++i) {
        const float angle = 0.5236f * static_cast<float>(i), height = 0.4f * static_cast<float>(i % 3) - 0.4f;
        const Vec3 out{std::cos(angle), 0.0f, std::sin(angle)};
        BodyDefinition body =
            box_at(out * 5.0f + Vec3{0.0f, height, 0.0f}, {1.0f, 0.5f + 0.1f * static_cast<float>(i), 0.8f});
        body.velocity = {out * -4.0f, {3.0f, -2.0f * height, static_cast<float>(i % 5)}};
        bodies.push_back(with_material(body, 0.5f, restitution));
    }
    return bodies;
}

/// 27 bouncing spheres in a closed room of 5 m.
std::vector<BodyDefinition> gas() {
    std::vector<BodyDefinition> bodies;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-3.5f, 3.5f}) {
            const Vec3 place{axis == 0 ? side : 0.0f, axis == 1 ? side : 0.0f, axis == 2 ? side : 0.0f};
            const Vec3 size{axis == 0 ? 2.0f : 9.0f, axis == 1 ? 2.0f : 9.0f, axis == 2 ? 2.0f : 9.0f};
            bodies.push_back(with_material(box_at(place, size, BodyKind::Static), 0.0f, 1.0f));
        }
    }
    for (int i = 0; i < 27; ++i) {
        BodyDefinition body = with_material(
            sphere_at({1.5f * static_cast<float>(i % 3) - 1.5f, 1.5f * static_cast<float>(i / 3 % 3) - 1.5f,
                       1.5f * static_cast<float>(i / 9) - 1.5f},
                      0.4f),
            0.0f, 1.0f);
        body.velocity.linear = {3.0f - static_cast<float>(i % 7), static_cast<float>(i % 5) - 2.0f,
                                static_cast<float>(i % 4) - 1.0f};
        bodies.push_back(body);
    }
    return bodies;
}

/// The same with its floor at the zero of the potential.
std::vector<BodyDefinition> gas_above_ground() {
    std::vector<BodyDefinition> bodies = gas();
    for (BodyDefinition& body : bodies)
        body.pose.position.y += 2.5f;
    return bodies;
}

struct Case {
    const char* name;
    bool weighty;
    int steps;
    std::function<std::vector<BodyDefinition>()> bodies;

    friend std::ostream& operator<<(std::ostream& stream, const Case& c) { return stream << c.name; }
};

void expect_no_gain(World& world, const Case& scene, int look_every) {
    world.add(scene.bodies());
    const double start = mechanical_energy(world);
    double most = start;
    int when = 0;
    for (int i = 0; i < scene.steps; i += look_every) {
        world.step(static_cast<std::uint32_t>(look_every));
        if (const double energy = mechanical_energy(world); energy > most) {
            most = energy;
            when = i + look_every;
        }
    }
    EXPECT_LE(most, 1.001 * start) << "gained " << 100.0 * (most / start - 1.0) << " % by step " << when;
    EXPECT_GT(start, 0.0);
}

World world_for(const Case& scene, DeviceKind device) {
    return World(with_hubs(scene.weighty ? Settings{} : weightless()), options_on(device));
}

std::function<std::vector<BodyDefinition>()> of_scene(const char* name) {
    return [name] { return bodies_of(name); };
}

const Case k_cases[] = {
    {"stack", true, 600, of_scene("stack:height=10")},
    {"pyramid", true, 600, of_scene("pyramid:base=10")},
    {"pyramid_that_falls", true, 300, pyramid_that_falls},
    {"pool", true, 600, of_scene("pool:boxes=150")},
    {"pile", true, 300, of_scene("pile:boxes=150")},
    {"rubble", true, 300, of_scene("rubble:boxes=150")},
    {"tower", true, 300, of_scene("stack:height=60")},
    {"extreme_stack", true, 120, of_scene("extreme_stack:height=14")},
    {"wall", true, 300, of_scene("wall:width=10,height=8")},
    {"card_house", true, 300, of_scene("card_house")},
    {"dominoes", true, 300, of_scene("dominoes:count=30")},
    {"slope", true, 300, of_scene("slope")},
    {"plate", true, 300, of_scene("plate:boxes=50")},
    {"heavy_on_light", true, 300, of_scene("heavy_on_light:ratio=1000")},
    {"brick_gables", true, 120, of_scene("brick_gables:across=2,rows=1,base=8")},
    {"worlds", true, 300, of_scene("worlds:count=4")},
    {"plates_that_fall", true, 300, plates_that_fall},
    {"table_on_legs", true, 600, [] { return table_on_legs(8, 2); }},
    {"cards", true, 600, cards},
    {"cards_that_slip", true, 300, cards_that_slip},
    {"thrown_boxes", false, 240, [] { return boxes_thrown_at_each_other(0.0f); }},
    {"thrown_boxes_that_bounce", false, 240, [] { return boxes_thrown_at_each_other(1.0f); }},
    {"gas", false, 1200, gas},
    {"gas_with_weight", true, 1200, gas_above_ground},
};

class Energy : public testing::TestWithParam<Case> {};

TEST_P(Energy, is_never_gained) {
    World world = world_for(GetParam(), DeviceKind::Cpu);
    expect_no_gain(world, GetParam(), 1);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Energy, testing::ValuesIn(k_cases),
                         [](const auto& test) { return std::string(test.param.name); });

// ---- heavy on light ----

// The sanitizers look at accesses, not at energy, and slow the CPU's lanes a hundredfold: with them one scene in eleven
// runs, a number that shares no factor with how many values each loop has.
#ifdef __SANITIZE_ADDRESS__
constexpr int k_one_in = 11;
#else
constexpr int k_one_in = 1;
#endif

/// Boxes of 1 t side by side, `layers` of them: side × side in each.
std::vector<BodyDefinition> boxes_on_ground(int side, int layers) {
    std::vector<BodyDefinition> bodies{ground()};
    const auto place = [&](int i) { return 1.02f * (static_cast<float>(i) - 0.5f * static_cast<float>(side - 1)); };
    for (int i = 0; i < side * side * layers; ++i)
        bodies.push_back(
            box_at({place(i % side), 0.5f + static_cast<float>(i / (side * side)), place(i / side % side)}));
    return bodies;
}

/// Boxes on the ground that something heavy falls on.
struct Target {
    const char* name;
    int side, layers;
    float radius; // of the sphere that falls; 0: a box of 1 m
};

std::vector<BodyDefinition> heavy_above(const Target& target, float mass, float drop) {
    std::vector<BodyDefinition> all = boxes_on_ground(target.side, target.layers);
    const float y = static_cast<float>(target.layers) + drop;
    const float x = target.side > 1 ? 0.1f : 0.0f;
    all.push_back(weighing(target.radius > 0.0f ? sphere_at({x, y + target.radius, 0.5f * x}, target.radius)
                                                : box_at({x, y + 0.5f, 0.5f * x}),
                           mass));
    return all;
}

/// What is hit by a heavy body must not be left with its momentum, and must not be stiffer in the next step.
TEST(EnergyOfHeavyBodies, is_not_gained_when_they_fall_on_light_ones) {
    int scene = 0;
    for (const Target& target : {Target{"layer", 5, 1, 2.0f}, Target{"box", 1, 1, 2.0f}, Target{"two", 1, 2, 1.0f},
                                 Target{"three", 1, 3, 2.0f}, Target{"three under a box", 1, 3, 0.0f},
                                 Target{"six", 1, 6, 2.0f}, Target{"ten under a box", 1, 10, 0.0f}}) {
        for (const float mass : {10e3f, 33e3f, 100e3f, 1000e3f}) {
            for (const float drop : {0.1f, 1.0f, 2.0f, 5.0f, 20.0f}) {
                for (const std::uint32_t substeps : {8u, 128u}) {
                    if (scene++ % k_one_in != 0) continue;
                    SCOPED_TRACE(testing::Message() << target.name << ", " << mass << " kg from " << drop << " m, "
                                                    << substeps << " sub-steps");
                    Settings settings;
                    settings.substeps = substeps;
                    World world(settings, options_on(DeviceKind::Cpu));
                    expect_no_gain(world, {target.name, true, 180, [&] { return heavy_above(target, mass, drop); }}, 1);
                }
            }
        }
    }
}

/// A light body that is thrown to and fro between a heavy one and the ground must not drive it on by each of its
/// bounces.
TEST(EnergyOfHeavyBodies, is_not_gained_when_all_bounce) {
    int scene = 0;
    for (const Target& target : {Target{"box", 1, 1, 0.0f}, Target{"three", 1, 3, 0.0f}, Target{"square", 2, 2, 0.0f},
                                 Target{"layer", 5, 1, 2.0f}}) {
        for (const float mass : {20e3f, 100e3f, 1000e3f}) {
            for (const float drop : {0.1f, 1.0f}) {
                for (const float restitution : {0.1f, 0.3f, 0.6f, 1.0f}) {
                    if (scene++ % k_one_in != 0) continue;
                    SCOPED_TRACE(testing::Message() << target.name << ", " << mass << " kg from " << drop
                                                    << " m, restitution " << restitution);
                    World world({}, options_on(DeviceKind::Cpu));
                    const auto bodies = [&] {
                        std::vector<BodyDefinition> all = heavy_above(target, mass, drop);
                        for (BodyDefinition& body : all)
                            body.material.restitution = restitution;
                        return all;
                    };
                    expect_no_gain(world, {target.name, true, 120, bodies}, 1);
                }
            }
        }
    }
}

/// Two light boxes are no trampoline: what a thousand of them weigh stays where it has been stopped.
TEST(EnergyOfHeavyBodies, is_lost_when_light_ones_stop_them) {
    World world({}, options_on(DeviceKind::Cpu));
    std::vector<BodyDefinition> bodies = boxes_on_ground(1, 2);
    constexpr float k_drop = 2.0f;
    bodies.push_back(weighing(box_at({0.0f, 2.5f + k_drop, 0.0f}), 1000e3f));
    const BodyId heavy = world.add(bodies).back();
    const float impact = std::sqrt(2.0f * k_gravity * k_drop);
    float fastest_down = 0.0f, fastest_up = 0.0f;
    for (int i = 0; i < 240; ++i) {
        world.step();
        const float speed = world.velocity(heavy).linear.y;
        fastest_down = std::min(fastest_down, speed);
        fastest_up = std::max(fastest_up, speed);
    }
    EXPECT_NEAR(fastest_down, -impact, 0.05f * impact);
    EXPECT_LT(fastest_up, 0.15f * impact);
}

/// Islands join as the boxes meet, and get more sub-steps: contacts become stiffer while they are pressed together.
TEST(EnergyOfHeavyBodies, is_not_gained_by_columns_of_unlike_boxes_that_fall_together) {
    int scene = 0;
    for (const std::vector<float>& masses :
         {std::vector<float>{1000.0f, 100.0f, 1.0f}, {1.0f, 100.0f, 1000.0f}, {1000.0f, 1.0f}, {100.0f, 1.0f, 10.0f}}) {
        for (const int height : {3, 5, 8, 12}) {
            for (const float gap : {0.03f, 0.1f, 0.3f}) {
                for (const float top : {1e3f, 10e3f, 100e3f}) {
                    if (scene++ % k_one_in != 0) continue;
                    SCOPED_TRACE(testing::Message() << height << " boxes of " << masses[0] << ", " << masses[1]
                                                    << ".. kg, " << gap << " m apart, under " << top << " kg");
                    const auto bodies = [&] {
                        std::vector<BodyDefinition> all{ground()};
                        for (int i = 0; i < height; ++i) {
                            const float y = gap + 0.5f + (1.0f + gap) * static_cast<float>(i);
                            all.push_back(
                                weighing(box_at({0.0f, y, 0.0f}), masses[static_cast<std::size_t>(i) % masses.size()]));
                        }
                        const float y = 1.0f + gap + (1.0f + gap) * static_cast<float>(height);
                        all.push_back(weighing(box_at({0.1f, y, 0.0f}, {2.0f, 2.0f, 2.0f}), top));
                        return all;
                    };
                    World world({}, options_on(DeviceKind::Cpu));
                    expect_no_gain(world, {"column", true, 240, bodies}, 1);
                }
            }
        }
    }
}

/// A plate that lands tilted throws its far edge down on pebbles of a thousandth of its mass.
TEST(EnergyOfHeavyBodies, is_not_gained_by_a_plate_that_falls_on_pebbles) {
    int scene = 0;
    constexpr float k_pitch = 0.4f, k_thickness = 0.3f;
    for (const bool round : {false, true}) {
        for (const int side : {2, 3, 4, 5}) {
            for (const float radius : {0.03f, 0.06f, 0.09f}) {
                for (const float mass : {300.0f, 700.0f, 2500.0f}) {
                    for (const float tilt : {-0.08f, 0.11f}) {
                        if (scene++ % k_one_in != 0) continue;
                        SCOPED_TRACE(testing::Message()
                                     << mass << " kg, tilted by " << tilt << ", on " << side << " by " << side
                                     << (round ? " spheres" : " boxes") << " of radius " << radius);
                        const auto bodies = [&] {
                            const auto place = [&](int i) {
                                return k_pitch * (static_cast<float>(i) - 0.5f * static_cast<float>(side - 1));
                            };
                            std::vector<BodyDefinition> all{ground()};
                            for (int i = 0; i < side * side; ++i) {
                                const Vec3 at{place(i % side), radius, place(i / side)};
                                const float width = 2.0f * radius;
                                all.push_back(
                                    weighing(round ? sphere_at(at, radius) : box_at(at, {width, width, width}), 2.0f));
                            }
                            const float width = 1.1f * k_pitch * static_cast<float>(side);
                            const float y = 2.0f * radius + 0.5f * (k_thickness + width * std::abs(tilt)) + 0.3f;
                            BodyDefinition plate =
                                weighing(box_at({0.05f, y, 0.0f}, {width, k_thickness, width}), mass);
                            plate.pose.rotation = turn({0.0f, 0.0f, 1.0f}, tilt);
                            all.push_back(plate);
                            return all;
                        };
                        World world({}, options_on(DeviceKind::Cpu));
                        expect_no_gain(world, {"plate", true, 120, bodies}, 1);
                    }
                }
            }
        }
    }
}

/// Up to four layers of boxes and spheres of 0.3 kg to 3 t, on which one to three blocks of 10 to 10,000 times as much
/// fall.
std::vector<BodyDefinition> crushed(std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto number = [&](float from, float to) { // the same on every standard library
        return from + (to - from) * static_cast<float>(random() % 100'000) / 100'000.0f;
    };
    std::vector<BodyDefinition> bodies{ground()};
    float top = 0.0f, heaviest = 0.0f;
    for (std::uint32_t layers = 1 + random() % 4; layers > 0; --layers) {
        const int rows = 1 + static_cast<int>(random() % 3), columns = 1 + static_cast<int>(random() % 3);
        for (int i = 0; i < rows * columns; ++i) {
            const Vec3 size{number(0.3f, 0.98f), number(0.3f, 1.0f), number(0.3f, 0.98f)};
            const Vec3 place{static_cast<float>(i % rows), top + 0.5f * size.y, static_cast<float>(i / rows)};
            const float mass = 0.3f * std::pow(10.0f, number(0.0f, 4.0f));
            const bool is_round = random() % 3 == 0;
            bodies.push_back(weighing(is_round ? sphere_at(place, 0.15f) : box_at(place, size), mass));
            heaviest = std::max(heaviest, mass);
        }
        top += 1.0f;
    }
    for (std::uint32_t blocks = 1 + random() % 3; blocks > 0; --blocks) {
        const Vec3 size{number(0.5f, 3.0f), number(0.5f, 3.0f), number(0.5f, 3.0f)};
        const float reach = 0.5f * length(size);
        top += number(0.0f, 1.0f) + reach;
        BodyDefinition block = box_at({number(-0.7f, 1.7f), top, number(-0.7f, 1.7f)}, size);
        block.pose.rotation = turn({0.6f, 0.0f, 0.8f}, number(0.0f, 3.0f));
        block.velocity.linear = {number(-1.0f, 1.0f), number(-6.0f, 0.0f), number(-1.0f, 1.0f)};
        bodies.push_back(weighing(block, heaviest * std::pow(10.0f, number(1.0f, 4.0f))));
        top += reach;
    }
    return bodies;
}

/// What buckles and slips out under a heavy block must not be faster than the block can throw it.
TEST(EnergyOfHeavyBodies, is_not_gained_by_what_blocks_crush) {
    for (std::uint32_t seed = 0; seed < 300; ++seed) {
        if (seed % k_one_in != 0) continue;
        SCOPED_TRACE(testing::Message() << "seed " << seed);
        World world({}, options_on(DeviceKind::Cpu));
        expect_no_gain(world, {"crushed", true, 150, [&] { return crushed(seed); }}, 1);
        EXPECT_EQ(world.report().frozen_bodies, 0u);
    }
}

TEST(EnergyOfHeavyBodies, is_not_gained_by_a_tilted_table_that_falls) {
    int scene = 0;
    for (const float angle : {0.1f, 0.3f, 0.6f}) {
        for (const float drop : {1.0f, 8.0f}) {
            if (scene++ % k_one_in != 0) continue;
            SCOPED_TRACE(testing::Message() << angle << " rad, " << drop << " m");
            const auto bodies = [&] {
                std::vector<BodyDefinition> all = table_on_legs(8, 2);
                const Quat tilt = turn({0.0f, 0.0f, 1.0f}, angle);
                for (std::size_t i = 1; i < all.size(); ++i) {
                    all[i].pose.position = rotated(tilt, all[i].pose.position) + Vec3{0.0f, 1.0f + drop, 0.0f};
                    all[i].pose.rotation = tilt;
                }
                return all;
            };
            World world({}, options_on(DeviceKind::Cpu)); // without hubs
            expect_no_gain(world, {"table", true, 240, bodies}, 1);
        }
    }
}

class EnergyOnDevices : public OnDevice {};

TEST_P(EnergyOnDevices, is_never_gained_by_thrown_boxes) {
    World world = make_world(weightless());
    expect_no_gain(world, {"thrown", false, 120, [] { return boxes_thrown_at_each_other(0.5f); }}, 4);
}

TALUS_ON_EVERY_DEVICE(EnergyOnDevices);

} // namespace
} // namespace talus::tests
