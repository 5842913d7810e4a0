// SPDX-License-Identifier: MIT
// Keeps steps going: owns the devices, has several steps on their way at once, and does a step again after growth when
// it did not fit.
#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <string>
#include <utility>

#include <talus/world.h>

#include "step.h"

namespace talus::engine {

struct SavedState;

/// Some launches are left out once so many steps in a row did not need them. Each time that one needs them after all,
/// and is done again, twice as many are asked for; after many without need the first number holds again.
class Trust {
public:
    bool holds() const { return calm_steps >= patience; }
    void note(bool needed);
    void begin_anew() { calm_steps = 0; }
    void was_wrong();

private:
    static constexpr uint k_first_patience =
        8; // as many as can be on their way: what they say may be of other settings
    static constexpr uint k_most_patience = 256, k_steps_of_trust = 512;
    static_assert(k_first_patience >= k_ring_size);
    uint calm_steps = 0;
    uint patience = k_first_patience;
};

/// What solves islands where work groups may do that.
enum class IslandSolve : std::uint8_t { Groups, Launches };

/// Where a simulation runs, and why there.
struct Devices {
    std::unique_ptr<Device> gpu; ///< at least one of the two is there
    std::unique_ptr<Device> cpu;
    DeviceKind kind = DeviceKind::Auto;
    std::string why;
};

/// As the options say. Throws Error where the device cannot be had.
Devices make_devices(const WorldOptions&);

class Simulation {
public:
    /// Throws Error where the device cannot be had.
    explicit Simulation(const WorldOptions& options) : Simulation(options, make_devices(options)) {}
    Simulation(const WorldOptions&, Devices);
    ~Simulation();

    const DeviceInfo& device() const { return info; }
    std::uint64_t memory_bytes() const;

    /// Makes room for body slots.
    void reserve_bodies(uint count);
    /// `elements`: records of the buffer's type, for the body slots from `first` on. Needs settle() before.
    template <typename T> void write(BufferId buffer, std::size_t first, std::span<const T> elements) {
        write_bytes(buffer, first * sizeof(T), std::as_bytes(elements));
    }

    /// Makes room for loads on bodies, as forces, before the first change that has one. There is none until then, but
    /// where bodies may sleep: loads also say who has to wake. Throws Error where there is no memory.
    void reserve_loads();
    /// As long as there is none, changes have no loads.
    bool has_room_for_loads() const { return has_loads; }

    /// Makes room for pairs, so that a step with no more of them fits.
    void reserve_pairs(uint count);

    /// Makes the steps that a saved state had made those of this simulation, and its last step's results the last
    /// one's; the bodies are not its business. Throws Error where there is no room, and has changed nothing then.
    void restore(const SavedState&);

    /// Waits for the steps on their way, and makes the room that others with such settings need. Throws Error where
    /// there is no memory; nothing else is changed.
    void reserve_for(const Settings&);
    void set_settings(const Settings&);
    /// The next step searches for pairs, whether that is due or not. Needs settle() before.
    void search_anew();
    bool watches_contacts() const { return plan.watch != ContactWatch::None; }
    /// Which contact reports steps make from now on. Waits for the steps on their way.
    void watch_contacts(ContactWatch);
    /// Enqueues a step; waits for the oldest one if too many are on their way.
    /// `changes` act before it, whatever is on its way. Needs reserve_bodies() for all slots before.
    void step(const Population&, bool with_poses, BodyChanges changes = {});
    /// Without a step, once those on their way are done.
    void change_bodies(const Population&, BodyChanges);
    /// Waits until every step is done, and has fitted.
    void settle();

    /// The plan of a step that would be enqueued now.
    StepPlan plan_step(const Population&) const;

    /// Whose buffers hold the state, and whose the pairs. Call settle() first.
    Device& state_device() const { return *placement.resolution; }
    Device& detection_device() const { return *placement.detection; }
    /// Whose buffers may be drawn from; null where there is none.
    Device* gpu_device() const { return gpu.get(); }
    /// Gives the GPU what the CPU has made, to be drawn. Call settle() first.
    void show_on_gpu();
    /// Waits for the steps on their way, and reads from the state's device.
    void read_state(std::span<const ReadRequest>);
    /// Of body records, so far.
    const Transfers& transfers() const { return transferred; }

    std::uint64_t step_count() const { return finished_count + pending.size(); }
    /// Of the newest finished step.
    const StepReport& report() const { return newest_report; }
    /// Constraints that the newest finished step has solved, and that still lie on the device: a step that came to
    /// nothing may have written over them.
    uint kept_constraints() const { return kept_count; }
    /// Collects what has finished meanwhile, without waiting.
    void poll();
    /// The newest finished step's poses as they came through the ring; empty if it was not asked for them.
    std::span<const BodyPose> newest_poses() const;

    /// A step's contact reports, in no particular order.
    struct StepReports {
        std::uint64_t step;
        std::vector<ContactReport> reports;
    };
    /// Those of the finished steps since the last call.
    std::vector<StepReports> take_reports() { return std::exchange(reports, {}); }

private:
    /// The next step's graph is not that of the step before, for what has happened between them; nor are the records
    /// that steps leave alone where bodies sleep.
    void begin_graph_anew();

    struct Pending {
        Tickets tickets;
        Population population;
        bool with_poses;
        BodyChanges changes;
        BroadPhase broad_phase = BroadPhase::Auto; // that the step used
        std::uint64_t launches = 0;
    };

    std::uint64_t launch_count() const;
    /// With nothing on its way.
    void write_bytes(BufferId, std::size_t offset, std::span<const std::byte>);
    /// For the steps that follow; those on their way do not see it.
    void write_behind_steps(BufferId, std::size_t offset, std::span<const std::byte>);
    void enqueue(Pending);
    /// With nothing on its way.
    void apply_now(const Population&, const BodyChanges&);
    void write_body_count(uint slots);
    /// The next step's plan without a persistent launch: with one for each colour and pass of all that no work groups
    /// solve.
    StepPlan plan_in_launches(const Population&, IslandSolve) const;
    /// Whether the next step's constraints are to have room beside the contacts.
    bool may_lie_beside(const Population&) const;
    /// Whether the persistent launch does a small world's largest island sooner than a work group, and may be had.
    bool may_leave_groups(const StepPlan& in_groups) const;
    /// That may run side by side of the persistent launch; 0 where it cannot make all passes of the plan.
    std::uint64_t persistent_invocations(const StepPlan&) const;
    /// Whether a step may launch one of the kernels that it can do without: they take a driver longest to compile.
    bool may_launch(const Kernel&) const;
    // ---- where steps are made: first_steps.cpp ----

    /// Before each step. The CPU makes the first ones while the GPU's driver compiles what none can do without.
    void choose_placement(const Population&);
    /// Where steps are made once the GPU's kernels are ready.
    Placement placement_with_kernels() const;
    /// Notes which kernels a step of such a world needs, and has the GPU's driver begin with them, side by side.
    void begin_kernels(const Population&);
    bool may_be_on_cpu(const Population&) const;
    void begin_on_cpu();
    void move_to_gpu();
    /// The CPU makes steps in the GPU's place.
    bool waits_on_cpu() const { return gpu && placement.detection != gpu.get(); }

    void grow_everywhere(BufferId, std::size_t elements);
    /// Makes room for what hits have to know of bodies and contacts, from the first body on that may bounce.
    void reserve_hits();
    /// What only worlds need in which bodies may sleep.
    void reserve_rests(uint bodies);
    void finish_oldest();
    void collect_reports(Ticket, std::span<const uint> counters);
    void grow_contacts(uint pairs, uint manifolds, uint bodies = 0);
    /// Of FastBodies, for so many body slots with such settings.
    uint words_of_fast_bodies(const Settings&, uint slots) const;
    /// For so many and some to spare, or at least for so many, at one go; 0: there is room.
    void make_contact_room(uint pairs, uint manifolds);
    void make_hub_room(uint manifolds);
    /// Room for them, if as many pairs touch as in the newest finished step, so that not each growth brings another.
    uint likely_manifolds(uint pairs) const;
    void redo(std::span<const uint> counters);
    /// Of a step that has been enqueued in part, as a driver could not make one of its kernels.
    void abandon_step();
    /// Where a step has begun to solve and came to nothing: its constraints may lie over the contacts of the last one.
    /// With nothing on its way. The next step starts from no impulses.
    void forget_contacts();
    /// After a launch whose groups have given up: puts inverse masses back where stamps of it are left.
    void mend_velocities();
    void follow_demand(std::span<const uint> counters);
    void reserve_hub_manifolds(uint count);
    void reserve_reports();

    std::unique_ptr<Device> gpu;
    std::unique_ptr<Device> cpu;
    Placement placement;
    DeviceInfo info;
    Settings settings;
    StepPlan plan;
    uint body_capacity = 0;
    uint enqueued_slots = 0;        ///< body slots of the newest step
    bool has_loads = false;         ///< see reserve_loads()
    bool has_hits = false;          ///< see reserve_hits()
    std::uint32_t cpu_threads = 0;  ///< WorldOptions::threads
    bool profiles = false;          ///< WorldOptions::profile
    bool waits_for_kernels = false; ///< WorldOptions::wait_for_kernels
    bool kernels_begun = false;
    std::vector<const Kernel*> needed_kernels;         ///< without which the GPU makes no step
    std::chrono::steady_clock::duration newest_time{}; ///< of the newest step, where the CPU made it
    Transfers transferred;

    std::deque<Pending> pending;
    std::uint64_t finished_count = 0;
    std::uint64_t pairs_grew_at = 0; ///< finished_count when there was last made room for more of them
    std::uint32_t growths = 0;
    Trust pairs_last;          ///< that a step need not search for pairs
    Trust list_lasts;          ///< that it need not search for all, nor strays the tree
    Trust graph_lasts;         ///< that a step need not make its constraint graph
    Trust few_are_solved;      ///< that constraints have room beside the contacts, as nearly all bodies sleep
    bool other_graph = true;   ///< see begin_graph_anew()
    bool other_records = true; ///< not all records of the device are as its newest step has left them
    StepPlan newest_plan;      ///< of the step that was enqueued last
    uint window_steps = 0;     ///< since the demand was last looked at
    uint window_colours = 0;   ///< most colours since
    uint window_substeps = 0;
    uint window_hub_manifolds = 0;
    uint window_overflow = 0, window_launched = 0;
    uint window_largest = 0;
    bool window_singles = false;
    StepReport newest_report;
    uint solved_count = 0;             ///< manifolds, by the newest finished step
    uint kept_count = 0;               ///< of their constraints
    Waking owed_waking = Waking::None; ///< of changes before steps that were given up
    Device* newest_device = nullptr;   ///< that made the newest finished step
    Ticket newest_ticket = 0;          ///< its
    bool newest_has_poses = false;
    std::vector<StepReports> reports;
};

} // namespace talus::engine
