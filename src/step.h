// SPDX-License-Identifier: MIT
// One step of the world.
#pragma once

#include <bit>

#include "body_changes.h"
#include "device/device.h"

namespace talus::engine {

/// Which bodies the caller wakes before a step.
enum class Waking : std::uint8_t { None, Disturbed, All };

/// What the host knows of the bodies.
struct Population {
    uint slots = 0;           ///< body slots in use, holes included
    bool some_bounce = false; ///< there is a restitution above 0
    bool some_kinematic = false;
    Waking waking = Waking::None;
};

/// What the search for pairs looks for: those of bodies that have left their boxes, of so few that they are compared
/// with all others, or all.
enum class Search : uint { None = k_search_none, Strays = k_search_strays, All = k_search_all };

/// Of so many groups that a GPU can run at a time, the persistent launch leaves out one for other launches.
inline constexpr uint k_groups_a_spare = 64;

/// Whether such a step, by its number, collides all contacts that have nearly had their way, together (most_way). Else
/// one or two would have had it in each step.
inline bool collides_early(std::uint64_t step) {
    constexpr std::uint64_t k_steps_apart = 16;
    return step % k_steps_apart == 0;
}

/// What the host knows of a step before it runs: how large launches may be, and which passes there are.
struct StepPlan {
    BroadPhase broad_phase = BroadPhase::SweepAndPrune;
    uint body_count = 0;             ///< body slots in use
    Search search = Search::All;     ///< which gets launches, that it may turn out not to need
    bool makes_graph = true;         ///< the constraint graph gets launches; without them it has to be the last step's
    bool other_graph = false;        ///< the host knows that it is not the last step's; has makes_graph too
    uint pair_capacity = 0;          ///< room in the buffers that have a record a pair
    uint manifold_capacity = 0;      ///< room for the manifolds that are solved
    bool collides_early = false;     ///< see the function of this name
    bool constraints_beside = false; ///< they lie over no contacts: the next step may find those of this one's old ones
    bool records_last = false;       ///< so it was in the last step, whose records of bodies are there, too
    uint table_size = 0;             ///< slots of PairTable
    uint colour_capacity = 0;        ///< colours that get launches
    bool overflow = false;           ///< there may be an overflow set
    uint overflow_count = 0;         ///< most manifolds that it has had lately
    uint most_launched = k_none;     ///< most manifolds, or bodies, that launches have treated lately
    uint hub_capacity = 0;           ///< manifolds of hubs that there is room for; 0: hubs get no launches
    bool small = false;              ///< up to k_island_bodies body slots
    bool one_island = false;         ///< islands are not told apart: a kinematic body may be part of several
    bool in_groups = false;  ///< work groups solve islands: each of a small world, the little ones of a large world
    uint largest_island = 0; ///< manifolds, lately, in a small world
    bool singles = false;    ///< in a large world a work group may solve a single island, too large to share one
    uint joined_twice = 1u << 19; ///< bodies from which on islands are joined in two launches, see resolution.cpp
    uint least_multirate = k_least_multirate; ///< bodies, where islands may be multirate
    uint colouring_groups = 1;                ///< that colour new contacts, waiting for each other
    uint weighing_groups = 1;                 ///< that find the loads on hubs where no graph is made, in the same way
    uint persistent_groups = 0;  ///< that solve all else in one launch; 0: a launch for each colour and pass
    bool awaits_kernels = false; ///< these launches take the place of a quicker kernel, which is not ready
    uint least_substeps = 0;
    uint most_substeps = 0;
    uint substep_capacity = 1; ///< sub-steps, or ticks, that get launches: some, until it is known that none are needed
    uint iterations = 0;
    bool relax = false;
    bool bounces = false;   ///< some body has a restitution above 0
    bool kinematic = false; ///< some body moves as its caller says, whatever it touches
    bool sleeping = false;  ///< islands may sleep
    bool loads = false;     ///< there is room for loads on bodies; else none has one
    Waking waking = Waking::None;
    ContactWatch watch = ContactWatch::None;
    uint report_room = k_none; ///< contact events that leave with the step

    /// Islands are found, and each has sub-steps of its own.
    bool has_islands() const { return small || !one_island; }
    /// The search for all pairs is that of one work group.
    bool sweeps_in_group() const { return small && broad_phase == BroadPhase::SweepAndPrune; }
    /// In a large world; also where no more is wanted of them than whether they sleep.
    bool measures_islands() const { return !small && (!one_island || sleeping); }
    /// A kinematic body may touch several islands, and moves in one number of sub-steps; what bounces has hits, which
    /// are solved at once. The most sub-steps are the least, doubled some times.
    bool may_be_multirate() const {
        if (small || one_island || bounces || body_count < least_multirate) return false;
        return most_substeps % least_substeps == 0 && std::has_single_bit(most_substeps / least_substeps);
    }
    /// Of a contact in a multirate island: half of the least number of any other, if that is even and not the most.
    /// Not where bodies may sleep: what rests on softer contacts comes to rest later.
    uint fewest_substeps() const {
        const bool halves =
            may_be_multirate() && !sleeping && most_substeps > least_substeps && least_substeps % 2 == 0;
        return halves ? least_substeps / 2 : least_substeps;
    }
    /// Bodies from which on an island is multirate; k_none: none is. A hub counts as 1,025, unless parts of islands may
    /// sleep, for which islands are found before hubs.
    uint multirate_from() const { return may_be_multirate() ? least_multirate : k_none; }
    /// What rests in a large island may sleep while other parts of it move.
    bool sleeps_in_parts() const { return sleeping && !small; }
    bool has_groups() const { return in_groups && !small; }
    bool needs_launches() const { return !(in_groups && small); }
    /// One persistent launch may make all passes, if the device has groups for it. All others wait there for the one
    /// invocation that solves the overflow set.
    bool may_be_persistent() const {
        constexpr uint k_most_overflow = 64;
        return needs_launches() && substep_capacity > 0 && !bounces && overflow_count <= k_most_overflow;
    }
};

/// Where the parts of a step run: the same device twice, or the GPU for the detection and the CPU for the resolution.
struct Placement {
    Device* detection = nullptr;
    Device* resolution = nullptr;
    bool hybrid() const { return detection != resolution; }
    Device& of(Stage stage) const { return stage <= Stage::NarrowPhase ? *detection : *resolution; }
};

void run_stage(Device&, Stage, const StepPlan&);

/// Of a step, on the two devices or on one.
struct Tickets {
    Ticket detection = 0;
    Ticket resolution = 0;
};

/// Enqueues the changes and a step behind them; see Device::end_step. On a hybrid placement it waits for the detection.
Tickets step(const Placement&, const StepPlan&, bool with_poses, const BodyChanges& changes = {});

} // namespace talus::engine
