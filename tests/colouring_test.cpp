// SPDX-License-Identifier: MIT
// The constraint graph: no two contacts of one colour share a body that can be pushed, the colours are the same on
// every device, they are kept from step to step, and bodies with more contacts than there are colours are solved all
// the same: as hubs, or in the overflow set. A graph that lasts over several steps is the one that each would make.
#include <map>
#include <random>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "scenes/scene.h"
#include "state/formulas.h"
#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/engine_run.h"
#include "tests/mechanics.h"

namespace talus::tests {
namespace {

using engine::BufferId;
using engine::Manifold;
using engine::uint;

using Colours = std::map<std::pair<uint, uint>, uint>; // of each pair of bodies that touch

Colours colours_of(const EngineRun& run) {
    Colours colours;
    for (const Manifold& manifold : run.manifolds())
        if (manifold.point_count > 0)
            colours[{manifold.body_a, manifold.body_b}] = manifold.colour & ~engine::k_whole_hub;
    return colours;
}

/// Of the pairs that meet a hub with its whole mass.
std::set<std::pair<uint, uint>> pairs_of_whole_hubs(const EngineRun& run) {
    std::set<std::pair<uint, uint>> pairs;
    for (const Manifold& manifold : run.manifolds())
        if (manifold.point_count > 0 && (manifold.colour & engine::k_whole_hub) != 0)
            pairs.insert({manifold.body_a, manifold.body_b});
    return pairs;
}

bool are_movable(const EngineRun& run, const std::pair<uint, uint>& bodies) {
    return engine::is_movable(run.table.shapes[bodies.first]) && engine::is_movable(run.table.shapes[bodies.second]);
}

void expect_valid(const EngineRun& run) {
    std::set<std::pair<uint, uint>> used; // body and colour
    uint given = 0, overflow = 0, of_hubs = 0, touching = 0;
    std::map<uint, uint> contacts; // of each body
    for (const auto& [bodies, colour] : colours_of(run))
        ++contacts[bodies.first], ++contacts[bodies.second];
    const uint most =
        engine::make_parameters(run.settings, run.simulation.plan_step(run.table.population())).hub_contacts;
    const auto is_hub = [&](uint body) { return engine::is_movable(run.table.shapes[body]) && contacts[body] > most; };
    const auto of_whole_hubs = pairs_of_whole_hubs(run);
    EXPECT_LT(of_whole_hubs.size(), 36u * run.counter(engine::k_counter_hub_count) + 1u);
    for (const auto& [bodies, colour] : colours_of(run)) {
        ++touching;
        ASSERT_LE(colour, engine::k_overflow_colour) << bodies.first << ", " << bodies.second;
        if (colour == engine::k_overflow_colour) {
            ++overflow;
            continue;
        }
        const bool for_hubs = colour >= engine::k_first_hub_colour;
        const bool with_hub = is_hub(bodies.first) != is_hub(bodies.second);
        EXPECT_EQ(for_hubs, with_hub && !of_whole_hubs.contains(bodies)) << bodies.first << ", " << bodies.second;
        EXPECT_TRUE(with_hub || !of_whole_hubs.contains(bodies)) << bodies.first << ", " << bodies.second;
        if (for_hubs)
            ++of_hubs;
        else
            given = std::max(given, engine::k_first_hub_colour - colour);
        for (const uint body : {bodies.first, bodies.second}) {
            if (!engine::is_movable(run.table.shapes[body]) || (for_hubs && is_hub(body))) continue;
            EXPECT_TRUE(used.insert({body, colour}).second) << "body " << body << " is twice in colour " << colour;
        }
    }
    EXPECT_EQ(run.counter(engine::k_counter_manifold_count), touching);
    EXPECT_EQ(run.counter(engine::k_counter_colour_demand), given);
    EXPECT_EQ(run.counter(engine::k_counter_overflow_count), overflow);
    EXPECT_EQ(run.counter(engine::k_counter_hub_manifolds), of_hubs);
}

/// Each contact in the colours that are solved one after the other knows its place among those of each body.
void expect_order(const EngineRun& run) {
    const Colours colours = colours_of(run);
    std::map<uint, std::set<uint>> colours_at; // of each body that can be pushed
    for (const auto& [bodies, colour] : colours)
        for (const uint body : {bodies.first, bodies.second})
            if (engine::is_movable(run.table.shapes[body]) && colour < engine::k_first_hub_colour)
                colours_at[body].insert(colour);
    const auto inertias = run.read<engine::BodyInertia>(BufferId::Inertias, run.table.slot_count());
    for (uint body = 0; body < run.table.slot_count(); ++body)
        EXPECT_EQ(engine::contacts_of_body(inertias[body].traits), colours_at[body].size()) << "body " << body;
    const auto place = [&](uint body, uint colour) {
        const std::set<uint>& its_colours = colours_at[body];
        return static_cast<uint>(std::distance(its_colours.begin(), its_colours.lower_bound(colour)));
    };
    for (const auto& c :
         run.read<engine::ContactConstraint>(BufferId::Constraints, run.counter(engine::k_counter_manifold_count))) {
        const uint colour = colours.at({c.body_a, c.body_b});
        if (colour >= engine::k_first_hub_colour) continue;
        const auto expect_place = [&](uint body, uint earlier, uint last) {
            EXPECT_EQ(engine::earlier_of(c.counts, earlier), place(body, colour)) << "colour " << colour;
            const bool is_last = engine::is_movable(run.table.shapes[body]) && colour == *colours_at[body].rbegin();
            EXPECT_EQ(engine::is_last_of(c.counts, last), is_last) << "colour " << colour;
        };
        expect_place(c.body_a, engine::k_earlier_of_a, engine::k_last_of_a);
        expect_place(c.body_b, engine::k_earlier_of_b, engine::k_last_of_b);
    }
}

struct Case {
    std::string name;
    uint steps;
};
const Case k_cases[]{{"stack", 3}, {"pyramid:base=8", 5}, {"wall:width=6,height=5", 5}, {"pool:boxes=80", 90}};

class Colouring : public OnDevice {};

TEST_P(Colouring, no_body_is_twice_in_a_colour) {
    for (const Case& c : k_cases) {
        SCOPED_TRACE(c.name);
        EngineRun run(options_on(GetParam()), bodies_of(c.name));
        run.step();
        expect_valid(run);
        run.step(c.steps);
        expect_valid(run);
    }
}

TEST_P(Colouring, contacts_know_their_place_at_a_body) {
    for (const Case& c : k_cases) {
        SCOPED_TRACE(c.name);
        EngineRun run(options_on(GetParam()), bodies_of(c.name));
        run.step(c.steps);
        expect_order(run);
        run.step(); // with the graph that lasts
        expect_order(run);
    }
}

TEST_P(Colouring, is_that_of_a_single_thread) {
    for (const Case& c : k_cases) {
        SCOPED_TRACE(c.name);
        WorldOptions serial = options_on(DeviceKind::Cpu);
        serial.threads = 1;
        EngineRun run(options_on(GetParam()), bodies_of(c.name)), expected(serial, bodies_of(c.name));
        run.step(c.steps);
        expected.step(c.steps);
        EXPECT_EQ(colours_of(run), colours_of(expected));
    }
}

TEST_P(Colouring, contacts_keep_their_colours) {
    EngineRun run(options_on(GetParam()), bodies_of("pile:boxes=1000"));
    run.step(60);
    std::size_t kept = 0, lent = 0, given_back = 0;
    for (int i = 0; i < 40; ++i) {
        const Colours before = colours_of(run);
        run.step();
        const Colours now = colours_of(run);
        std::set<uint> landed;                       // bodies with a new contact with what nothing moves
        std::map<uint, std::set<uint>> kept_colours; // of bodies
        for (const auto& [bodies, colour] : now) {
            const bool is_new = !before.contains(bodies);
            if (is_new && !are_movable(run, bodies)) landed.insert({bodies.first, bodies.second});
            if (is_new) continue;
            kept_colours[bodies.first].insert(before.at(bodies));
            kept_colours[bodies.second].insert(before.at(bodies));
        }
        const auto gives_back = [&](std::pair<uint, uint> bodies) {
            const auto has = [&](uint colour) {
                return kept_colours[bodies.first].contains(colour) || kept_colours[bodies.second].contains(colour);
            };
            return landed.contains(bodies.first) || landed.contains(bodies.second) ||
                   !has(engine::k_ground_colour - 1) || !has(engine::k_ground_colour - 2);
        };
        for (const auto& [bodies, colour] : now) {
            const auto old = before.find(bodies);
            if (old == before.end() || old->second == engine::k_overflow_colour) continue;
            const bool was_lent = old->second == engine::k_ground_colour && are_movable(run, bodies);
            if (was_lent && gives_back(bodies)) {
                ++given_back;
                continue;
            }
            EXPECT_EQ(colour, old->second);
            ++kept;
            if (was_lent) ++lent;
        }
    }
    EXPECT_GT(kept, 100u) << "the scene must have contacts that last";
    EXPECT_GT(lent, 20u) << "and some that were lent the ground's colour";
    EXPECT_GT(given_back, 0u) << "and some that give it back";
}

TEST_P(Colouring, what_lies_on_the_ground_is_solved_after_what_falls_on_it) {
    std::vector<BodyDefinition> bodies{ground(), box_at({0, 0.5f, 0}), box_at({0, 1.6f, 0})};
    EngineRun run(options_on(GetParam()), bodies);
    constexpr uint last = engine::k_ground_colour;
    run.step(5);
    ASSERT_EQ(colours_of(run), (Colours{{{0, 1}, last}}));
    run.step(20);
    EXPECT_EQ(colours_of(run), (Colours{{{0, 1}, last}, {{1, 2}, last - 1}}));
    expect_valid(run);
}

TEST_P(Colouring, of_what_stands_the_lowest_contact_is_solved_last) {
    for (const int height : {2, 3, 8}) {
        std::vector<BodyDefinition> bodies{ground()};
        for (int i = 0; i < height; ++i)
            bodies.push_back(box_at({0, 0.5f + static_cast<float>(i), 0}));
        EngineRun run(options_on(GetParam()), bodies);
        run.step();
        expect_valid(run);
        for (const auto& [pair, colour] : colours_of(run))
            EXPECT_EQ(colour == engine::k_ground_colour, pair.first == 0) << pair.first << ", " << pair.second;
        EXPECT_LE(run.counter(engine::k_counter_colour_demand), 3u) << height;
    }
}

/// A crowded box has so many contacts while it falls that one is lent the last colour.
TEST_P(Colouring, the_ground_gets_the_last_colour_back) {
    std::vector<BodyDefinition> bodies = crowded_box(0.0f, 1000.0f);
    bodies.insert(bodies.begin(), ground());
    EngineRun run(options_on(GetParam()), bodies);
    run.step();
    expect_valid(run);
    const auto in_the_last = [&] {
        std::set<std::pair<uint, uint>> pairs;
        for (const auto& [pair, colour] : colours_of(run))
            if (colour == engine::k_ground_colour) pairs.insert(pair);
        return pairs;
    };
    ASSERT_FALSE(in_the_last().empty()) << "it is lent to one";
    ASSERT_FALSE(colours_of(run).contains({0, 1})) << "it has not landed";
    run.step(30);
    expect_valid(run);
    EXPECT_EQ(in_the_last(), (std::set<std::pair<uint, uint>>{{0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}}));
}

/// All bodies but the ground are where they began.
void expect_rest(const EngineRun& run, const std::vector<BodyDefinition>& bodies) {
    const auto poses = run.read<engine::BodyPose>(BufferId::Poses, bodies.size());
    for (std::size_t i = 1; i < bodies.size(); ++i) {
        const Vec3 start = bodies[i].pose.position;
        // A contact at rest sinks by less than a millimetre before it carries.
        EXPECT_NEAR(poses[i].position.y, start.y, 2e-3f) << i;
        EXPECT_NEAR(poses[i].position.x, start.x, 1e-3f) << i;
        EXPECT_NEAR(poses[i].position.z, start.z, 1e-3f) << i;
    }
}

TEST_P(Colouring, the_contacts_of_a_hub_have_one_colour) {
    const std::vector<BodyDefinition> bodies = plate_of(9);
    EngineRun run(options_on(GetParam()), bodies, with_hubs());
    run.step();
    expect_valid(run);
    EXPECT_EQ(run.counter(engine::k_counter_colour_demand), 1u) << "of the plate on the ground";
    EXPECT_EQ(run.counter(engine::k_counter_hub_count), 1u);
    EXPECT_EQ(run.counter(engine::k_counter_hub_manifolds), 81u);
    run.step(29);
    expect_valid(run);
    expect_order(run);
    expect_rest(run, bodies);
}

TEST_P(Colouring, a_body_may_touch_two_hubs_and_hubs_may_touch) {
    const std::vector<BodyDefinition> bodies = two_plates(7);
    EngineRun run(options_on(GetParam()), bodies, with_hubs());
    run.step();
    expect_valid(run);
    EXPECT_EQ(run.counter(engine::k_counter_hub_count), 2u);
    EXPECT_EQ(run.counter(engine::k_counter_hub_manifolds), 98u);
    EXPECT_EQ(run.counter(engine::k_counter_overflow_count), 1u) << "plate on plate";
    run.step(59);
    expect_valid(run);
    expect_order(run);
    expect_rest(run, bodies);
}

TEST_P(Colouring, where_something_bounces_there_is_the_overflow_set_instead_of_hubs) {
    std::vector<BodyDefinition> bodies = plate_of(9);
    bodies.back() = with_material(bodies.back(), 0.5f, 0.5f);
    EngineRun run(options_on(GetParam()), bodies, with_hubs());
    run.step();
    EXPECT_EQ(run.counter(engine::k_counter_hub_count), 0u);
    EXPECT_EQ(run.counter(engine::k_counter_colour_demand), engine::k_first_hub_colour);
    EXPECT_EQ(run.counter(engine::k_counter_overflow_count), 82u - engine::k_first_hub_colour);
    run.step(29);
    expect_rest(run, bodies);
}

TEST_P(Colouring, hubs_and_the_overflow_set_give_the_same_bits_as_on_one_thread) {
    WorldOptions serial = options_on(DeviceKind::Cpu);
    serial.threads = 1;
    std::vector<BodyDefinition> bouncing = plate_of(9);
    bouncing.back() = with_material(bouncing.back(), 0.5f, 0.5f);
    for (const auto& bodies : {plate_of(9), two_plates(7), table_on_legs(8, 2), bouncing}) {
        EngineRun run(options_on(GetParam()), bodies, with_hubs()), expected(serial, bodies, with_hubs());
        run.step(10);
        expected.step(10);
        EXPECT_TRUE(run.motion() == expected.motion());
    }
}

TEST_P(Colouring, a_hub_that_loses_its_contacts_is_one_no_longer) {
    World world = make_world(with_hubs());
    world.add(plate_of(9));
    world.step(3);
    EXPECT_EQ(world.report().hubs, 1u);
    const std::vector<BodyId> ids = world.bodies();
    const std::vector<BodyId> gone(ids.begin() + 22, ids.end());
    for (const BodyId id : gone)
        world.remove(id);
    world.step(2);
    EXPECT_EQ(world.report().hubs, 0u);
    EXPECT_EQ(world.report().manifolds, 21u);
    EXPECT_EQ(world.report().colours, 21u);
    world.step(100); // long enough for the launches to be given up
    EXPECT_LT(largest_speed(world), 0.01f);
}

/// Of 25 boxes on a plate those stay whose contacts are furthest down.
TEST_P(Colouring, a_contact_gives_up_a_colour_that_is_needed_no_longer) {
    World world = make_world();
    const std::vector<BodyId> ids = world.add(plate_of(5));
    world.step(3);
    ASSERT_EQ(world.report().hubs, 0u);
    ASSERT_GE(world.report().colours, 26u);
    std::vector<Contact> contacts = world.contacts();
    std::ranges::sort(contacts, std::greater{}, &Contact::colour);
    std::size_t removed = 0;
    for (std::size_t i = 0; i < contacts.size() && removed < 21; ++i) {
        if (contacts[i].a == ids[0]) continue; // the plate's with the ground
        world.remove(contacts[i].b);
        ++removed;
    }
    world.step();
    EXPECT_EQ(world.report().manifolds, 5u);
    EXPECT_EQ(world.report().colours, 5u);
    world.step(30);
    EXPECT_LT(largest_speed(world), 0.01f);
}

/// The same with so many plates that what gives its colour up has no room beside what has none, and is more than one
/// work group has invocations for.
TEST_P(Colouring, many_contacts_give_up_colours_that_are_needed_no_longer) {
    constexpr uint side = 15, plates = side * side;
    std::vector<BodyDefinition> bodies{box_at({0.0f, -0.5f, 0.0f}, {10.0f * side, 1.0f, 10.0f * side})};
    bodies[0].kind = BodyKind::Static;
    for (uint plate = 0; plate < plates; ++plate) {
        const std::vector<BodyDefinition> its_bodies = plate_of(5);
        const Vec3 place{10.0f * static_cast<float>(plate % side) - 70.0f, 0.0f,
                         10.0f * static_cast<float>(plate / side) - 70.0f};
        for (std::size_t i = 1; i < its_bodies.size(); ++i) {
            bodies.push_back(its_bodies[i]);
            bodies.back().pose.position = its_bodies[i].pose.position + place;
        }
    }
    EngineRun run(options_on(GetParam()), bodies);
    run.step(3);
    const Colours colours = colours_of(run);
    ASSERT_EQ(colours.size(), 26u * plates);
    std::map<uint, std::multimap<uint, uint>> boxes; // of each plate, by the colour of their contact, the lowest first
    for (const auto& [pair, colour] : colours)
        if (pair.first != 0) boxes[pair.first].insert({colour, pair.second});
    for (const auto& [plate, its_boxes] : boxes)
        for (auto box = std::next(its_boxes.begin(), 4); box != its_boxes.end(); ++box)
            run.table.remove(run.table.id_of(box->second));
    run.simulation.change_bodies(run.table.population(), run.table.take_changes(false));
    run.simulation.search_anew(); // so that pairs of bodies that are gone are none
    run.step();
    ASSERT_EQ(run.counter(engine::k_counter_manifold_count), 5u * plates);
    const uint pairs = run.counter(engine::k_counter_graph_pairs), doubtful = run.counter(engine::k_counter_doubtful);
    EXPECT_EQ(doubtful, 4u * plates);
    EXPECT_EQ(run.counter(engine::k_counter_given_up), doubtful);
    EXPECT_LT(doubtful, 1024u) << "one group looks at them";
    EXPECT_GT(pairs, 1024u) << "and two would have part of the list";
    EXPECT_LT(pairs, 2u * doubtful) << "there is no room for them beside those that are new";
    EXPECT_EQ(run.counter(engine::k_counter_colour_demand), 5u);
    expect_valid(run);
}

TEST_P(Colouring, in_sequential_order_there_are_no_colours) {
    World world = make_world();
    world.add(bodies_of("stack:height=4"));
    world.step(3);
    EXPECT_EQ(world.report().colours, 3u);
    Settings settings;
    settings.solve_order = SolveOrder::Sequential;
    world.set_settings(settings); // contacts that had a colour lose it
    world.step(40);
    EXPECT_EQ(world.report().colours, 0u);
    EXPECT_EQ(world.report().contacts, 16u);
    EXPECT_LT(largest_speed(world), 0.01f);
    settings.solve_order = SolveOrder::Coloured;
    world.set_settings(settings);
    world.step();
    EXPECT_EQ(world.report().colours, 3u);
}

TALUS_ON_EVERY_DEVICE(Colouring);

// ---- a constraint graph that lasts ----

/// Towers and a row of boxes on the ground, and one box high above that falls into them later.
std::vector<BodyDefinition> bodies_that_stand(bool large) {
    std::vector<BodyDefinition> bodies{ground()};
    for (int i = 0; i < (large ? 360 : 12); ++i)
        for (int level = 0; level < 3; ++level)
            bodies.push_back(box_at({1.5f * static_cast<float>(i % 20), 0.5f + static_cast<float>(level),
                                     1.5f * static_cast<float>(i / 20)}));
    bodies.push_back(box_at({0.3f, 7.0f, 0.2f}));
    return bodies;
}

/// On a plate that is a hub lie many boxes, and on one of them falls another, by which it needs the plate's whole mass.
std::vector<BodyDefinition> hub_that_stands() {
    std::vector<BodyDefinition> bodies = plate_of(6);
    bodies.push_back(box_at({0.625f, 4.0f, 0.625f}));
    bodies.back().mass = 5'000.0f;
    return bodies;
}

class Graphs : public OnDevice {};

TEST_P(Graphs, that_last_give_the_bits_of_new_ones) {
    struct Standing {
        const char* name;
        std::vector<BodyDefinition> bodies;
        Settings settings;
    };
    Settings few_substeps; // renderers in software end long loops
    few_substeps.substeps = few_substeps.max_substeps = 2;
    const Standing cases[] = {{"a small world", bodies_that_stand(false), {}},
                              {"a large world", bodies_that_stand(true), few_substeps},
                              {"a hub", hub_that_stands(), with_hubs()}};
    for (const auto& [name, bodies, settings] : cases) {
        SCOPED_TRACE(name);
        World lasting = make_world(settings), in_one_go = make_world(settings), made_anew = make_world(settings);
        std::vector<BodyId> ids;
        for (World* world : {&lasting, &in_one_go, &made_anew})
            ids = world->add(bodies);
        lasting.step();
        made_anew.step();
        in_one_go.step();
        constexpr int steps = 250; // until all have been at rest for a while
        for (int i = 0; i < steps; ++i) {
            if (i == 60) {
                for (World* world : {&lasting, &made_anew})
                    world->set_velocity(ids[5], {{0.5f, 0.0f, 0.0f}, {}});
            }
            lasting.step();
            made_anew.set_settings(settings);
            made_anew.step();
            ASSERT_EQ(lasting.state_hash(), made_anew.state_hash()) << "step " << i;
            const StepReport &one = lasting.report(), &other = made_anew.report();
            EXPECT_EQ(
                std::tie(one.manifolds, one.contacts, one.colours, one.substeps, one.overflow_manifolds),
                std::tie(other.manifolds, other.contacts, other.colours, other.substeps, other.overflow_manifolds))
                << "step " << i;
        }
        EXPECT_EQ(lasting.report().growths, made_anew.report().growths);
        if (GetParam() != DeviceKind::Hybrid) { // a graph takes five launches at least
            EXPECT_LE(lasting.report().dispatches + 4, made_anew.report().dispatches);
        }

        in_one_go.step(60); // steps are on their way when one of them turns out to have to make its graph
        in_one_go.set_velocity(ids[5], {{0.5f, 0.0f, 0.0f}, {}});
        in_one_go.step(steps - 60);
        EXPECT_EQ(in_one_go.state_hash(), lasting.state_hash());
        EXPECT_EQ(in_one_go.report().contacts, lasting.report().contacts);
    }
}

/// Boxes are taken off a plate, so that contacts give up their colours.
TEST_P(Graphs, that_last_have_the_colours_of_new_ones) {
    for (const uint side : {4u, 6u}) {
        World lasting = make_world(), made_anew = make_world();
        std::vector<BodyId> left;
        for (World* world : {&lasting, &made_anew})
            left = world->add(plate_of(side));
        bool lasts = false;
        for (std::size_t round = 0; round < 4; ++round) {
            for (int i = 0; i < 25; ++i) {
                lasting.step();
                made_anew.set_settings(made_anew.settings());
                made_anew.step();
                ASSERT_EQ(lasting.state_hash(), made_anew.state_hash())
                    << side << ", round " << round << ", step " << i;
                EXPECT_EQ(lasting.report().colours, made_anew.report().colours);
            }
            lasts = lasts || lasting.report().dispatches < made_anew.report().dispatches;
            for (std::size_t i = left.size() - 1; i > 1; i -= std::min<std::size_t>(i, 2 + round % 2)) {
                for (World* world : {&lasting, &made_anew})
                    world->remove(left[i]);
                left.erase(left.begin() + static_cast<std::ptrdiff_t>(i));
            }
        }
        EXPECT_EQ(lasts, GetParam() != DeviceKind::Hybrid);
    }
}

TEST_P(Graphs, last_where_points_come_and_go) {
    const scenes::Scene heap = scenes::make_scene("pool:boxes=24,seed=11"); // where some do at rest
    World lasting = make_world(heap.settings), in_one_go = make_world(heap.settings);
    World made_anew = make_world(heap.settings);
    for (World* world : {&lasting, &in_one_go, &made_anew}) {
        for (const scenes::NamedBody& body : heap.bodies)
            world->add(body.definition);
    }
    int changed = 0; // steps with other points, in a graph that lasted
    for (int i = 0; i < 260; ++i) {
        const std::uint32_t before = lasting.report().contacts;
        lasting.step();
        made_anew.set_settings(heap.settings);
        made_anew.step();
        ASSERT_EQ(lasting.state_hash(), made_anew.state_hash()) << "step " << i;
        ASSERT_EQ(lasting.report().contacts, made_anew.report().contacts) << "step " << i;
        const bool lasted = lasting.report().dispatches < made_anew.report().dispatches;
        if (lasted && lasting.report().contacts != before) ++changed;
    }
    if (GetParam() != DeviceKind::Hybrid) {
        EXPECT_GT(changed, 0);
    }
    in_one_go.step(260);
    EXPECT_EQ(in_one_go.state_hash(), lasting.state_hash());
    EXPECT_EQ(in_one_go.report().contacts, lasting.report().contacts);
}

/// While a pyramid settles, contacts far above its foot ask for more sub-steps than before, or for fewer: never for as
/// many as those below.
TEST_P(Graphs, last_where_others_ask_for_more_sub_steps) {
    const bool is_hybrid = GetParam() == DeviceKind::Hybrid; // makes each graph anew
    const scenes::Scene pyramid = scenes::make_scene("pyramid:base=30");
    World lasting = make_world(pyramid.settings), made_anew = make_world(pyramid.settings);
    for (World* world : {&lasting, &made_anew}) {
        for (const scenes::NamedBody& body : pyramid.bodies)
            world->add(body.definition);
    }
    int lasted = 0;
    for (int i = 0; i < (is_hybrid ? 10 : 150); ++i) {
        lasting.step();
        made_anew.set_settings(pyramid.settings);
        made_anew.step();
        ASSERT_EQ(lasting.state_hash(), made_anew.state_hash()) << "step " << i;
        ASSERT_EQ(lasting.report().substeps, made_anew.report().substeps) << "step " << i;
        if (lasting.report().dispatches < made_anew.report().dispatches) ++lasted;
    }
    if (is_hybrid) {
        EXPECT_EQ(lasted, 0);
    } else {
        EXPECT_GT(lasted, 50) << "35 where any contact that asks for another number has the graph made";
    }
}

// The second world's first graph is the other one's second.
TEST_P(Graphs, of_crowded_bodies_give_the_same_colours_again) {
    for (const unsigned seed : {1u, 2u, 3u}) {
        std::mt19937 random(seed);
        const auto number = [&](float lower, float upper) {
            return std::uniform_real_distribution<float>(lower, upper)(random);
        };
        std::vector<BodyDefinition> bodies{ground()};
        for (int i = 0; i < 324; ++i) {
            const float edge = number(0.5f, 1.2f);
            const Vec3 position{number(-2.4f, 2.4f), number(0.5f, 4.8f), number(-2.4f, 2.4f)};
            bodies.push_back(i % 2 == 0 ? sphere_at(position, 0.5f * edge) : box_at(position, {edge, edge, edge}));
        }
        Settings settings = weightless();
        settings.contact_push_speed = 1e-4f;
        settings.substeps = settings.max_substeps = 1; // renderers in software end long loops
        World world = make_world(settings), other = make_world(settings);
        world.add(bodies);
        world.step();
        EXPECT_GT(world.report().colours, engine::k_many_colours);
        other.restore(world.snapshot());
        for (int i = 0; i < 4; ++i) {
            world.step();
            other.step();
            ASSERT_EQ(other.state_hash(), world.state_hash()) << "seed " << seed << ", step " << i;
        }
    }
}

// Walls and pyramids have a colour less by that.
TEST_P(Graphs, of_what_is_set_up_standing_are_coloured_again) {
    World world = make_world();
    world.add(bodies_of("pyramid:base=20"));
    world.step();
    EXPECT_EQ(world.report().colours, 7u); // 8 by rank alone; a box touches six
}

TALUS_ON_EVERY_DEVICE(Graphs);

} // namespace
} // namespace talus::tests
