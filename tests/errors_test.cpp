// SPDX-License-Identifier: MIT
// Everything that a world refuses: the message names what was wrong and what is allowed, and the world is as before.
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "tests/bodies.h"
#include "tests/devices.h"

namespace talus::tests {
namespace {

constexpr float k_nan = std::numeric_limits<float>::quiet_NaN();
constexpr float k_infinity = std::numeric_limits<float>::infinity();

/// A call that must fail, and words that its message must hold.
struct Refusal {
    std::vector<std::string> words;
    std::function<void()> call;
};

class Errors : public OnDevice {
protected:
    void SetUp() override {
        OnDevice::SetUp();
        if (IsSkipped()) return;
        world.emplace(make_world());
        floor = world->add(ground());
        box = world->add(box_at({0.0f, 0.5f, 0.0f}));
        BodyDefinition moving = box_at({5.0f, 0.0f, 0.0f});
        moving.kind = BodyKind::Kinematic;
        platform = world->add(moving);
        gone = world->add(box_at({9.0f, 9.0f, 9.0f}));
        world->remove(gone);
        world->step(3);
    }

    void expect_refused(const std::vector<Refusal>& refusals) {
        const std::uint64_t before = world->state_hash();
        const std::size_t count = world->body_count();
        for (const Refusal& refusal : refusals) {
            const std::string message = error_of(refusal.call);
            for (const std::string& word : refusal.words)
                EXPECT_NE(message.find(word), std::string::npos) << "'" << word << "' is missing in: " << message;
            EXPECT_EQ(world->state_hash(), before) << message;
            EXPECT_EQ(world->body_count(), count) << message;
        }
        // Nothing of what was refused waits for the next step either.
        World same = make_world();
        same.add(ground());
        same.add(box_at({0.0f, 0.5f, 0.0f}));
        BodyDefinition moving = box_at({5.0f, 0.0f, 0.0f});
        moving.kind = BodyKind::Kinematic;
        same.add(moving);
        same.step(3);
        same.step(2);
        world->step(2);
        EXPECT_EQ(world->state_hash(), same.state_hash());
    }

    /// A definition with one thing wrong in it.
    Refusal bad_body(std::vector<std::string> words, const std::function<void(BodyDefinition&)>& spoil) {
        words.emplace_back("add");
        return {words, [this, spoil] {
                    BodyDefinition definition = box_at({0.0f, 5.0f, 0.0f});
                    spoil(definition);
                    world->add(definition);
                }};
    }

    Refusal bad_settings(std::vector<std::string> words, const std::function<void(Settings&)>& spoil) {
        words.emplace_back("settings");
        return {words, [this, spoil] {
                    Settings settings = world->settings();
                    spoil(settings);
                    world->set_settings(settings);
                }};
    }

    std::optional<World> world;
    BodyId floor, box, platform, gone;
};

TEST_P(Errors, bodies_that_cannot_be_are_refused) {
    using D = BodyDefinition;
    expect_refused({
        bad_body({"position.x", "nan"}, [](D& d) { d.pose.position.x = k_nan; }),
        bad_body({"position.y", "inf"}, [](D& d) { d.pose.position.y = k_infinity; }),
        bad_body({"position.z", "-1000000 to 1000000"}, [](D& d) { d.pose.position.z = 2.0e6f; }),
        bad_body({"rotation", "unit quaternion"},
                 [](D& d) {
                     d.pose.rotation = {0, 0, 0, 0};
                 }),
        bad_body({"rotation", "unit quaternion"},
                 [](D& d) {
                     d.pose.rotation = {0, 0, 0, 2};
                 }),
        bad_body({"rotation", "unit quaternion"}, [](D& d) { d.pose.rotation.x = k_nan; }),
        bad_body({"size.x", "0"},
                 [](D& d) {
                     d.shape = Box{{0.0f, 1.0f, 1.0f}};
                 }),
        bad_body({"size.y", "-1"},
                 [](D& d) {
                     d.shape = Box{{1.0f, -1.0f, 1.0f}};
                 }),
        bad_body({"size.z", "nan"},
                 [](D& d) {
                     d.shape = Box{{1.0f, 1.0f, k_nan}};
                 }),
        bad_body({"radius", "0"}, [](D& d) { d.shape = Sphere{0.0f}; }),
        bad_body({"radius", "inf"}, [](D& d) { d.shape = Sphere{k_infinity}; }),
        bad_body({"mass", "allowed is 1e-30"}, [](D& d) { d.mass = 0.0f; }),
        bad_body({"mass", "allowed is 1e-30"}, [](D& d) { d.mass = -3.0f; }),
        bad_body({"mass", "nan"}, [](D& d) { d.mass = k_nan; }),
        bad_body({"mass", "inf"}, [](D& d) { d.mass = k_infinity; }),
        bad_body({"mass", "allowed is 1e-30"}, [](D& d) { d.mass = 1.0e-39f; }), // its inverse is infinite
        bad_body({"density", "allowed is 1e-30"}, [](D& d) { d.density = 0.0f; }),
        bad_body({"inertia.y", "allowed is 1e-30"},
                 [](D& d) {
                     d.inertia = Vec3{1.0f, 0.0f, 1.0f};
                 }),
        bad_body({"inertia.z", "nan"},
                 [](D& d) {
                     d.inertia = Vec3{1.0f, 1.0f, k_nan};
                 }),
        bad_body({"linear velocity.x", "finite"}, [](D& d) { d.velocity.linear.x = k_infinity; }),
        bad_body({"angular velocity.z", "finite"}, [](D& d) { d.velocity.angular.z = k_nan; }),
        bad_body({"gravity_scale", "finite"}, [](D& d) { d.gravity_scale = k_nan; }),
        bad_body({"linear_damping", "-1"}, [](D& d) { d.linear_damping = -1.0f; }),
        bad_body({"angular_damping", "nan"}, [](D& d) { d.angular_damping = k_nan; }),
        bad_body({"friction", "-0.1"}, [](D& d) { d.material.friction = -0.1f; }),
        bad_body({"restitution", "1.5", "0 to 1"}, [](D& d) { d.material.restitution = 1.5f; }),
        bad_body({"friction_combine", "9"}, [](D& d) { d.material.friction_combine = Combine{9}; }),
        bad_body({"restitution_combine", "7"}, [](D& d) { d.material.restitution_combine = Combine{7}; }),
        bad_body({"kind", "5", "Static, Rigid and Kinematic"}, [](D& d) { d.kind = BodyKind{5}; }),
        bad_body({"static", "velocity", "kinematic"},
                 [](D& d) {
                     d.kind = BodyKind::Static;
                     d.velocity.linear.x = 1.0f;
                 }),
    });
}

TEST_P(Errors, a_list_with_one_bad_body_adds_none) {
    std::vector<BodyDefinition> definitions(5, box_at({0.0f, 20.0f, 0.0f}));
    definitions[3].mass = 0.0f;
    expect_refused({{{"add", "body 3 of the list", "mass"}, [&] { world->add(definitions); }}});
}

TEST_P(Errors, a_long_list_tells_of_its_first_bad_body) {
    std::vector<BodyDefinition> definitions(30'000, box_at({0.0f, 20.0f, 0.0f}));
    definitions[29'999].mass = -1.0f;
    definitions[17'003].mass = 0.0f;
    definitions[17'004].density = 0.0f;
    const std::size_t before = world->body_count();
    expect_refused({{{"add", "body 17003 of the list", "mass"}, [&] { world->add(definitions); }}});
    EXPECT_EQ(world->body_count(), before);
}

TEST_P(Errors, ids_that_name_no_body_are_refused_by_every_call) {
    std::vector<Refusal> refusals;
    const std::vector<std::pair<BodyId, std::string>> cases{{gone, "was removed"},
                                                            {BodyId{77, 0}, "is not known"},
                                                            {BodyId{}, "is not known"},
                                                            {BodyId{box.index, 5}, "generation 5"}};
    for (const auto& bad_case : cases) {
        const auto refuse = [&](const char* call, const std::function<void(BodyId)>& use) {
            const BodyId bad = bad_case.first;
            refusals.push_back({{call, "body " + std::to_string(bad.index), bad_case.second}, [=] { use(bad); }});
        };
        refuse("remove", [this](BodyId bad) { world->remove(bad); });
        refuse("kind", [this](BodyId bad) { world->kind(bad); });
        refuse("shape", [this](BodyId bad) { world->shape(bad); });
        refuse("mass", [this](BodyId bad) { world->mass(bad); });
        refuse("inertia", [this](BodyId bad) { world->inertia(bad); });
        refuse("pose", [this](BodyId bad) { world->pose(bad); });
        refuse("set_pose", [this](BodyId bad) { world->set_pose(bad, {}); });
        refuse("velocity", [this](BodyId bad) { world->velocity(bad); });
        refuse("set_velocity", [this](BodyId bad) { world->set_velocity(bad, {}); });
        refuse("add_force", [this](BodyId bad) { world->add_force(bad, {}); });
        refuse("add_force", [this](BodyId bad) { world->add_force(bad, {}, {}); });
        refuse("add_torque", [this](BodyId bad) { world->add_torque(bad, {}); });
        refuse("add_impulse", [this](BodyId bad) { world->add_impulse(bad, {}); });
        refuse("add_impulse", [this](BodyId bad) { world->add_impulse(bad, {}, {}); });
        refuse("add_angular_impulse", [this](BodyId bad) { world->add_angular_impulse(bad, {}); });
        refuse("gravity_scale", [this](BodyId bad) { world->gravity_scale(bad); });
        refuse("set_gravity_scale", [this](BodyId bad) { world->set_gravity_scale(bad, 1.0f); });
        refuse("material", [this](BodyId bad) { world->material(bad); });
        refuse("set_material", [this](BodyId bad) { world->set_material(bad, {}); });
    }
    expect_refused(refusals);
}

TEST_P(Errors, values_that_are_no_numbers_are_refused_by_every_call) {
    const Vec3 bad{0.0f, k_nan, 0.0f}, good{0.0f, 1.0f, 0.0f};
    expect_refused({
        {{"set_pose", "body 1", "position.y"},
         [=, this] {
             world->set_pose(box, {bad, {}});
         }},
        {{"set_pose", "body 1", "rotation"},
         [=, this] {
             world->set_pose(box, {{}, {0, 0, 0, 0}});
         }},
        {{"set_velocity", "body 1", "linear velocity.y"},
         [=, this] {
             world->set_velocity(box, {bad, {}});
         }},
        {{"set_velocity", "body 1", "angular velocity.y"},
         [=, this] {
             world->set_velocity(box, {{}, bad});
         }},
        {{"add_force", "body 1", "force.y"}, [=, this] { world->add_force(box, bad); }},
        {{"add_force", "body 1", "1000000000000"},
         [=, this] {
             world->add_force(box, {2.0e12f, 0.0f, 0.0f});
         }},
        {{"add_force", "body 1", "point.y"}, [=, this] { world->add_force(box, good, bad); }},
        {{"add_force", "body 1", "force.y"}, [=, this] { world->add_force(box, bad, good); }},
        {{"add_torque", "body 1", "torque.y"}, [=, this] { world->add_torque(box, bad); }},
        {{"add_impulse", "body 1", "impulse.y"}, [=, this] { world->add_impulse(box, bad); }},
        {{"add_impulse", "body 1", "point.y"}, [=, this] { world->add_impulse(box, good, bad); }},
        {{"add_angular_impulse", "body 1", "impulse.y"}, [=, this] { world->add_angular_impulse(box, bad); }},
        {{"set_gravity_scale", "body 1", "inf"}, [=, this] { world->set_gravity_scale(box, k_infinity); }},
        {{"set_material", "body 1", "friction"},
         [=, this] {
             world->set_material(box, {k_nan, 0.0f});
         }},
        {{"set_material", "body 1", "restitution"},
         [=, this] {
             world->set_material(box, {0.5f, -1.0f});
         }},
    });
}

TEST_P(Errors, bodies_that_forces_cannot_move_refuse_them) {
    const Vec3 push{1.0f, 0.0f, 0.0f};
    std::vector<Refusal> refusals{
        {{"set_velocity", "body 0", "static"}, [=, this] { world->set_velocity(floor, {}); }}};
    for (const auto& [id, kind] : {std::pair{floor, "static"}, std::pair{platform, "kinematic"}}) {
        const std::string body = "body " + std::to_string(id.index);
        refusals.push_back({{"add_force", body, kind}, [=, this, bad = id] { world->add_force(bad, push); }});
        refusals.push_back({{"add_force", body, kind}, [=, this, bad = id] { world->add_force(bad, push, push); }});
        refusals.push_back({{"add_torque", body, kind}, [=, this, bad = id] { world->add_torque(bad, push); }});
        refusals.push_back({{"add_impulse", body, kind}, [=, this, bad = id] { world->add_impulse(bad, push); }});
        refusals.push_back({{"add_impulse", body, kind}, [=, this, bad = id] { world->add_impulse(bad, push, push); }});
        refusals.push_back(
            {{"add_angular_impulse", body, kind}, [=, this, bad = id] { world->add_angular_impulse(bad, push); }});
    }
    expect_refused(refusals);
}

TEST_P(Errors, settings_out_of_range_are_refused) {
    using S = Settings;
    expect_refused({
        bad_settings({"gravity.y"}, [](S& s) { s.gravity.y = k_nan; }),
        bad_settings({"dt", "0"}, [](S& s) { s.dt = 0.0f; }),
        bad_settings({"dt", "-0.1"}, [](S& s) { s.dt = -0.1f; }),
        bad_settings({"dt", "nan"}, [](S& s) { s.dt = k_nan; }),
        bad_settings({"substeps", "0"}, [](S& s) { s.substeps = 0; }),
        bad_settings({"iterations", "0"}, [](S& s) { s.iterations = 0; }),
        bad_settings({"contact_hertz"}, [](S& s) { s.contact_hertz = 0.0f; }),
        bad_settings({"contact_damping_ratio"}, [](S& s) { s.contact_damping_ratio = -1.0f; }),
        bad_settings({"contact_push_speed"}, [](S& s) { s.contact_push_speed = k_infinity; }),
        bad_settings({"baumgarte", "0 to 1"}, [](S& s) { s.baumgarte = 1.5f; }),
        bad_settings({"restitution_threshold"}, [](S& s) { s.restitution_threshold = -1.0f; }),
        bad_settings({"max_linear_speed"}, [](S& s) { s.max_linear_speed = 0.0f; }),
        bad_settings({"max_angular_speed"}, [](S& s) { s.max_angular_speed = k_nan; }),
        bad_settings({"sleep_speed", "-1"}, [](S& s) { s.sleep_speed = -1.0f; }),
        bad_settings({"sleep_time", "nan"}, [](S& s) { s.sleep_time = k_nan; }),
        bad_settings({"broad_phase"}, [](S& s) { s.broad_phase = BroadPhase{4}; }),
        bad_settings({"solve_order"}, [](S& s) { s.solve_order = SolveOrder{4}; }),
        bad_settings({"stabilisation"}, [](S& s) { s.stabilisation = Stabilisation{4}; }),
    });
    EXPECT_EQ(world->settings().dt, Settings{}.dt);
}

TEST_P(Errors, a_world_is_not_made_with_bad_settings) {
    Settings settings;
    settings.substeps = 0;
    EXPECT_NE(error_of([&] { make_world(settings); }).find("substeps"), std::string::npos);
    const std::vector<std::pair<std::string, std::function<void(WorldOptions&)>>> spoilt{
        {"capacities.bodies is 4294967295; allowed is 0 (the usual room) to 16777216",
         [](WorldOptions& o) { o.capacities.bodies = UINT32_MAX; }},
        {"capacities.pairs is 1000000000; allowed", [](WorldOptions& o) { o.capacities.pairs = 1'000'000'000; }},
        {"capacities.colours is 65; allowed is 0 (the usual room) to 64",
         [](WorldOptions& o) { o.capacities.colours = 65; }},
        {"device is none of", [](WorldOptions& o) { o.device = DeviceKind{9}; }},
        {"gl_context is none of", [](WorldOptions& o) { o.gl_context = GlContext{2}; }},
    };
    for (const auto& [words, spoil] : spoilt) {
        WorldOptions bad = options_on(GetParam());
        spoil(bad);
        const std::string message = error_of([&] { const World refused({}, bad); });
        EXPECT_NE(message.find(words), std::string::npos) << "'" << words << "' is missing in: " << message;
    }
    if (GetParam() == DeviceKind::Gpu) return;
    WorldOptions options = options_on(GetParam());
    options.threads = 5'000;
    EXPECT_NE(error_of([&] { const World refused({}, options); }).find("1 to 1024"), std::string::npos);
}

TALUS_ON_EVERY_DEVICE(Errors);

} // namespace
} // namespace talus::tests
