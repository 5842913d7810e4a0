// SPDX-License-Identifier: MIT
// Constraints that lie over contacts which are not wanted any more: where they do so, what growth keeps, and that
// nobody sees it, whatever becomes of a step.
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "device/gl/contact_room.h"
#include "saved_state.h"
#include "state/formulas.h"
#include "step_results.h"
#include "tests/bodies.h"
#include "tests/devices.h"
#include "tests/engine_run.h"
#include "tests/stand_in_device.h"

namespace talus::tests {
namespace {

using engine::BufferId;
using engine::ConstraintPlace;
using engine::ContactDemand;
using engine::ContactRoom;
using engine::uint;

std::vector<BufferId> all_contacts() {
    std::vector<BufferId> all(engine::k_contact_buffers.begin(), engine::k_contact_buffers.end());
    all.insert(all.end(), engine::k_old_contact_buffers.begin(), engine::k_old_contact_buffers.end());
    return all;
}

bool overlap(ContactRoom::Place a, ContactRoom::Place b) {
    return a.offset < b.offset + b.bytes && b.offset < a.offset + a.bytes;
}

/// The room in each of the ways in which its parts can lie: in the two halves of two steps.
std::vector<ContactRoom> ways(ContactRoom room) {
    std::vector<ContactRoom> all;
    for (int step = 0; step < 2; ++step) {
        all.push_back(room);
        room.place_constraints(ConstraintPlace::OverOldContacts);
        all.push_back(room);
        room.swap();
    }
    return all;
}

/// And in each with the constraints beside the contacts, where they have room there.
std::vector<ContactRoom> ways_with_few_constraints(const ContactRoom& room) {
    std::vector<ContactRoom> all = ways(room);
    if (room.constraints_beside() == 0) return all;
    for (ContactRoom beside : ways(room)) {
        beside.place_constraints(ConstraintPlace::BesideContacts);
        all.push_back(beside);
    }
    return all;
}

/// A search uses all of the table.
ContactDemand demand_of(uint pairs, uint manifolds, bool keeps_old = false, uint table_size = 0, uint boxes = 0) {
    ContactDemand demand;
    demand.pairs = pairs;
    demand.manifolds = manifolds;
    demand.table_size = demand.partners = table_size;
    demand.boxes = boxes;
    demand.keeps_old = keeps_old;
    return demand;
}

ContactRoom room_for(uint pairs, uint manifolds, bool keeps_old, uint table_size = 0, uint boxes = 0) {
    return ContactRoom(demand_of(pairs, manifolds, keeps_old, table_size, boxes));
}

// Pairs, manifolds, words of the table, boxes, words to sort, words of fast bodies, words of partners.
constexpr std::array<ContactDemand, 15> k_sizes{{{0, 0, 0, 0, 0, 0},
                                                 {1, 1, 2, 5, 8, 0},
                                                 {3, 0, 8, 2, 9, 1},
                                                 {3, 3, 8, 0, 3, 700},
                                                 {64, 64, 128, 64, 64, 63},
                                                 {100, 900, 256, 40, 100, 64},
                                                 {1000, 600, 2048, 10'000, 1000, 7000},
                                                 {1000, 600, 65'536, 9, 1000, 0},
                                                 {1000, 600, 65'536, 9, 1000, 70'000},
                                                 {1000, 1000, 2048, 300, 5000, 65},
                                                 {1000, 1000, 2048, 300, 1000, 70'000},
                                                 {1000, 1000, 65'536, 8192, 0, 700},
                                                 {1000, 600, 65'536, 9, 1000, 0, 65'536},
                                                 {1000, 600, 65'536, 10'000, 1000, 700, 16'000},
                                                 {1000, 600, 65'536, 300, 1000, 700, 1}}};

// ---- places ----

TEST(ContactRooms, have_places_where_blocks_may_begin_and_none_over_another_but_constraints_over_what_is_dead) {
    for (ContactDemand size : k_sizes) {
        for (const bool keeps_old : {false, true}) {
            size.keeps_old = keeps_old;
            for (const ContactRoom& room : ways_with_few_constraints(ContactRoom(size))) {
                SCOPED_TRACE(testing::Message() << size.pairs << " pairs, " << size.manifolds << " manifolds");
                const ContactRoom::Place constraints = room.place(BufferId::Constraints);
                EXPECT_GE(constraints.bytes,
                          std::min(size.manifolds, room.constraints_beside()) * sizeof(engine::ContactConstraint));
                if (room.is_covered(BufferId::Manifolds) || room.is_covered(BufferId::OldManifolds)) {
                    EXPECT_GE(constraints.bytes, size.manifolds * sizeof(engine::ContactConstraint));
                }
                EXPECT_LE(constraints.offset + constraints.bytes, room.bytes());
                EXPECT_EQ(constraints.offset % 256, 0u);
                const ContactRoom::Place table = room.place(BufferId::PairTable);
                EXPECT_GT(table.bytes, 0u);
                EXPECT_GE(table.bytes, size.table_size * sizeof(uint));
                EXPECT_LE(table.offset + table.bytes, room.bytes());
                EXPECT_EQ(table.offset % 256, 0u);
                EXPECT_FALSE(keeps_old && overlap(table, constraints)) << "the end of a step reads both";
                const ContactRoom::Place fast = room.place(BufferId::FastBodies);
                EXPECT_GT(fast.bytes, 0u);
                EXPECT_GE(fast.bytes, size.fast_words * sizeof(uint));
                EXPECT_LE(fast.offset + fast.bytes, room.bytes());
                EXPECT_EQ(fast.offset % 256, 0u);
                EXPECT_FALSE(overlap(fast, constraints)) << "the solve has both";
                EXPECT_FALSE(keeps_old && overlap(table, fast));
                const ContactRoom::Place boxes = room.place(BufferId::TreeNodes);
                EXPECT_EQ(room.place(BufferId::SortedAabbs).offset, boxes.offset);
                const std::array lists{room.place(BufferId::Uncoloured), room.place(BufferId::SwapKeys),
                                       room.place(BufferId::SwapValues)};
                for (const ContactRoom::Place list : lists) {
                    EXPECT_GT(list.bytes, 0u);
                    EXPECT_EQ(list.offset % 256, 0u);
                    EXPECT_LE(list.offset + list.bytes, room.bytes());
                    EXPECT_FALSE(overlap(list, table)) << "the narrow phase has the first list and the table";
                    EXPECT_FALSE(keeps_old && overlap(list, constraints));
                    EXPECT_FALSE(keeps_old && overlap(list, fast));
                    for (const BufferId id : all_contacts())
                        EXPECT_FALSE(overlap(list, room.place(id))) << "contacts are there when it is made";
                }
                EXPECT_GE(lists[0].bytes, size.pairs * sizeof(uint));
                EXPECT_GE(lists[1].bytes, size.sorted * sizeof(uint));
                EXPECT_GE(lists[2].bytes, size.sorted * sizeof(uint));
                for (const auto& [one, other] : {std::pair{0, 1}, {0, 2}, {1, 2}})
                    EXPECT_FALSE(overlap(lists[one], lists[other])) << "the graph has all three";
                EXPECT_GT(boxes.bytes, 0u);
                EXPECT_GE(boxes.bytes, size.boxes * sizeof(engine::Aabb));
                EXPECT_LE(boxes.offset + boxes.bytes, room.bytes());
                EXPECT_EQ(boxes.offset % 256, 0u);
                const ContactRoom::Place partners{table.offset, size.partners * sizeof(uint)};
                EXPECT_LE(partners.bytes, table.bytes);
                EXPECT_FALSE(overlap(boxes, partners)) << "the search has both";
                EXPECT_FALSE(keeps_old && overlap(boxes, constraints));
                EXPECT_FALSE(keeps_old && overlap(boxes, fast));
                for (const BufferId id : all_contacts()) {
                    const ContactRoom::Place place = room.place(id);
                    EXPECT_EQ(place.offset % 256, 0u);
                    EXPECT_GT(place.bytes, 0u) << "none may be bound";
                    EXPECT_GE(place.bytes, size.pairs * engine::bytes_a_pair(id));
                    EXPECT_LE(place.offset + place.bytes, room.bytes());
                    EXPECT_TRUE(room.is_covered(id) || !overlap(place, constraints));
                    EXPECT_TRUE(room.is_covered(id) || !overlap(place, fast));
                    EXPECT_FALSE(overlap(place, table)) << "it is made while all contacts are there";
                    EXPECT_FALSE(overlap(place, boxes)) << "they are, too";
                    for (const BufferId other : all_contacts())
                        EXPECT_EQ(overlap(place, room.place(other)), id == other);
                }
            }
        }
    }
}

TEST(ContactRooms, have_constraints_over_the_old_contacts_in_a_step_and_over_the_new_ones_between_steps) {
    ContactRoom room = room_for(100, 100, false);
    EXPECT_TRUE(room.is_covered(BufferId::Manifolds));
    EXPECT_FALSE(room.is_covered(BufferId::OldManifolds));
    for (int step = 0; step < 3; ++step) {
        room.place_constraints(ConstraintPlace::OverOldContacts);
        EXPECT_FALSE(room.is_covered(BufferId::Manifolds));
        EXPECT_TRUE(room.is_covered(BufferId::OldPointImpulses));
        const ContactRoom before = room;
        room.swap();
        const auto offset = [](const ContactRoom& of, BufferId id) { return of.place(id).offset; };
        EXPECT_EQ(offset(room, BufferId::Constraints), offset(before, BufferId::Constraints)) << "they lie still";
        for (std::size_t i = 0; i < engine::k_contact_buffers.size(); ++i) {
            const BufferId id = engine::k_contact_buffers[i], old = engine::k_old_contact_buffers[i];
            EXPECT_EQ(offset(room, old), offset(before, id));
            EXPECT_EQ(offset(room, id), offset(before, old));
            EXPECT_TRUE(room.is_covered(id));
            EXPECT_FALSE(room.is_covered(old));
        }
    }
}

TEST(ContactRooms, have_a_few_constraints_beside_the_contacts_of_two_steps) {
    ContactRoom room = room_for(1000, 600, false, 65'536);
    const auto whole_blocks = [](uint constraints) { return constraints / 32 * 32; };
    EXPECT_EQ(room.constraints_beside(), whole_blocks((65'536 * 4 + 4096 + 2 * 256 - 256) / 240))
        << "over the table, the list and what sorts need, less room behind them";
    EXPECT_EQ(room_for(1000, 600, false, 65'536, 8192).constraints_beside(), whole_blocks(2 * 65'536 * 4 / 240));
    room.place_constraints(ConstraintPlace::BesideContacts);
    for (int step = 0; step < 2; ++step) {
        for (const BufferId id : all_contacts())
            EXPECT_FALSE(room.is_covered(id));
        room.swap();
    }
    const ContactRoom grown = room.grown(demand_of(2000, 1200, false, 65'536));
    EXPECT_TRUE(grown.is_covered(BufferId::Manifolds)) << "as many as had room before have it for sure";
    EXPECT_FALSE(grown.is_covered(BufferId::OldManifolds));
    EXPECT_EQ(room_for(100, 70, true).constraints_beside(), 70u) << "all lie there";
    EXPECT_EQ(room_for(100, 0, false).constraints_beside(), 0u);
}

TEST(ContactRooms, cover_nothing_where_the_old_contacts_are_kept) {
    for (const ContactRoom& room : ways(room_for(100, 100, true)))
        for (const BufferId id : all_contacts())
            EXPECT_FALSE(room.is_covered(id));
}

TEST(ContactRooms, need_memory_for_constraints_only_where_these_are_longer_than_the_contacts_below) {
    constexpr uint pairs = 256 * 32;                     // whole numbers of all that places are rounded to
    constexpr uint least = 256;                          // of any place
    constexpr uint least_search = 3 * least + 4 * pairs; // the list of pairs lies where a search has its boxes
    EXPECT_EQ(room_for(pairs, 0, false).bytes(), 2u * 176 * pairs + least_search);
    EXPECT_EQ(room_for(pairs, pairs * 2 / 3, false).bytes(), 2u * 176 * pairs + least_search);
    EXPECT_EQ(room_for(pairs, pairs, false).bytes(), (176u + 240u) * pairs + least);
    EXPECT_EQ(room_for(pairs, pairs, true).bytes(), (2u * 176u + 240u) * pairs + least + least_search);
    EXPECT_EQ(room_for(pairs, pairs / 4, true).bytes(), (2u * 176u + 60u) * pairs + least + least_search);
}

TEST(ContactRooms, need_memory_for_what_is_wanted_by_turns_once) {
    constexpr uint pairs = 256 * 32;
    ContactDemand demand = demand_of(pairs, pairs / 2, false, 4 * pairs, 2 * pairs);
    const std::size_t bytes = ContactRoom(demand).bytes();
    EXPECT_EQ(bytes, (2u * 176 + 16 + 64) * pairs);
    demand.sorted = 7 * pairs;                                             // with the list as long as the boxes are
    demand.fast_words = (176 + 16 + 64 - 120) * pairs / sizeof(uint) - 64; // as much as constraints leave
    EXPECT_EQ(ContactRoom(demand).bytes(), bytes);
    demand.fast_words += 128;
    EXPECT_EQ(ContactRoom(demand).bytes(), bytes + 256);
    demand.fast_words = 0;
    demand.sorted = 8 * pairs;
    EXPECT_EQ(ContactRoom(demand).bytes(), bytes + 4 * pairs);
}

TEST(ContactRooms, need_memory_for_a_search_only_where_it_is_longer_than_what_constraints_need_besides) {
    constexpr uint pairs = 256 * 32;
    const std::size_t bytes = room_for(pairs, pairs, false).bytes();
    EXPECT_EQ(room_for(pairs, pairs, false, 4 * pairs, pairs).bytes(), bytes);
    EXPECT_EQ(room_for(pairs, 0, false, 4 * pairs, pairs).bytes(), (2u * 176 + 16 + 32) * pairs);
    EXPECT_EQ(room_for(pairs, pairs, true, 4 * pairs, pairs).bytes(), (2u * 176u + 240u + 16u + 32u) * pairs + 256);
    const ContactRoom room = room_for(pairs, pairs, false);
    EXPECT_TRUE(room.grown(demand_of(pairs, pairs, false, 4 * pairs, pairs)).has_places_of(room));
}

TEST(ContactRooms, have_the_boxes_of_a_search_over_what_it_leaves_of_the_table) {
    constexpr uint pairs = 256 * 32;
    ContactDemand demand = demand_of(pairs, 0, false, 16 * pairs, pairs);
    demand.partners = 14 * pairs;
    EXPECT_EQ(ContactRoom(demand).bytes(), (2u * 176 + 14 * 4 + 32) * pairs);
    demand.partners = 8 * pairs; // then the list and what sorts need are longer
    EXPECT_EQ(ContactRoom(demand).bytes(), (2u * 176 + 16 * 4 + 4) * pairs + 512);
}

TEST(ContactRooms, that_grow_have_the_same_parts_alive_and_never_shrink) {
    for (const bool keeps_old : {false, true}) {
        for (const ContactRoom& room : ways(room_for(100, 60, keeps_old))) {
            EXPECT_TRUE(room.grown(demand_of(1, 1)).has_places_of(room));
            EXPECT_EQ(room.grown(demand_of(1, 1)).place(BufferId::Constraints).bytes,
                      room.place(BufferId::Constraints).bytes);
            const ContactRoom larger = room.grown(demand_of(300, 200));
            EXPECT_FALSE(larger.has_places_of(room));
            for (const BufferId id : all_contacts()) {
                EXPECT_EQ(larger.is_covered(id), room.is_covered(id));
                EXPECT_GT(larger.place(id).bytes, room.place(id).bytes);
            }
            EXPECT_EQ(room.grown(demand_of(1, 1, true)).has_places_of(room), keeps_old);
        }
    }
    // Constraints that get longer over the same contacts.
    const ContactRoom room = room_for(1000, 10, false);
    EXPECT_TRUE(room.grown(demand_of(0, 600)).has_places_of(room));
    EXPECT_GT(room.grown(demand_of(0, 600)).place(BufferId::Constraints).bytes,
              room.place(BufferId::Constraints).bytes);
    EXPECT_FALSE(room.grown(demand_of(0, 1000)).has_places_of(room));
}

// ---- content ----

class ContactMemory : public OnDevice {};

/// Words that tell what they are of.
std::vector<std::byte> pattern(BufferId id, std::size_t bytes) {
    std::vector<uint> words(bytes / sizeof(uint));
    for (std::size_t i = 0; i < words.size(); ++i)
        words[i] = static_cast<uint>(id) << 24 | static_cast<uint>(i + 1);
    const auto content = std::as_bytes(std::span(words));
    return {content.begin(), content.end()};
}

std::vector<std::byte> content(engine::Device& device, BufferId id) {
    std::vector<std::byte> bytes(device.size(id));
    device.read(std::array{engine::ReadRequest{id, bytes.size(), bytes.data()}});
    return bytes;
}

void expect_kept(engine::Device& device, BufferId id, const std::vector<std::byte>& before) {
    std::vector<std::byte> expected = before, now = content(device, id);
    ASSERT_GE(now.size(), before.size());
    if (id == BufferId::Constraints) now.resize(before.size());
    expected.resize(now.size());
    EXPECT_TRUE(now == expected) << engine::k_buffers[static_cast<std::size_t>(id)].block;
}

TEST_P(ContactMemory, keeps_what_is_alive_when_it_grows) {
    if (GetParam() == DeviceKind::Hybrid) return; // has no device of its own
    const auto device = GetParam() == DeviceKind::Gpu ? engine::make_gl_device(GlContext::Own, false)
                                                      : engine::make_cpu_device(1, false);
    std::vector<BufferId> alive(engine::k_old_contact_buffers.begin(), engine::k_old_contact_buffers.end());
    alive.push_back(BufferId::Constraints);
    std::map<BufferId, std::vector<std::byte>> written;
    const auto write = [&] {
        for (const BufferId id : alive) {
            written[id] = pattern(id, device->size(id));
            device->write(id, 0, written[id]);
        }
    };
    const auto check = [&] {
        for (const BufferId id : alive)
            expect_kept(*device, id, written[id]);
    };
    for (const BufferId id : all_contacts()) // each by itself
        device->grow(id, 2 * engine::bytes_a_pair(id));
    device->grow(BufferId::Constraints, 32 * sizeof(engine::ContactConstraint));
    write();
    device->reserve_contacts(demand_of(10, 32, false, 4 * 10));
    check();
    uint pairs = 10;
    for (const bool keeps_old : {false, false, true, true, false}) {
        for (int step = 0; step < 3; ++step) {
            device->place_constraints(ConstraintPlace::OverOldContacts);
            device->swap_contacts();
            write();
            check();
            pairs *= 2;
            device->reserve_contacts(demand_of(pairs, pairs / 3, keeps_old, 4 * pairs, pairs));
            check();
            device->reserve_contacts(demand_of(pairs, pairs, keeps_old, 4 * pairs, pairs));
            check();
        }
    }
    EXPECT_TRUE(device->has_old_contacts());
    EXPECT_GE(device->size(BufferId::ManifoldPoints), std::size_t{4} * 16 * pairs);
}

TEST_P(ContactMemory, is_kept_when_only_what_lies_beside_it_grows) {
    if (GetParam() != DeviceKind::Gpu) return; // the others have each buffer by itself
    for (const uint manifolds : {20u, 100u, 300u}) {
        for (const bool keeps_old : {false, true}) {
            for (const int steps : {0, 1}) {
                const auto device = engine::make_gl_device(GlContext::Own, false);
                ContactDemand demand = demand_of(300, manifolds, keeps_old, 600, 150);
                device->reserve_contacts(demand);
                for (int i = 0; i < steps; ++i) {
                    device->place_constraints(ConstraintPlace::OverOldContacts);
                    device->swap_contacts();
                }
                std::map<BufferId, std::vector<std::byte>> written;
                for (const BufferId id : engine::k_old_contact_buffers)
                    written[id] = pattern(id, device->size(id));
                written[BufferId::Constraints] = pattern(BufferId::Constraints, device->size(BufferId::Constraints));
                for (const auto& [id, bytes] : written)
                    device->write(id, 0, bytes);
                demand.sorted = demand.fast_words = 200;
                for (int i = 0; i < 8; ++i) {
                    const std::array grows{&demand.table_size, &demand.boxes, &demand.sorted, &demand.fast_words};
                    *grows[i % 4] *= 5;
                    device->reserve_contacts(demand);
                    for (const auto& [id, bytes] : written)
                        expect_kept(*device, id, bytes);
                    EXPECT_GE(device->size(BufferId::PairTable), demand.table_size * sizeof(uint));
                    EXPECT_GE(device->size(BufferId::TreeNodes), demand.boxes * sizeof(engine::Aabb));
                    EXPECT_GE(device->size(BufferId::SwapValues), demand.sorted * sizeof(uint));
                    EXPECT_GE(device->size(BufferId::FastBodies), demand.fast_words * sizeof(uint));
                }
            }
        }
    }
}

void add(std::string& text, auto... values) {
    (text.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
}

/// All that the world tells of its last step's contacts, in the bits that it has.
std::string results_of(const World& world) {
    std::string text;
    for (const Contact& contact : world.contacts()) {
        add(text, contact.a.index, contact.b.index, contact.colour, contact.normal);
        for (const ContactPoint& point : contact.points)
            add(text, point);
    }
    return text;
}

/// In the order of their bits: which comes first in a step is not told.
std::multiset<std::string> take_events(World& world) {
    std::multiset<std::string> events;
    for (const ContactEvent& event : world.take_contact_events()) {
        std::string text;
        add(text, event.step, event.phase, event.a.index, event.b.index);
        for (const ContactPoint& point : event.points)
            add(text, point);
        events.insert(text);
    }
    return events;
}

/// A wall of boxes, and one more at each call.
void add_box(World& world) {
    const auto i = static_cast<float>(world.body_count());
    world.add(box_at({std::fmod(i, 7.0f) * 1.02f, 0.5f + std::floor(i / 7.0f), 0.0f}));
}

TEST_P(ContactMemory, tells_the_same_of_contacts_as_the_cpu_while_it_grows) {
    WorldOptions small = options_on(GetParam()), ample = options_on(DeviceKind::Cpu);
    small.capacities = {1, 1, 1};
    ample.capacities = {256, 4096, 64};
    World world({}, small), expected({}, ample);
    for (World* each : {&world, &expected})
        each->add(ground());
    for (int i = 0; i < 40; ++i) {
        for (World* each : {&world, &expected}) {
            if (i == 13) each->watch_contacts(ContactWatch::All); // in the midst of a run
            if (i == 27) each->watch_contacts(ContactWatch::None);
            if (i == 34) each->watch_contacts(ContactWatch::Changes);
            add_box(*each);
            each->step(i % 3 + 1);
        }
        ASSERT_EQ(results_of(world), results_of(expected)) << "after step " << world.step_count();
        ASSERT_EQ(take_events(world), take_events(expected)) << "after step " << world.step_count();
        ASSERT_EQ(world.state_hash(), expected.state_hash()) << "after step " << world.step_count();
    }
    EXPECT_GT(world.report().growths, 3u);
}

TEST_P(ContactMemory, goes_into_snapshots_and_comes_out_of_them) {
    WorldOptions options = options_on(GetParam());
    options.capacities = {1, 1, 1};
    World world({}, options), other({}, options);
    world.add(ground());
    for (int i = 0; i < 20; ++i)
        add_box(world);
    for (int i = 0; i < 4; ++i) {
        world.step(3 + i); // an even or odd number
        const std::string results = results_of(world);
        const Snapshot snapshot = world.snapshot();
        other.restore(snapshot);
        EXPECT_EQ(results_of(other), results);
        EXPECT_EQ(results_of(world), results) << "which a snapshot does not change";
        world.step(2);
        other.step(2);
        EXPECT_EQ(other.state_hash(), world.state_hash());
        EXPECT_EQ(results_of(other), results_of(world));
        world.restore(snapshot);
        EXPECT_EQ(results_of(world), results);
    }
}

TEST_P(ContactMemory, may_be_more_than_one_block_of_a_kernel) {
    WorldOptions options = options_on(GetParam());
    World expected({}, options);
    options.capacities.pairs = 400'000; // 165 MiB of contacts; Mesa's software renderer allows 128 MiB a block
    World world({}, options);
    for (World* each : {&world, &expected}) {
        each->add(bodies_of("card_house:levels=2"));
        each->step(9);
    }
    EXPECT_EQ(world.state_hash(), expected.state_hash());
    EXPECT_EQ(results_of(world), results_of(expected));
}

// ---- steps that come to nothing ----

const ContactDemand k_boundless = demand_of(engine::k_none, engine::k_none, false, 0, engine::k_none);

/// A device that has no room, or cannot have a kernel, where a test says so.
class PoorDevice final : public StandInDevice {
public:
    using StandInDevice::StandInDevice;

    ContactDemand most = k_boundless; // that there is room for
    uint largest_table = engine::k_none;
    uint most_fast_words = engine::k_none;
    std::set<BufferId> full; // that cannot grow
    const engine::Kernel* faulty = nullptr;

    void grow(BufferId buffer, std::size_t bytes) override {
        if (bytes > size(buffer) && full.contains(buffer)) throw Error("no room");
        StandInDevice::grow(buffer, bytes);
    }

    void reserve_contacts(const ContactDemand& demand) override {
        if (demand.pairs > most.pairs || demand.manifolds > most.manifolds || demand.table_size > largest_table ||
            demand.boxes > most.boxes || demand.fast_words > most_fast_words)
            throw Error("no room");
        StandInDevice::reserve_contacts(demand);
    }
    void run(const engine::Launch& launch) override {
        if (&launch.kernel == faulty) throw Error("no kernel");
        StandInDevice::run(launch);
    }
};

std::vector<BodyDefinition> tower() {
    std::vector<BodyDefinition> bodies{ground()};
    for (int i = 0; i < 5; ++i)
        bodies.push_back(box_at({0.0f, 0.5f + static_cast<float>(i), 0.0f}));
    return bodies;
}

struct PoorRun {
    PoorRun(DeviceKind kind, bool with_room) : PoorRun(kind, with_room, tower(), {}) {}

    PoorRun(DeviceKind kind, bool with_room, const std::vector<BodyDefinition>& bodies, const Settings& settings) {
        WorldOptions options = options_on(kind);
        options.capacities.pairs = with_room ? 4096 : 8;
        engine::Devices devices = engine::make_devices(options);
        std::unique_ptr<engine::Device>& last = devices.cpu ? devices.cpu : devices.gpu;
        auto poor = std::make_unique<PoorDevice>(std::move(last));
        device = poor.get();
        last = std::move(poor);
        run = std::make_unique<EngineRun>(options, std::move(devices), bodies, settings);
    }

    /// Boxes beside the tower, so that there is no room for all pairs.
    void add_wall() {
        std::vector<BodyDefinition> more;
        for (int i = 0; i < 30; ++i)
            more.push_back(box_at({5.0f + static_cast<float>(i % 6), 0.5f + static_cast<float>(i / 6), 0.0f}));
        for (const BodyDefinition& body : more)
            run->table.add(body);
        engine::Simulation& simulation = run->simulation;
        const uint count = run->table.slot_count();
        simulation.reserve_bodies(count);
        const uint first = count - static_cast<uint>(more.size());
        const auto write = [&](BufferId id, const auto& records) {
            simulation.write(id, first, std::span(records).subspan(first));
        };
        write(BufferId::Poses, run->table.poses);
        write(BufferId::Velocities, run->table.velocities);
        write(BufferId::Shapes, run->table.shapes);
        write(BufferId::Properties, run->table.properties);
    }

    std::unique_ptr<EngineRun> run;
    PoorDevice* device = nullptr; // the run's
};

std::vector<BodyDefinition> row_of_boxes(int count, float z, float restitution) {
    std::vector<BodyDefinition> bodies;
    for (int i = 0; i < count; ++i)
        bodies.push_back(with_material(box_at({1.5f * static_cast<float>(i) - 20.0f, 0.5f, z}), 0.5f, restitution));
    return bodies;
}

TEST_P(ContactMemory, lets_a_world_go_on_that_found_no_room_for_more_bodies) {
    for (const BroadPhase broad_phase : {BroadPhase::Bvh, BroadPhase::SweepAndPrune}) {
        Settings settings;
        settings.broad_phase = broad_phase;
        PoorRun poor(GetParam(), true, tower(), settings), rich(GetParam(), true, tower(), settings);
        for (PoorRun* each : {&poor, &rich})
            each->run->step(2);
        poor.device->most.boxes = 1;
        EXPECT_THROW(poor.run->simulation.reserve_bodies(5'000), Error);
        poor.device->most.boxes = engine::k_none;
        for (PoorRun* each : {&poor, &rich}) {
            each->run->simulation.search_anew();
            each->run->step(2);
        }
        EXPECT_TRUE(poor.run->motion() == rich.run->motion());
    }
}

TEST_P(ContactMemory, leaves_a_world_alone_that_has_no_room_for_what_a_snapshot_says_of_sleep) {
    Settings sleeping;
    sleeping.sleeping = true;
    PoorRun from(GetParam(), true, tower(), sleeping);
    from.run->step(5);
    const engine::SavedState saved = save_state(from.run->simulation, from.run->table, from.run->settings);
    PoorRun poor(GetParam(), true);
    poor.run->step(3);
    const std::size_t manifolds = read_contacts(poor.run->simulation).manifolds.size();
    const std::vector<float> motion = poor.run->motion();
    poor.device->full = {BufferId::Loads};
    EXPECT_THROW(poor.run->simulation.restore(saved), Error);
    EXPECT_EQ(poor.run->simulation.report().step, 3u);
    EXPECT_EQ(read_contacts(poor.run->simulation).manifolds.size(), manifolds);
    EXPECT_TRUE(poor.run->motion() == motion);
}

constexpr uint k_multirate_slots = 70'000; // enough for an island that is multirate

/// Settings that differ in the words that a body has in FastBodies: 7, 5, 1, 11 and 0 with these.
std::vector<Settings> rates() {
    std::vector<Settings> all(5);
    all[1].sleeping = true;
    all[2].substeps = all[2].max_substeps = 32;
    all[3].substeps = 1;
    all[4].substeps = 3; // the most are no double of it
    return all;
}

TEST_P(ContactMemory, is_there_for_what_fast_bodies_know_whatever_the_settings_become) {
    if (GetParam() == DeviceKind::Cpu) return; // no launch of it needs them
    WorldOptions options = options_on(GetParam());
    options.capacities.bodies = k_multirate_slots;
    EngineRun run(options, tower());
    engine::Device& device = run.simulation.state_device();
    std::set<uint> sizes;
    for (int i = 0; i < 10; ++i) {
        run.simulation.set_settings(rates()[static_cast<std::size_t>(i * 3 % 5)]);
        engine::Population many = run.table.population();
        many.slots = k_multirate_slots;
        const uint words = words_of_fast_bodies(run.simulation.plan_step(many));
        sizes.insert(words / many.slots);
        if (GetParam() == DeviceKind::Gpu) {
            EXPECT_GE(device.size(BufferId::FastBodies), words * sizeof(uint));
        }
    }
    EXPECT_EQ(sizes, (std::set<uint>{0, 1, 5, 7, 11}));
}

TEST_P(ContactMemory, leaves_a_world_alone_that_has_no_room_for_the_rates_of_other_settings) {
    if (GetParam() != DeviceKind::Gpu) return;
    PoorRun from(GetParam(), true, tower(), rates()[0]);
    from.run->step(5);
    const engine::SavedState saved = save_state(from.run->simulation, from.run->table, from.run->settings);
    PoorRun poor(GetParam(), true, tower(), rates()[2]);
    engine::Simulation& simulation = poor.run->simulation;
    simulation.reserve_bodies(k_multirate_slots);
    poor.run->step(3);
    const std::size_t manifolds = read_contacts(simulation).manifolds.size();
    const std::vector<float> motion = poor.run->motion();
    poor.device->most_fast_words = 0;
    EXPECT_THROW(simulation.set_settings(rates()[3]), Error);
    EXPECT_THROW(simulation.restore(saved), Error);
    EXPECT_EQ(simulation.report().step, 3u);
    EXPECT_EQ(read_contacts(simulation).manifolds.size(), manifolds);
    EXPECT_TRUE(poor.run->motion() == motion);
    poor.device->most_fast_words = engine::k_none;
    PoorRun rich(GetParam(), true, tower(), rates()[2]);
    rich.run->step(3);
    for (PoorRun* each : {&poor, &rich})
        each->run->step(5);
    EXPECT_TRUE(poor.run->motion() == rich.run->motion()) << "the settings are what they were";
}

TEST_P(ContactMemory, loses_no_body_of_the_steps_behind_one_that_has_no_room_for_hits) {
    std::vector<BodyDefinition> bodies = row_of_boxes(5, 0.0f, 0.5f);
    bodies.push_back(ground());
    PoorRun poor(GetParam(), false, bodies, {});
    poor.run->step(3);
    engine::Simulation& simulation = poor.run->simulation;
    engine::BodyTable& table = poor.run->table;
    static_cast<void>(table.take_changes(simulation.has_room_for_loads())); // of those that are there
    simulation.reserve_bodies(64);
    poor.device->full = {BufferId::WarmStarts};
    const auto step_with_more = [&](int count, float z) {
        for (const BodyDefinition& body : row_of_boxes(count, z, 0.5f))
            table.add(body);
        simulation.step(table.population(), false, table.take_changes(simulation.has_room_for_loads()));
    };
    EXPECT_THROW(
        {
            step_with_more(40, 5.0f); // more contacts than there is room for
            step_with_more(5, 9.0f);  // is on its way when that is seen
            simulation.settle();
        },
        Error);
    poor.device->full.clear();
    simulation.step(table.population(), false, table.take_changes(simulation.has_room_for_loads()));
    simulation.settle();
    const auto poses = poor.run->read<engine::BodyPose>(BufferId::Poses, table.slot_count());
    for (uint i = 0; i < table.slot_count(); ++i)
        EXPECT_NEAR(poses[i].position.z, table.poses[i].position.z, 0.1f) << i;
}

TEST_P(ContactMemory, is_as_it_was_after_a_step_for_which_there_is_no_room) {
    const std::map<const char*, ContactDemand> lacks{
        {"pairs", {8, 8, 0, engine::k_none}}, // known before contacts are found, or behind it
        {"manifolds", {engine::k_none, 8, 0, engine::k_none}}};
    for (const auto& [what, most] : lacks) {
        SCOPED_TRACE(what);
        PoorRun poor(GetParam(), false), rich(GetParam(), true);
        poor.run->step(5);
        rich.run->step(5);
        const engine::ContactRecords before = read_contacts(poor.run->simulation);
        ASSERT_GT(before.manifolds.size(), 4u);
        poor.add_wall();
        rich.add_wall();
        const std::vector<float> motion = poor.run->motion();
        poor.device->most = most;
        EXPECT_THROW(poor.run->step(3), Error);
        EXPECT_TRUE(poor.run->motion() == motion);
        const engine::ContactRecords now = read_contacts(poor.run->simulation);
        ASSERT_EQ(now.manifolds.size(), before.manifolds.size());
        for (std::size_t i = 0; i < now.manifolds.size(); ++i) {
            EXPECT_EQ(now.manifolds[i].body_b, before.manifolds[i].body_b);
            EXPECT_EQ(now.manifolds[i].point_count, before.manifolds[i].point_count);
            for (int k = 0; k < 4; ++k) {
                const float impulse = now.next_impulses[i].normal[k];
                EXPECT_EQ(impulse, before.next_impulses[i].normal[k]);
                EXPECT_EQ(impulse, now.impulses[4 * i + static_cast<std::size_t>(k)]) << "of constraints that are lost";
            }
        }
        poor.device->most = k_boundless;
        poor.run->step(3);
        rich.run->step(3);
        EXPECT_TRUE(poor.run->motion() == rich.run->motion()) << "impulses that a step starts from have been kept";
        EXPECT_TRUE(read_contacts(poor.run->simulation).impulses == read_contacts(rich.run->simulation).impulses);
    }
}

TEST_P(ContactMemory, gets_room_for_what_a_search_keeps_of_bodies_for_which_there_was_none_at_first) {
    PoorRun poor(GetParam(), true);
    constexpr uint k_bodies = 5000;
    poor.device->largest_table = 10'000;
    EXPECT_THROW(poor.run->simulation.reserve_bodies(k_bodies), Error);
    EXPECT_LE(poor.device->size(BufferId::PairTable), 10'000 * sizeof(uint));
    poor.device->largest_table = engine::k_none;
    poor.run->simulation.reserve_bodies(k_bodies);
    EXPECT_GE(poor.device->size(BufferId::PairTable), engine::k_kept_partners * k_bodies * sizeof(uint));
}

TEST_P(ContactMemory, is_kept_where_bodies_need_room_while_a_step_that_did_not_fit_is_on_its_way) {
    int growths_on_the_way = 0;
    for (std::uint32_t before = 1; before <= 60; ++before) {
        SCOPED_TRACE(before);
        WorldOptions small = options_on(GetParam()), ample = options_on(DeviceKind::Cpu);
        small.capacities = {64, 4, 2};
        ample.capacities = {4096, 8192, 64};
        World world({}, small), expected({}, ample);
        for (World* each : {&world, &expected}) {
            each->add(ground());
            for (int i = 0; i < 40; ++i) // they land one after the other
                each->add(box_at({1.5f * static_cast<float>(i), 0.6f + 0.15f * static_cast<float>(i % 20), 0.0f}));
            each->step(before);
            EXPECT_LE(each->contacts().size(), 40u); // no step is on its way any more
        }
        const std::uint32_t growths = world.report().growths;
        for (World* each : {&world, &expected}) {
            each->step();
            std::vector<BodyDefinition> more;
            for (int i = 0; i < 1500; ++i)
                more.push_back(box_at({1000.0f + 3.0f * static_cast<float>(i), 50.0f, 0.0f}));
            each->add(more);
            each->step();
        }
        EXPECT_EQ(results_of(world), results_of(expected));
        EXPECT_EQ(world.state_hash(), expected.state_hash());
        if (world.report().growths > growths) ++growths_on_the_way;
    }
    EXPECT_GT(growths_on_the_way, 0);
}

TEST_P(ContactMemory, is_empty_after_a_step_that_broke_off_in_the_midst_of_the_solve) {
    PoorRun poor(GetParam(), true);
    poor.run->step(5);
    ASSERT_GT(read_contacts(poor.run->simulation).manifolds.size(), 4u);
    poor.device->faulty = &engine::store_contact_impulses;
    EXPECT_THROW(poor.run->step(), Error);
    const bool lost = GetParam() == DeviceKind::Gpu;
    EXPECT_EQ(read_contacts(poor.run->simulation).manifolds.empty(), lost) << "the CPU's constraints lie elsewhere";
    EXPECT_EQ(poor.run->counter(engine::k_counter_old_pair_count) == 0, lost);
    poor.device->faulty = nullptr;
    poor.run->step(20);
    EXPECT_GT(read_contacts(poor.run->simulation).manifolds.size(), 4u);
    for (const auto& pose : poor.run->read<engine::BodyPose>(BufferId::Poses, 6))
        EXPECT_NEAR(pose.position.x, 0.0f, 0.01f);
}

TEST_P(ContactMemory, takes_back_what_was_saved_before_a_step_that_broke_off) {
    for (const std::uint32_t steps : {5u, 6u}) { // the old contacts are the first half of the room, or the second
        PoorRun poor(GetParam(), true), rich(GetParam(), true);
        poor.run->step(steps);
        rich.run->step(steps);
        const uint count = poor.run->table.slot_count();
        poor.run->table.poses = poor.run->read<engine::BodyPose>(BufferId::Poses, count);
        poor.run->table.velocities = poor.run->read<engine::BodyVelocity>(BufferId::Velocities, count);
        const engine::SavedState saved = engine::save_state(poor.run->simulation, poor.run->table, poor.run->settings);
        poor.device->faulty = &engine::store_contact_impulses;
        EXPECT_THROW(poor.run->step(), Error);
        poor.device->faulty = nullptr;
        poor.run->simulation.restore(saved);
        poor.run->simulation.write(BufferId::Poses, 0, std::span<const engine::BodyPose>(saved.table.poses));
        poor.run->simulation.write(BufferId::Velocities, 0,
                                   std::span<const engine::BodyVelocity>(saved.table.velocities));
        EXPECT_TRUE(read_contacts(poor.run->simulation).impulses == read_contacts(rich.run->simulation).impulses);
        poor.run->step(3);
        rich.run->step(3);
        EXPECT_TRUE(poor.run->motion() == rich.run->motion()) << steps;
    }
}

TEST_P(ContactMemory, has_the_constraints_of_the_last_step_between_steps) {
    PoorRun run(GetParam(), true), expected(DeviceKind::Cpu, true);
    for (int i = 0; i < 4; ++i) {
        run.run->step();
        expected.run->step();
        const uint count = run.run->counter(engine::k_counter_manifold_count);
        ASSERT_EQ(run.run->simulation.kept_constraints(), count);
        ASSERT_EQ(count, 5u);
        const auto now = run.run->read<engine::ContactConstraint>(BufferId::Constraints, count);
        const auto then = expected.run->read<engine::ContactConstraint>(BufferId::Constraints, count);
        for (uint c = 0; c < count; ++c) {
            EXPECT_EQ(now[c].manifold, then[c].manifold);
            for (int k = 0; k < 4; ++k)
                EXPECT_EQ(now[c].total_impulse[k], then[c].total_impulse[k]);
        }
    }
}

TALUS_ON_EVERY_DEVICE(ContactMemory);

} // namespace
} // namespace talus::tests
