// SPDX-License-Identifier: MIT
// Steps with the inside in sight: a set of bodies on a device, whose buffers a test may read between steps.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "body_table.h"
#include "parameters.h"
#include "resolution/resolution.h"
#include "simulation.h"

namespace talus::tests {

/// Of a persistent launch, where that many run side by side: all there are, and so few that invocations have many
/// contacts each.
inline constexpr std::array<engine::uint, 5> k_numbers_of_groups{engine::k_none, 1, 2, 3, 5};

class EngineRun {
public:
    EngineRun(const WorldOptions& options, const std::vector<BodyDefinition>& definitions, const Settings& wanted = {})
        : EngineRun(options, engine::make_devices(options), definitions, wanted) {}

    EngineRun(const WorldOptions& options, engine::Devices devices, const std::vector<BodyDefinition>& definitions,
              const Settings& wanted = {})
        : settings(wanted), simulation(options, std::move(devices)) {
        using engine::BufferId;
        simulation.set_settings(settings);
        for (const BodyDefinition& definition : definitions)
            table.add(definition);
        const engine::uint count = table.slot_count();
        simulation.reserve_bodies(count);
        simulation.write(BufferId::Poses, 0, std::span<const engine::BodyPose>(table.poses));
        simulation.write(BufferId::Velocities, 0, std::span<const engine::BodyVelocity>(table.velocities));
        simulation.write(BufferId::Shapes, 0, std::span<const engine::BodyShape>(table.shapes));
        simulation.write(BufferId::Properties, 0, std::span<const engine::BodyProperties>(table.properties));
        simulation.change_bodies(table.population(), {}); // these are all the bodies
    }

    void step(engine::uint count = 1) {
        for (engine::uint i = 0; i < count; ++i)
            simulation.step(table.population(), false);
        simulation.settle();
    }

    /// A step as large worlds make it: a launch a colour and pass, where a small world has its solve in one work group.
    void step_in_many_launches() {
        engine::StepPlan plan = plan_for_any_demand();
        plan.in_groups = false;
        plan.persistent_groups = 0;
        step_as(plan);
    }

    /// A step of a large world whose launches for colours and passes are a single one: of as many groups as run side by
    /// side, or fewer; of one where that is not known. Work groups may take the little islands.
    void step_persistently(bool in_groups, engine::uint most_groups = engine::k_none, engine::uint least_groups = 1) {
        engine::StepPlan plan = plan_for_any_demand();
        plan.in_groups = in_groups;
        reserve_fast_bodies(plan);
        const engine::uint groups = simulation.state_device().resident_groups(engine::persistent_solver(plan));
        plan.persistent_groups = std::max(std::min(groups, most_groups), least_groups);
        step_as(plan);
        if (counter(engine::k_counter_did_not_fit) != 0) return;
        for (const auto& velocity : read<engine::BodyVelocity>(engine::BufferId::Velocities, table.slot_count()))
            EXPECT_EQ(velocity.stamp, 0u) << "stamps are of the launch alone";
    }

    /// A step as it is made on hardware, also on a renderer in software: a work group for each island of a small world,
    /// and for each group of little ones in a large world; with singles also for each one of middling size. There the
    /// driver ends loops after 65,535 rounds, so few sub-steps and contacts are all that a test may ask for.
    void step_in_groups(bool bounces, bool singles = false) {
        engine::StepPlan plan = plan_for_any_demand();
        plan.in_groups = true;
        plan.persistent_groups = 0;
        plan.bounces = bounces;
        plan.singles = singles && plan.has_groups();
        step_as(plan);
    }

    /// The broad phase alone, of bodies as they are, which searches for all pairs; they are in the order in which it
    /// finds them. There has to be room for them.
    std::vector<engine::Pair> find_pairs(BroadPhase kind) {
        simulation.search_anew();
        return pairs_of_broad_phase(kind);
    }

    /// The same, but it may find that no search is due, or that of some bodies.
    std::vector<engine::Pair> pairs_of_broad_phase(BroadPhase kind) {
        engine::StepPlan plan = simulation.plan_step(table.population());
        plan.broad_phase = kind;
        engine::Device& device = simulation.state_device();
        device.set_parameters(engine::make_parameters(settings, plan));
        engine::run_stage(device, engine::Stage::BroadPhase, plan);
        return read<engine::Pair>(engine::BufferId::Pairs, counter(engine::k_counter_pair_count));
    }

    template <typename T> std::vector<T> read(engine::BufferId buffer, std::size_t count) const {
        std::vector<T> records(count);
        const engine::ReadRequest request{buffer, count * sizeof(T), records.data()};
        simulation.state_device().read({&request, 1});
        return records;
    }

    engine::uint counter(engine::uint word) const {
        return read<engine::uint>(engine::BufferId::Counters, engine::k_counter_words)[word];
    }

    /// The last step's manifolds, with impulses and colours; pairs that do not touch have no points.
    std::vector<engine::Manifold> manifolds() const {
        return read<engine::Manifold>(engine::BufferId::OldManifolds, counter(engine::k_counter_old_pair_count));
    }

    /// All poses and velocities as numbers. Two zeros of different sign are equal.
    std::vector<float> motion() const {
        std::vector<float> numbers = read<float>(engine::BufferId::Poses, 8 * std::size_t{table.slot_count()});
        const std::vector<float> velocities =
            read<float>(engine::BufferId::Velocities, 8 * std::size_t{table.slot_count()});
        numbers.insert(numbers.end(), velocities.begin(), velocities.end());
        return numbers;
    }

    Settings settings;
    engine::uint least_multirate =
        engine::k_least_multirate; ///< as StepPlan has it, in steps that say how they are made
    engine::BodyTable table;
    engine::Simulation simulation;

private:
    engine::uint uncounted_steps = 0; ///< which the simulation does not know of

    engine::StepPlan plan_for_any_demand() {
        engine::StepPlan plan = simulation.plan_step(table.population());
        plan.collides_early = engine::collides_early(simulation.step_count() + ++uncounted_steps);
        plan.substep_capacity = plan.most_substeps;
        plan.colour_capacity = engine::k_first_hub_colour;
        plan.overflow = true;
        plan.least_multirate = least_multirate;
        plan.other_graph = true; // the step before may have been made another way
        return plan;
    }

    /// The simulation has made room for no more than steps of its own need.
    void reserve_fast_bodies(const engine::StepPlan& plan) {
        engine::ContactDemand demand;
        demand.fast_words = engine::words_of_fast_bodies(plan);
        simulation.state_device().reserve_contacts(demand);
    }

    void step_as(const engine::StepPlan& plan) {
        engine::Device& device = simulation.state_device();
        device.set_parameters(engine::make_parameters(settings, plan));
        device.wait(engine::step({&device, &device}, plan, false).resolution);
    }
};

} // namespace talus::tests
