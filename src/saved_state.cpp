// SPDX-License-Identifier: MIT
// Reads and writes all of the state that a step leaves for the next one. Manifolds without points are kept: the next
// step asks them for more than their points.
#include "saved_state.h"

#include <algorithm>

#include "broad_phase/broad_phase.h"
#include "state/formulas.h"
#include "step_results.h"

namespace talus::engine {

static_assert(std::ranges::count(k_buffers, Role::State, &BufferInfo::role) == 15,
              "another buffer survives the step: snapshots have to hold it too");

std::size_t SavedState::bytes() const {
    std::size_t sum = sizeof *this + manifolds.size() * sizeof(Manifold) + points.size() * sizeof(ManifoldPoint) +
                      separations.size() * sizeof(Separations) + next_impulses.size() * sizeof(NormalImpulses) +
                      impulses.size() * sizeof(float) + contact_states.size() * sizeof(uint) +
                      starts.size() * sizeof(BodyStart) + rests.size() * sizeof(BodyRest) +
                      boxes.size() * sizeof(OrientedBox);
    BodyTable::visit_lists(table, [&](const auto& list) { sum += list.size() * sizeof list[0]; });
    return sum;
}

SavedState save_state(Simulation& simulation, const BodyTable& table, const Settings& settings) {
    ContactRecords contacts = read_contacts(simulation);
    SavedState saved{settings, simulation.report(), table, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}};
    if (simulation.watches_contacts()) {
        saved.contact_states.resize(contacts.manifolds.size());
        simulation.state_device().read(std::array{ReadRequest{
            BufferId::OldContactStates, saved.contact_states.size() * sizeof(uint), saved.contact_states.data()}});
    }
    if (settings.sleeping) {
        Device& device = simulation.state_device();
        saved.rests.resize(saved.table.slot_count());
        const std::size_t bytes = std::min(saved.rests.size() * sizeof(BodyRest), device.size(BufferId::Rests));
        device.read(std::array{ReadRequest{BufferId::Rests, bytes, saved.rests.data()}});
    }
    simulation.state_device().read(std::array{ReadRequest{BufferId::Counters, sizeof saved.counters, &saved.counters}});
    // Of a world that has lost slots since, the next step searches anew.
    uint& searched = saved.counters[k_counter_searched_slots];
    if (searched > table.slot_count()) searched = 0;
    saved.counters[k_counter_pair_demand] = saved.counters[k_counter_old_pair_count];
    saved.boxes.resize(searched);
    simulation.detection_device().read(
        std::array{ReadRequest{BufferId::OrientedBoxes, saved.boxes.size() * sizeof(OrientedBox), saved.boxes.data()}});
    // The table may have given up slots since the last step.
    saved.counters[k_counter_body_count] = std::min(saved.counters[k_counter_body_count], table.slot_count());
    for (std::size_t i = 0; i < contacts.manifolds.size(); ++i) {
        const std::size_t first = 4 * i, end = first + contacts.manifolds[i].point_count;
        if (end == first) contacts.separations[i] = {}; // nobody has written it
        for (std::size_t k = first; k < end; ++k) {
            saved.points.push_back(contacts.points[k]);
            saved.impulses.push_back(contacts.impulses[k]);
        }
    }
    saved.manifolds = std::move(contacts.manifolds);
    saved.separations = std::move(contacts.separations);
    saved.next_impulses = std::move(contacts.next_impulses);
    saved.starts = std::move(contacts.starts);
    saved.starts.resize(table.slot_count());
    for (const uint slot : table.changed_slots())
        if (table.is_dirty(slot, k_dirty_contacts)) saved.starts[slot] = forget_turn(saved.starts[slot]);
    return saved;
}

void Simulation::restore(const SavedState& saved) {
    settle();
    const auto pair_count = static_cast<uint>(saved.manifolds.size());
    reserve_bodies(saved.table.slot_count());
    if (!saved.rests.empty()) reserve_rests(body_capacity);
    if (saved.table.has_loads()) reserve_loads();
    reserve_for(saved.settings);

    std::vector<Pair> pairs;
    std::vector<ManifoldPoint> points(std::size_t{4} * pair_count);
    std::vector<ContactConstraint> constraints; // only what read_contacts reads: the next step makes them anew
    const BodyTable& table = saved.table;
    const auto sleeps = [&](const Manifold& manifold) {
        const uint a = manifold.body_a, b = manifold.body_b;
        return sleeps_through(table.poses[a], table.shapes[a], table.poses[b], table.shapes[b]);
    };
    std::size_t next = 0;
    for (uint i = 0; i < pair_count; ++i) {
        const Manifold& manifold = saved.manifolds[i];
        pairs.push_back({manifold.body_a, manifold.body_b});
        ContactConstraint constraint{};
        constraint.manifold = i;
        for (uint k = 0; k < manifold.point_count; ++k, ++next) {
            points[std::size_t{4} * i + k] = saved.points[next];
            constraint.total_impulse[static_cast<int>(k)] = saved.impulses[next];
        }
        if (is_active(manifold) && !sleeps(manifold)) constraints.push_back(constraint); // others are not solved
    }
    state_device().place_constraints(ConstraintPlace::OverNewContacts); // where there is room for all
    grow_contacts(pair_count, static_cast<uint>(constraints.size()));
    const auto write_all = [this](BufferId buffer, const auto& records) {
        if (!records.empty()) write(buffer, 0, std::span(records.data(), records.size()));
    };
    write_all(BufferId::Pairs, pairs);
    write_all(BufferId::OldManifolds, saved.manifolds);
    write_all(BufferId::OldManifoldPoints, points);
    write_all(BufferId::OldPointSeparations, saved.separations);
    write_all(BufferId::OldPointImpulses, saved.next_impulses);
    state_device().write(BufferId::Constraints, 0, std::as_bytes(std::span(constraints)));
    write_all(BufferId::Counters, saved.counters);
    write_all(BufferId::Starts, saved.starts);
    write_all(BufferId::Rests, saved.rests);
    write_all(BufferId::OrientedBoxes, saved.boxes);
    std::vector<Aabb> aabbs;
    for (const OrientedBox& box : saved.boxes)
        aabbs.push_back(compute_aabb(box));
    write_all(BufferId::Aabbs, aabbs);
    write_all(BufferId::SortValues, order_in_tree(aabbs)); // for strays, until all are searched for
    if (watches_contacts()) {
        std::vector<uint> states = saved.contact_states;
        states.resize(pair_count, k_contact_apart);
        write_all(BufferId::OldContactStates, states);
    }
    reports.clear();
    enqueued_slots = saved.counters[k_counter_body_count];

    finished_count = saved.report.step;
    newest_report = saved.report;
    solved_count = kept_count = static_cast<uint>(constraints.size());
    plan.most_launched = k_none;
    pairs_last.begin_anew();
    list_lasts.begin_anew();
    begin_graph_anew();
    settings.broad_phase = saved.settings.broad_phase; // so that no search is due which was none before
    newest_report.growths = growths;
    newest_has_poses = false;
}

} // namespace talus::engine
