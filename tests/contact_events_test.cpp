// SPDX-License-Identifier: MIT
// Contact events and sensors, on every device: what begins, goes on and ends is what the contacts of each step say, no
// event is lost on its way, and a sensor changes nothing.
#include <map>
#include <utility>

#include <gtest/gtest.h>

#include "tests/bodies.h"
#include "tests/devices.h"

namespace talus::tests {
namespace {

using Bodies = std::pair<std::uint32_t, std::uint32_t>;

Bodies bodies_in(const ContactEvent& event) {
    return {event.a.index, event.b.index};
}

/// Events without their points, to be compared and printed.
std::vector<std::string> words_of(const std::vector<ContactEvent>& events) {
    constexpr const char* phases[]{"begin", "persist", "end"};
    std::vector<std::string> words;
    for (const ContactEvent& event : events)
        words.push_back(std::to_string(event.step) + ": " + phases[static_cast<int>(event.phase)] + " " +
                        std::to_string(event.a.index) + " " + std::to_string(event.b.index) +
                        (event.sensor ? " sensor" : ""));
    return words;
}

BodyDefinition sensor(BodyDefinition definition, BodyKind kind = BodyKind::Static) {
    definition.kind = kind;
    definition.sensor = true;
    return definition;
}

/// Mixed bodies that fall through a sensor; one sensor moves, and two overlap.
std::vector<BodyDefinition> mixed_bodies_and_sensors() {
    std::vector<BodyDefinition> bodies = mixed_bodies();
    bodies.push_back(sensor(box_at({2.0f, 2.0f, 0.0f}, {3.0f, 1.0f, 3.0f})));
    bodies.push_back(sensor(box_at({2.0f, 3.0f, 0.0f}, {3.0f, 2.0f, 1.0f})));
    bodies.push_back(sensor(sphere_at({-4.0f, 1.0f, 0.0f}, 1.0f), BodyKind::Kinematic));
    bodies.back().velocity.linear = {2.0f, 0.0f, 0.0f};
    return bodies;
}

class ContactEvents : public OnDevice {};

TEST_P(ContactEvents, are_those_of_a_bouncing_ball) {
    World world = make_world();
    const BodyId floor = world.add(with_material(ground(), 0.5f, 0.6f));
    const BodyId ball = world.add(with_material(sphere_at({0.0f, 2.5f, 0.0f}), 0.5f, 0.6f));
    world.watch_contacts(ContactWatch::Changes);
    world.step(90);
    const std::vector<ContactEvent> events = world.take_contact_events();
    ASSERT_GE(events.size(), 4u);
    const double fall = std::sqrt(2.0 * 2.0 / 9.81), mass = static_cast<double>(world.mass(ball));
    for (std::size_t i = 0; i < events.size(); ++i) {
        const ContactEvent& event = events[i];
        EXPECT_EQ(event.phase, i % 2 == 0 ? ContactPhase::Begin : ContactPhase::End) << i;
        EXPECT_EQ(event.a, floor);
        EXPECT_EQ(event.b, ball);
        EXPECT_LT(length(event.normal - Vec3{0.0f, 1.0f, 0.0f}), 1e-6f);
        EXPECT_FALSE(event.sensor);
        EXPECT_EQ(event.points.size(), i % 2 == 0 ? 1u : 0u);
    }
    EXPECT_NEAR(static_cast<double>(events[0].step) / 60.0, fall, 0.02);
    // The first impact: m (1 + e) g t, over one step.
    EXPECT_NEAR(events[0].points[0].normal_impulse, mass * 1.6 * 9.81 * fall, 0.03 * mass * 9.81 * fall);
    EXPECT_NEAR(events[0].points[0].position.y, 0.0f, 0.15f);
    EXPECT_TRUE(world.take_contact_events().empty()) << "each is given once";
}

TEST_P(ContactEvents, follow_from_the_contacts_of_each_step) {
    World world = make_world();
    world.add(mixed_bodies_and_sensors());
    world.watch_contacts(ContactWatch::All);
    std::map<Bodies, Contact> touching;
    std::size_t begins = 0, ends = 0, sensed = 0;
    for (std::uint64_t step = 1; step <= 80; ++step) {
        world.step();
        std::map<Bodies, Contact> before = std::exchange(touching, {});
        for (const Contact& contact : world.contacts()) {
            const Bodies bodies{contact.a.index, contact.b.index};
            for (const ContactPoint& point : contact.points)
                if (point.normal_impulse > 0.0f || point.separation <= (before.contains(bodies) ? 0.005f : 0.0f))
                    touching.insert_or_assign(bodies, contact);
        }
        for (const ContactEvent& event : world.take_contact_events()) {
            const Bodies bodies = bodies_in(event);
            SCOPED_TRACE(words_of({event}).front());
            EXPECT_EQ(event.step, step);
            if (event.phase == ContactPhase::End) {
                ++ends;
                ASSERT_TRUE(before.contains(bodies));
                EXPECT_FALSE(touching.contains(bodies));
                EXPECT_EQ(event.normal, before.at(bodies).normal);
                before.erase(bodies);
                continue;
            }
            ASSERT_TRUE(touching.contains(bodies));
            EXPECT_EQ(event.phase == ContactPhase::Persist, before.erase(bodies) == 1);
            begins += event.phase == ContactPhase::Begin;
            sensed += event.sensor;
            const Contact& contact = touching.at(bodies);
            EXPECT_EQ(event.normal, contact.normal);
            EXPECT_EQ(event.sensor, contact.sensor);
            EXPECT_EQ(event.sensor, world.is_sensor(event.a) || world.is_sensor(event.b));
            ASSERT_EQ(event.points.size(), contact.points.size());
            for (std::size_t i = 0; i < contact.points.size(); ++i) {
                EXPECT_EQ(event.points[i].position, contact.points[i].position);
                EXPECT_EQ(event.points[i].separation, contact.points[i].separation);
                EXPECT_EQ(event.points[i].normal_impulse, contact.points[i].normal_impulse);
                EXPECT_TRUE(!event.sensor || event.points[i].normal_impulse == 0.0f);
            }
        }
        for (const auto& [bodies, contact] : before)
            EXPECT_TRUE(touching.contains(bodies)) << "no end of " << bodies.first << " " << bodies.second;
        ASSERT_FALSE(HasFailure());
    }
    EXPECT_GT(begins, 20u);
    EXPECT_GT(ends, 10u);
    EXPECT_GT(sensed, 20u);
}

TEST_P(ContactEvents, are_all_there_however_many_and_change_nothing) {
    // 289 boxes meet the ground in one step: more events than leave with a step at first.
    std::vector<BodyDefinition> bodies{ground()};
    for (int i = 0; i < 289; ++i)
        bodies.push_back(box_at({1.5f * static_cast<float>(i % 17), 0.6f, 1.5f * static_cast<float>(i / 17)}));
    Settings settings;
    settings.substeps = settings.max_substeps = 2;
    World watched = make_world(settings), one_by_one = make_world(settings), plain = make_world(settings);
    for (World* world : {&watched, &one_by_one, &plain})
        world->add(bodies);
    watched.watch_contacts(ContactWatch::All);
    one_by_one.watch_contacts(ContactWatch::All);
    std::vector<ContactEvent> single;
    constexpr std::uint32_t steps = 16;
    for (std::uint32_t i = 0; i < steps; ++i) {
        one_by_one.step();
        for (const ContactEvent& event : one_by_one.take_contact_events())
            single.push_back(event);
    }
    watched.step(steps); // several are on their way when the first has too many
    plain.step(steps);
    const std::vector<ContactEvent> events = watched.take_contact_events();
    EXPECT_EQ(words_of(events), words_of(single));
    EXPECT_EQ(watched.state_hash(), plain.state_hash());
    EXPECT_EQ(watched.step_count(), steps);
    EXPECT_EQ(watched.report().step, steps);
    std::map<std::uint64_t, std::size_t> counts;
    for (const ContactEvent& event : events)
        ++counts[event.step];
    EXPECT_EQ(counts[steps], 289u);
}

TEST_P(ContactEvents, have_the_same_bits_as_on_the_cpu) {
    World world = make_world(), cpu({}, options_on(DeviceKind::Cpu));
    for (World* each : {&world, &cpu}) {
        each->add(mixed_bodies_and_sensors());
        each->watch_contacts(ContactWatch::All);
        each->step(60);
    }
    const std::vector<ContactEvent> events = world.take_contact_events(), expected = cpu.take_contact_events();
    EXPECT_EQ(words_of(events), words_of(expected));
    ASSERT_EQ(events.size(), expected.size());
    for (std::size_t i = 0; i < events.size(); ++i) {
        EXPECT_EQ(events[i].normal, expected[i].normal);
        ASSERT_EQ(events[i].points.size(), expected[i].points.size());
        for (std::size_t k = 0; k < events[i].points.size(); ++k) {
            EXPECT_EQ(events[i].points[k].position, expected[i].points[k].position);
            EXPECT_EQ(events[i].points[k].normal_impulse, expected[i].points[k].normal_impulse);
        }
    }
    EXPECT_EQ(world.state_hash(), cpu.state_hash());
}

TEST_P(ContactEvents, arrive_without_waiting) {
    World world = make_world();
    world.add(ground());
    world.add(box_at({0.0f, 0.5f, 0.0f}));
    world.watch_contacts(ContactWatch::All);
    std::vector<ContactEvent> events;
    const auto take = [&](std::vector<ContactEvent> more) { events.insert(events.end(), more.begin(), more.end()); };
    for (int i = 0; i < 12; ++i) {
        world.step();
        take(world.take_finished_contact_events());
    }
    take(world.take_contact_events());
    ASSERT_EQ(events.size(), 12u);
    for (std::size_t i = 0; i < events.size(); ++i)
        EXPECT_EQ(events[i].step, i + 1);
}

TEST_P(ContactEvents, name_bodies_whose_slots_are_given_up) {
    World world = make_world();
    const BodyId floor = world.add(ground()), box = world.add(box_at({0.0f, 0.5f, 0.0f}));
    world.watch_contacts(ContactWatch::Changes);
    world.step(3);
    world.remove(box); // the last one
    world.step(3);
    const std::vector<ContactEvent> events = world.take_contact_events();
    ASSERT_EQ(words_of(events), (std::vector<std::string>{"1: begin 0 1", "4: end 0 1"}));
    EXPECT_EQ(events[1].a, floor);
    EXPECT_EQ(events[1].b, box);
}

TEST_P(ContactEvents, end_where_a_body_is_removed_and_name_it) {
    World world = make_world();
    const BodyId floor = world.add(ground()), box = world.add(box_at({0.0f, 0.5f, 0.0f}));
    world.watch_contacts(ContactWatch::Changes);
    world.step(3);
    world.remove(box);
    world.step(2);
    const BodyId next = world.add(box_at({0.0f, 0.5f, 0.0f}));
    ASSERT_EQ(next.index, box.index) << "the slot is used again";
    world.step();
    const std::vector<ContactEvent> events = world.take_contact_events();
    EXPECT_EQ(words_of(events), (std::vector<std::string>{"1: begin 0 1", "4: end 0 1", "6: begin 0 1"}));
    ASSERT_EQ(events.size(), 3u);
    EXPECT_EQ(events[0].a, floor);
    EXPECT_EQ(events[0].b, box);
    EXPECT_EQ(events[1].b, box);
    EXPECT_EQ(events[2].b, next);
}

TEST_P(ContactEvents, come_while_they_are_watched) {
    World world = make_world();
    world.add(ground());
    const BodyId box = world.add(box_at({0.0f, 0.5f, 0.0f}));
    world.step(3);
    EXPECT_TRUE(world.take_contact_events().empty());
    world.watch_contacts(ContactWatch::All);
    world.step(2);
    world.watch_contacts(ContactWatch::Changes);
    world.step(2);
    world.watch_contacts(ContactWatch::None);
    world.set_pose(box, {{0.0f, 5.0f, 0.0f}, {}});
    world.step(2);
    world.watch_contacts(ContactWatch::Changes); // what was seen before is forgotten
    world.step(2);
    EXPECT_EQ(words_of(world.take_contact_events()), (std::vector<std::string>{"4: begin 0 1", "5: persist 0 1"}));
    EXPECT_NE(error_of([&] { world.watch_contacts(static_cast<ContactWatch>(7)); }).find("None, Changes and All"),
              std::string::npos);
}

TEST_P(ContactEvents, go_on_from_a_world_that_was_brought_back) {
    World world = make_world();
    world.add(mixed_bodies_and_sensors());
    world.watch_contacts(ContactWatch::Changes);
    world.step(30);
    const Snapshot before = world.snapshot();
    const std::vector<Contact> contacts = world.contacts();
    world.take_contact_events();
    world.step(15);
    const std::vector<std::string> events = words_of(world.take_contact_events());
    EXPECT_GT(events.size(), 5u);
    world.restore(before);
    const std::vector<Contact> again = world.contacts();
    ASSERT_EQ(again.size(), contacts.size());
    for (std::size_t i = 0; i < contacts.size(); ++i) {
        EXPECT_EQ(again[i].sensor, contacts[i].sensor);
        ASSERT_EQ(again[i].points.size(), contacts[i].points.size());
        for (std::size_t k = 0; k < contacts[i].points.size(); ++k)
            EXPECT_EQ(again[i].points[k].normal_impulse, contacts[i].points[k].normal_impulse);
    }
    world.step(15);
    EXPECT_EQ(words_of(world.take_contact_events()), events);
}

// ---- sensors ----

TEST_P(ContactEvents, of_sensors_tell_who_is_inside_and_nobody_is_pushed) {
    World world = make_world(), without = make_world();
    for (World* each : {&world, &without})
        each->add(sphere_at({0.0f, 4.0f, 0.0f}));
    const BodyId zone = world.add(sensor(box_at({0.0f, 1.5f, 0.0f}, {2.0f, 2.0f, 2.0f})));
    EXPECT_TRUE(world.is_sensor(zone));
    world.watch_contacts(ContactWatch::Changes);
    world.step(90);
    without.step(90);
    EXPECT_EQ(world.poses().front(), without.poses().front());
    EXPECT_EQ(world.report().manifolds, 0u);
    const std::vector<ContactEvent> events = world.take_contact_events();
    ASSERT_EQ(words_of(events).size(), 2u);
    EXPECT_TRUE(events[0].sensor && events[1].sensor);
    // From 4 m the ball's lower end enters at 2.5 m, its upper end leaves at 0.5 m.
    EXPECT_NEAR(static_cast<double>(events[0].step) / 60.0, std::sqrt(2.0 * 1.0 / 9.81), 0.035);
    EXPECT_NEAR(static_cast<double>(events[1].step) / 60.0, std::sqrt(2.0 * 4.0 / 9.81), 0.035);
}

TEST_P(ContactEvents, of_sensors_are_with_what_moves_and_is_no_sensor) {
    World world = make_world(weightless());
    world.add(sensor(box_at({})));                                          // 0
    world.add(box_at({}, {0.5f, 0.5f, 0.5f}, BodyKind::Static));            // 1: neither moves
    world.add(box_at({}, {0.6f, 0.6f, 0.6f}, BodyKind::Kinematic));         // 2
    world.add(sensor(box_at({}, {0.7f, 0.7f, 0.7f}), BodyKind::Kinematic)); // 3: sees 1 and 2
    world.watch_contacts(ContactWatch::Changes);
    world.step(2);
    EXPECT_EQ(words_of(world.take_contact_events()),
              (std::vector<std::string>{"1: begin 0 2 sensor", "1: begin 1 3 sensor", "1: begin 2 3 sensor"}));
}

TEST_P(ContactEvents, in_a_large_world_are_those_of_a_small_one) {
    const auto events_among = [this](std::size_t others) {
        World world = make_world();
        world.add(mixed_bodies_and_sensors());
        std::vector<BodyDefinition> far(others, box_at({0.0f, 900.0f, 0.0f}, {1.0f, 1.0f, 1.0f}, BodyKind::Static));
        world.add(far);
        world.watch_contacts(ContactWatch::All);
        world.step(3);
        return words_of(world.take_contact_events());
    };
    const std::vector<std::string> small = events_among(1), large = events_among(1'100);
    EXPECT_GT(small.size(), 10u);
    EXPECT_EQ(small, large);
}

TEST_P(ContactEvents, of_a_body_change_as_it_becomes_a_sensor_also_in_a_large_world) {
    for (const std::size_t others : {0u, 1'100u}) {
        World world = make_world();
        const BodyId floor = world.add(ground());
        const BodyId box = world.add(box_at({0.0f, 0.5f, 0.0f}));
        const BodyId top = world.add(box_at({0.0f, 1.5f, 0.0f}));
        world.add(std::vector<BodyDefinition>(others, box_at({0.0f, 900.0f, 0.0f}, {1, 1, 1}, BodyKind::Static)));
        world.step(5);
        EXPECT_EQ(world.contacts().size(), 2u);
        world.set_sensor(box, true);
        world.step(6);
        EXPECT_LT(world.pose(box).position.y, 0.48f) << "it falls through the ground";
        EXPECT_LT(world.pose(top).position.y, 1.48f) << "and carries nothing";
        for (const Contact& contact : world.contacts())
            EXPECT_TRUE(contact.sensor) << contact.a.index << " " << contact.b.index;
        EXPECT_TRUE(world.contains(floor));
    }
}

TEST_P(ContactEvents, of_a_body_change_as_it_becomes_a_sensor) {
    World world = make_world();
    world.add(ground());
    const BodyId box = world.add(box_at({0.0f, 0.5f, 0.0f}));
    const BodyId top = world.add(box_at({0.0f, 1.5f, 0.0f}));
    world.step(10);
    world.set_sensor(box, true);
    world.step(6);
    EXPECT_LT(world.pose(box).position.y, 0.48f) << "it falls through the ground";
    EXPECT_LT(world.pose(top).position.y, 1.48f) << "and carries nothing";
    for (const Contact& contact : world.contacts())
        EXPECT_EQ(contact.sensor, contact.a == box || contact.b == box);
    world.set_sensor(box, false);
    world.set_pose(box, {{0.0f, 0.5f, 3.0f}, {}});
    world.set_velocity(box, {});
    world.step(10);
    EXPECT_NEAR(world.pose(box).position.y, 0.5f, 2e-3f);
}

TEST_P(ContactEvents, of_a_world_that_is_emptied_end_once) {
    World world = make_world(), other = make_world();
    const auto fill = [](World& each) {
        for (const BodyDefinition& body : {ground(), box_at({0.0f, 0.5f, 0.0f}), box_at({0.0f, 1.5f, 0.0f})})
            each.add(body);
    };
    fill(world);
    world.watch_contacts(ContactWatch::Changes);
    world.step(20);
    EXPECT_EQ(world.take_contact_events().size(), 2u);
    for (const BodyId id : world.bodies())
        world.remove(id);
    std::size_t ends = 0;
    for (int i = 0; i < 5; ++i) {
        world.step();
        ends += world.take_contact_events().size();
    }
    EXPECT_EQ(ends, 2u);
    // What was there before has left nothing to those that take its place.
    fill(world);
    fill(other);
    for (int i = 0; i < 5; ++i) {
        world.step();
        other.step();
        ASSERT_EQ(world.state_hash(), other.state_hash()) << i;
    }
}

TALUS_ON_EVERY_DEVICE(ContactEvents);

} // namespace
} // namespace talus::tests
