// SPDX-License-Identifier: MIT
#include "simulation.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "body_table.h"
#include "broad_phase/broad_phase.h"
#include "finish/finish.h"
#include "log.h"
#include "parameters.h"
#include "resolution/resolution.h"
#include "state/formulas.h"

namespace talus::engine {
namespace {

constexpr uint k_first_bodies = 64;
constexpr uint k_first_pairs = 256;
constexpr uint k_first_colours = 8;
constexpr uint k_first_reports = 256;
// The ring keeps this many steps' results; one place stays free so that the newest finished step's are still there.
constexpr std::size_t k_most_pending = k_ring_size - 1;
// The heaviest load must not cost too much where a sub-step is launches for each colour.
constexpr uint k_most_substeps_of_large = 32;
// Manifolds and iterations an invocation of the persistent launch: with more, launches for each colour are long enough
// to be worth it, and all in one might be too long for a watchdog.
constexpr uint k_most_manifolds_each = 96;
// Bodies an invocation of it, where it had nothing to do of late: it may find them all in one island, once.
constexpr uint k_most_bodies_each = 48;
// Its contacts wait for each other longer than they work, so it is done soonest with two invocations for each. But it
// takes a multiprocessor for each group, and where work groups beside it have this many contacts for each invocation of
// the GPU, they need longer than it does: then its invocations have more contacts, and others the multiprocessors.
constexpr uint k_much_beside = 16;
constexpr uint k_manifolds_each_beside = 4;
// Manifolds of an island of a small world from which on it is done sooner by that launch than by one work group.
constexpr uint k_large_for_a_group = 900;
constexpr uint k_most_colours_to_leave = 20; // each is a wait, which costs a group little
// Pairs or manifolds, of which the share that comes and goes is small.
constexpr uint k_large_demand = 131'072;
// After so many steps launches for colours and sub-steps that none of them needed are given up.
constexpr uint k_demand_window = 64;

constexpr std::array k_body_buffers{
    BufferId::Poses,        BufferId::Velocities,    BufferId::Shapes,         BufferId::Properties,
    BufferId::Aabbs,        BufferId::SortKeys,      BufferId::SortValues,     BufferId::PairCounts,
    BufferId::Inertias,     BufferId::WarmStarts,    BufferId::Deltas,         BufferId::Islands,
    BufferId::Substeps,     BufferId::Hubs,          BufferId::IslandSizes,    BufferId::IslandStarts,
    BufferId::IslandGroups, BufferId::IslandFill,    BufferId::IslandBodies,   BufferId::IslandPlaces,
    BufferId::Starts,       BufferId::OrientedBoxes, BufferId::LaunchedBodies,
};

constexpr std::array k_pair_buffers{
    BufferId::Pairs,
    BufferId::ManifoldKeys,
    BufferId::ManifoldPlaces,
};

constexpr std::array k_report_buffers{
    BufferId::ContactImpulses,
    BufferId::ContactStates,
    BufferId::OldContactStates,
};

/// By a step for whose pairs there was no room: a search of all says so in the list's count, one of strays leaves that
/// alone.
uint pairs_wanted(std::span<const uint> counters) {
    return std::max(counters[k_counter_pair_demand], counters[k_counter_wanted_pairs]);
}

std::string what_did_not_fit(std::span<const uint> counters) {
    const uint reasons = counters[k_counter_did_not_fit];
    std::string what;
    const auto add = [&](uint reason, const char* name, uint demand) {
        if ((reasons & reason) != 0) what += fmt::format("{}{} {}", what.empty() ? "" : ", ", demand, name);
    };
    add(k_fit_pairs, "pairs", pairs_wanted(counters));
    add(k_fit_manifolds, "manifolds", counters[k_counter_manifold_count]);
    add(k_fit_colours, "colours", counters[k_counter_colour_demand]);
    add(k_fit_substeps, "sub-steps", counters[k_counter_substep_demand]);
    add(k_fit_hubs, "contacts of hubs", counters[k_counter_hub_manifolds]);
    add(k_fit_reports, "contact events", counters[k_counter_report_count]);
    return "buffers and launches grow: a step had " + what;
}

/// Bodies that the caller has moved are likely to have left their boxes.
bool moves_bodies(const BodyChanges& changes) {
    return std::ranges::any_of(changes, [](const RecordChanges& change) {
        return change.buffer == BufferId::Poses || change.buffer == BufferId::Velocities ||
               change.buffer == BufferId::Shapes;
    });
}

/// Loads are all that a caller changes in each step, and the graph knows nothing of them.
bool changes_the_graph(const BodyChanges& changes) {
    return std::ranges::any_of(changes, [](const RecordChanges& change) { return change.buffer != BufferId::Loads; });
}

/// Whether the two put the same manifolds into the same order, if the bodies and manifolds are the same.
bool has_the_graph_of(const StepPlan& plan, const StepPlan& other) {
    return plan.body_count == other.body_count && plan.one_island == other.one_island &&
           plan.in_groups == other.in_groups && plan.singles == other.singles && plan.bounces == other.bounces &&
           plan.may_be_multirate() == other.may_be_multirate();
}

/// What comes bit by bit goes on, and gets one part in `share` more; what comes all at once is what the caller has put
/// together.
uint with_headroom(uint demand, uint capacity, uint share = 4) {
    const bool comes_at_once = demand / 2 > capacity;
    return demand + demand / (!comes_at_once ? share : demand < k_large_demand ? 16 : 32);
}

/// Of small numbers a large share comes at a time, and each growth costs a step; of many it is the memory that counts.
uint share_of_manifolds(uint demand) {
    return demand < k_large_demand ? 2 : 16;
}

/// `goes_on`: they have grown lately, as those of a heap do while it falls, and will again.
uint share_of_pairs(uint demand, bool goes_on) {
    return demand < k_large_demand || goes_on ? 4 : 16;
}

} // namespace

void Trust::note(bool needed) {
    calm_steps = needed ? 0 : calm_steps + 1;
    if (calm_steps == k_steps_of_trust) patience = k_first_patience;
}

void Trust::was_wrong() {
    begin_anew();
    patience = std::min(2 * patience, k_most_patience);
}

Devices make_devices(const WorldOptions& options) {
    Devices devices;
    devices.kind = options.device;
    devices.why = "asked for";
    if (devices.kind == DeviceKind::Auto) {
        const std::vector<DeviceInfo> probes = probe_gl();
        const auto hardware =
            std::ranges::find_if(probes, [](const DeviceInfo& p) { return !p.in_software && !p.name.empty(); });
        const bool has_gpu = options.gl_context == GlContext::Current || hardware != probes.end();
        devices.kind = has_gpu ? DeviceKind::Gpu : DeviceKind::Cpu;
        devices.why = has_gpu
                          ? "there is a GPU"
                          : "no GPU was found: " + (probes.empty() ? std::string("EGL lists no device")
                                                    : probes.front().name.empty()
                                                        ? probes.front().why
                                                        : "OpenGL runs in software here (" + probes.front().name + ")");
    }
    if (devices.kind != DeviceKind::Cpu)
        devices.gpu = make_gl_device(options.gl_context, options.profile, options.gl_debug, options.program_cache);
    if (devices.kind != DeviceKind::Gpu) devices.cpu = make_cpu_device(options.threads, options.profile);
    return devices;
}

Simulation::Simulation(const WorldOptions& options, Devices devices)
    : gpu(std::move(devices.gpu)), cpu(std::move(devices.cpu)), cpu_threads(options.threads), profiles(options.profile),
      waits_for_kernels(options.wait_for_kernels) {
    info = (gpu ? gpu : cpu)->info();
    info.kind = devices.kind;
    placement = placement_with_kernels();
    info.why = devices.why;
    if (placement.hybrid()) {
        const DeviceInfo host = cpu->info();
        info.name += " and " + host.name;
        info.threads = host.threads;
    }

    log(LogLevel::Info, fmt::format("the world runs on {} ({}): {}", info.name, info.driver, info.why));

    const auto first = [](uint wanted, uint fallback) { return wanted > 0 ? wanted : fallback; };
    grow_everywhere(BufferId::Counters, k_counter_words);
    grow_everywhere(BufferId::Dispatches, k_dispatch_count);
    grow_everywhere(BufferId::SweepAxes, 1);
    grow_everywhere(BufferId::TreeGrids, 1);
    grow_everywhere(BufferId::HubChanges, 1);
    grow_everywhere(BufferId::Arrivals, k_arrival_words);
    reserve_rests(1);
    grow_everywhere(BufferId::Loads, 1);
    grow_everywhere(BufferId::ColourOffsets, k_offset_words);
    reserve_bodies(first(options.capacities.bodies, k_first_bodies));
    reserve_pairs(first(options.capacities.pairs, k_first_pairs));
    // Reports stay within the memory of the host where the resolution runs there.
    plan.report_room = cpu ? k_none : k_first_reports;
    plan.colour_capacity = std::min(first(options.capacities.colours, k_first_colours), k_first_hub_colour);
}

Simulation::~Simulation() = default;

std::uint64_t Simulation::memory_bytes() const {
    return (gpu ? gpu->memory_bytes() : 0) + (cpu ? cpu->memory_bytes() : 0);
}

std::uint64_t Simulation::launch_count() const {
    return placement.detection->launch_count() + (placement.hybrid() ? placement.resolution->launch_count() : 0);
}

void Simulation::grow_everywhere(BufferId buffer, std::size_t elements) {
    const std::size_t bytes = elements * k_buffers[static_cast<std::size_t>(buffer)].stride;
    for (Device* device : {gpu.get(), cpu.get()})
        if (device != nullptr) device->grow(buffer, bytes);
}

void Simulation::reserve_rests(uint bodies) {
    grow_everywhere(BufferId::Rests, bodies);
    grow_everywhere(BufferId::Balances, std::size_t{k_balance_words} * bodies);
}

void Simulation::reserve_bodies(uint count) {
    if (count <= body_capacity) return;
    settle(); // contacts move, and where they lie may be another half once a step on its way is done again
    const uint capacity = std::max(count, with_headroom(body_capacity, body_capacity));
    grow_contacts(0, 0, capacity); // first: what is searched for has to have room for all bodies that others have
    for (const BufferId buffer : k_body_buffers)
        grow_everywhere(buffer, capacity);
    if (has_loads) grow_everywhere(BufferId::Loads, capacity);
    grow_everywhere(BufferId::Strays, most_strays(capacity, true));
    grow_everywhere(BufferId::WideStrays, most_strays(capacity, true));
    grow_everywhere(BufferId::NearPairs, most_near_pairs(capacity));
    grow_everywhere(BufferId::NearTable, near_table_size(capacity));
    grow_everywhere(BufferId::SpreadSums, capacity / k_spread_group + 1);
    grow_everywhere(BufferId::BodyColours, std::size_t{k_body_words} * capacity);
    grow_everywhere(BufferId::ToldLoads, std::size_t{k_told_words + 1} * capacity);
    if (settings.sleeping) reserve_rests(capacity);
    body_capacity = capacity; // only now: a buffer may have no room
}

void Simulation::reserve_loads() {
    if (has_loads) return;
    grow_everywhere(BufferId::Loads, body_capacity);
    has_loads = true; // only now: a buffer may have no room
}

void Simulation::reserve_hits() {
    if (has_hits) return;
    grow_everywhere(BufferId::WarmStarts, records_with_hits(body_capacity, plan.manifold_capacity));
    has_hits = true;
}

void Simulation::reserve_pairs(uint count) {
    settle();
    grow_contacts(count, count);
}

void Simulation::grow_contacts(uint pairs, uint manifolds, uint bodies) {
    TALUS_ASSERT(pending.empty(), "contacts were to move while steps are on their way");
    other_records = true;
    if (pairs > k_most_pairs)
        throw Error(fmt::format("{} pairs of bodies are too many; at most {} are allowed", pairs, k_most_pairs));
    const uint pair_capacity = std::max(pairs, plan.pair_capacity);
    const uint manifold_capacity = std::max(manifolds, plan.manifold_capacity);
    for (const BufferId buffer : k_pair_buffers)
        grow_everywhere(buffer, pair_capacity);
    const uint slots = std::max(bodies, body_capacity);
    if (has_hits) grow_everywhere(BufferId::WarmStarts, records_with_hits(slots, manifold_capacity));
    const uint table_size = std::bit_ceil(2 * pair_capacity);
    const uint partners = k_kept_partners * slots; // the search keeps them in PairTable on a GPU
    ContactDemand demand{.pairs = pair_capacity,
                         .manifolds = manifold_capacity,
                         .table_size = std::max(table_size, partners),
                         .boxes = boxes_of_search(slots),
                         .sorted = std::max({pair_capacity, slots, k_mark_words}), // and marks of pairs lie there
                         .fast_words = words_of_fast_bodies(settings, slots),
                         .partners = partners,
                         .keeps_old = watches_contacts()};
    if (cpu) cpu->reserve_contacts(demand);
    if (info.kind == DeviceKind::Hybrid) { // nothing is solved, and no watch told, on the other one
        demand.manifolds = demand.fast_words = 0;
        demand.sorted = slots;
        demand.keeps_old = false;
    }
    if (gpu) gpu->reserve_contacts(demand);
    plan.pair_capacity = pair_capacity; // only now: a buffer may have no room
    plan.manifold_capacity = manifold_capacity;
    plan.table_size = table_size;
    if (watches_contacts()) reserve_reports();
}

void Simulation::reserve_reports() {
    for (const BufferId buffer : k_report_buffers)
        grow_everywhere(buffer, plan.pair_capacity);
    // A step reports on a pair once, and on one of the last step's at its end.
    grow_everywhere(BufferId::ContactReports, std::size_t{2} * plan.pair_capacity);
}

void Simulation::watch_contacts(ContactWatch wanted) {
    settle();
    const bool begins = plan.watch == ContactWatch::None && wanted != ContactWatch::None;
    plan.watch = wanted;
    if (!begins) return;
    try {
        grow_contacts(0, 0); // the same room, in which the old contacts last to the end of a step; and for reports
    } catch (const Error&) {
        plan.watch = ContactWatch::None;
        throw;
    }
    // What an earlier watch has left there is about other pairs.
    const std::vector<uint> apart(plan.pair_capacity, k_contact_apart);
    write(BufferId::OldContactStates, 0, std::span(apart));
}

void Simulation::reserve_hub_manifolds(uint count) {
    grow_everywhere(BufferId::HubChanges, count);
    plan.hub_capacity = count;
}

void Simulation::write_bytes(BufferId buffer, std::size_t offset, std::span<const std::byte> bytes) {
    TALUS_ASSERT(pending.empty(), "a buffer was to be written while steps are on their way");
    write_behind_steps(buffer, offset, bytes);
}

void Simulation::write_behind_steps(BufferId buffer, std::size_t offset, std::span<const std::byte> bytes) {
    placement.resolution->write(buffer, offset, bytes);
    if (placement.hybrid()) placement.detection->write(buffer, offset, bytes);
}

void Simulation::reserve_for(const Settings& wanted) {
    settle();
    if (wanted.sleeping) {
        reserve_rests(body_capacity);
        reserve_loads(); // which say who has to wake
    }
    ContactDemand demand; // the room keeps what it has of all else
    demand.fast_words = words_of_fast_bodies(wanted, body_capacity);
    if (!gpu || placement.hybrid() || demand.fast_words <= words_of_fast_bodies(settings, body_capacity)) return;
    other_records = true;
    gpu->reserve_contacts(demand);
}

void Simulation::set_settings(const Settings& wanted) {
    reserve_for(wanted);
    if (wanted.broad_phase != settings.broad_phase) search_anew();
    begin_graph_anew();
    settings = wanted;
}

void Simulation::begin_graph_anew() {
    other_graph = other_records = true;
    graph_lasts.begin_anew();
}

void Simulation::search_anew() {
    static_assert(k_counter_pairs_changed == k_counter_searched_slots + 1);
    constexpr std::array<uint, 2> none{};
    write_behind_steps(BufferId::Counters, k_counter_searched_slots * sizeof(uint), std::as_bytes(std::span(none)));
    pairs_last.begin_anew();
    list_lasts.begin_anew();
    begin_graph_anew();
}

void Simulation::step(const Population& population, bool with_poses, BodyChanges changes) {
    transferred.to_device += bytes_of(changes);
    Population asked = population;
    try {
        poll();
        while (pending.size() >= k_most_pending)
            finish_oldest();
        asked.waking = std::max(asked.waking, std::exchange(owed_waking, Waking::None));
        if (asked.some_bounce) reserve_hits();
        choose_placement(asked);
    } catch (const Error&) {
        // A kernel is faulty, or there is no room: what the caller has changed is not to be lost.
        owed_waking = std::max(owed_waking, asked.waking);
        apply_now(asked, changes);
        throw;
    }
    const auto before = std::chrono::steady_clock::now();
    enqueue({{}, asked, with_poses, std::move(changes)});
    newest_time = std::chrono::steady_clock::now() - before;
}

void Simulation::change_bodies(const Population& population, BodyChanges changes) {
    transferred.to_device += bytes_of(changes);
    try {
        settle();
    } catch (const Error&) {
        apply_now(population, changes);
        throw;
    }
    apply_now(population, changes);
}

void Simulation::apply_now(const Population& population, const BodyChanges& changes) {
    if (population.slots != enqueued_slots || changes_the_graph(changes)) begin_graph_anew();
    write_body_count(population.slots);
    apply_changes(*placement.resolution, changes);
    if (placement.hybrid()) apply_changes(*placement.detection, changes);
    placement.detection->leave();
}

void Simulation::read_state(std::span<const ReadRequest> requests) {
    settle();
    for (const ReadRequest& request : requests)
        transferred.to_host += request.bytes;
    placement.resolution->read(requests);
}

void Simulation::write_body_count(uint slots) {
    if (slots == enqueued_slots) return;
    write_behind_steps(BufferId::Counters, k_counter_body_count * sizeof(uint), std::as_bytes(std::span(&slots, 1)));
    enqueued_slots = slots;
}

/// `plan.small` is known.
static void set_passes(StepPlan& plan, const Settings& settings) {
    const Passes passes = passes_of(settings);
    plan.iterations = passes.iterations;
    plan.relax = passes.relax;
    plan.sleeping = settings.sleeping;
    plan.least_substeps = passes.least_substeps;
    plan.most_substeps = plan.small ? passes.most_substeps
                                    : std::clamp(k_most_substeps_of_large, passes.least_substeps, passes.most_substeps);
}

uint Simulation::words_of_fast_bodies(const Settings& of, uint slots) const {
    StepPlan multirate = plan;
    multirate.body_count = slots;
    multirate.small = slots <= k_island_bodies;
    multirate.one_island = multirate.bounces = false;
    set_passes(multirate, of);
    return engine::words_of_fast_bodies(multirate);
}

StepPlan Simulation::plan_in_launches(const Population& population, IslandSolve solve) const {
    StepPlan now = plan;
    now.body_count = population.slots;
    now.small = population.slots <= k_island_bodies;
    now.collides_early = collides_early(step_count() + 1);
    set_passes(now, settings);
    now.broad_phase = settings.broad_phase;
    if (now.broad_phase == BroadPhase::Auto) now.broad_phase = now.small ? BroadPhase::SweepAndPrune : BroadPhase::Bvh;
    now.one_island = population.some_kinematic;
    const bool one_group_each = now.small && plan.hub_capacity == 0;
    const bool may_have_groups = now.small ? one_group_each : !now.one_island;
    now.in_groups = solve == IslandSolve::Groups && may_have_groups && placement.resolution->loops_freely();
    now.singles = plan.singles && now.has_groups();
    now.bounces = population.some_bounce;
    now.kinematic = population.some_kinematic;
    now.loads = has_loads;
    now.waking = settings.sleeping ? population.waking : Waking::None;
    if (may_lie_beside(population)) {
        now.constraints_beside = true;
        now.manifold_capacity = std::min(plan.manifold_capacity, placement.resolution->constraints_beside());
    }
    if (settings.solve_order == SolveOrder::Sequential) now.overflow_count = k_none; // all
    now.overflow = now.overflow_count > 0;
    // None where work groups have lately done all the work, or all has slept.
    const bool launches = !(now.has_groups() || (now.sleeping && !now.small)) || plan.substep_capacity > 0;
    now.substep_capacity = launches ? std::clamp(plan.substep_capacity, now.least_substeps, now.most_substeps) : 0;
    if (!launches) now.colour_capacity = 0;
    return now;
}

bool Simulation::may_lie_beside(const Population& population) const {
    return !placement.hybrid() && population.waking == Waking::None && few_are_solved.holds() &&
           placement.resolution->constraints_beside() > 0;
}

/// The invocations that the persistent launch is to have on a GPU that can run so many of its kernel at a time. Those
/// that have nothing to do only make the wait longer, and take the room of launches beside it. What wakes, or becomes
/// one large island, shows some steps later: then no invocation shall have too much.
static std::uint64_t persistent_workers(const StepPlan& plan, std::uint64_t solved, std::uint64_t invocations) {
    const std::uint64_t least = plan.waking != Waking::None ? k_none : plan.body_count / k_most_bodies_each;
    const std::uint64_t launched = plan.most_launched;
    const std::uint64_t beside = plan.has_groups() && solved > launched ? solved - launched : 0;
    const bool much_beside = beside >= k_much_beside * invocations;
    return std::max(much_beside ? launched / k_manifolds_each_beside : 2 * launched, least);
}

bool Simulation::may_launch(const Kernel& kernel) const {
    return waits_for_kernels || placement.resolution->is_ready(kernel);
}

bool Simulation::may_leave_groups(const StepPlan& in_groups) const {
    if (!in_groups.small || !in_groups.in_groups || in_groups.largest_island < k_large_for_a_group) return false;
    StepPlan launched = in_groups;
    launched.in_groups = false;
    // With many colours, or where one invocation has some contacts to itself, a group is quicker.
    if (!launched.may_be_persistent() || launched.overflow || newest_report.colours > k_most_colours_to_leave)
        return false;
    if (!placement.resolution->is_ready(persistent_solver(launched))) return false; // and need not be
    return persistent_invocations(launched) >= std::uint64_t{2} * in_groups.largest_island;
}

std::uint64_t Simulation::persistent_invocations(const StepPlan& now) const {
    const Kernel& persistent = persistent_solver(now);
    const std::uint64_t invocations =
        std::uint64_t{placement.resolution->resident_groups(persistent)} * persistent.items_a_group;
    const std::uint64_t passes = std::uint64_t{solved_count} * now.iterations;
    return passes <= k_most_manifolds_each * invocations ? invocations : 0;
}

StepPlan Simulation::plan_step(const Population& population) const {
    StepPlan now = plan_in_launches(population, IslandSolve::Groups);
    if (may_leave_groups(now)) now = plan_in_launches(population, IslandSolve::Launches);
    // What the quickest plan has no use for is not asked for. What it has is, all at once: a driver compiles side by
    // side.
    const bool may_be_persistent = now.may_be_persistent() && placement.resolution->loops_freely();
    const Kernel& persistent = persistent_solver(now);
    const bool awaits_groups = now.in_groups && !may_launch(group_solver(now));
    const bool awaits_singles = now.singles && !may_launch(single_solver(now));
    const bool awaits_persistent = may_be_persistent && !may_launch(persistent);
    if (awaits_groups) now = plan_in_launches(population, IslandSolve::Launches);
    now.singles = now.singles && !awaits_singles;
    now.awaits_kernels = awaits_groups || awaits_singles || awaits_persistent;
    if (now.hub_capacity > 0) now.weighing_groups = std::max(placement.resolution->resident_groups(weigh_hubs), 1u);
    if (!now.small) now.colouring_groups = std::max(placement.resolution->resident_groups(assign_colours), 1u);
    if (!may_be_persistent || awaits_persistent) return now;
    const std::uint64_t invocations = persistent_invocations(now);
    if (invocations == 0) return now;
    const auto groups = static_cast<uint>(invocations / persistent.items_a_group);
    const std::uint64_t workers = persistent_workers(now, solved_count, invocations);
    // Islands that work groups solve are to run beside it, and it takes all of a multiprocessor for each of its groups.
    const uint spare = now.has_groups() ? groups / k_groups_a_spare : 0;
    now.persistent_groups =
        static_cast<uint>(std::min<std::uint64_t>(groups - spare, workers / persistent.items_a_group + 1));
    now.colour_capacity = k_first_hub_colour; // nothing has to be known beforehand
    now.overflow = true;
    now.substep_capacity = now.most_substeps;
    return now;
}

void Simulation::enqueue(Pending entry) {
    StepPlan now = plan_step(entry.population);
    const bool other_bodies = entry.population.slots != enqueued_slots;
    const bool strays = !pairs_last.holds(), all = !list_lasts.holds() || moves_bodies(entry.changes) || other_bodies;
    now.search = all ? Search::All : strays ? Search::Strays : Search::None;
    now.other_graph = std::exchange(other_graph, false) || changes_the_graph(entry.changes) || placement.hybrid() ||
                      !has_the_graph_of(now, newest_plan);
    now.makes_graph = now.other_graph || !graph_lasts.holds();
    now.records_last = !std::exchange(other_records, false) && now.sleeping && newest_plan.constraints_beside;
    if (now.awaits_kernels != newest_plan.awaits_kernels)
        log(LogLevel::Info, now.awaits_kernels
                                ? "the quickest kernels are still being compiled: until they are ready, a "
                                  "step takes others, with the same bits"
                                : "the quickest kernels are ready");
    newest_plan = now;
    const Parameters parameters = make_parameters(settings, now);
    placement.detection->set_parameters(parameters);
    if (placement.hybrid()) placement.resolution->set_parameters(parameters);
    write_body_count(entry.population.slots);
    const std::uint64_t launches_before = launch_count();
    try {
        entry.tickets = engine::step(placement, now, entry.with_poses, entry.changes);
    } catch (const Error&) {
        other_graph = now.other_graph; // the next step's
        other_records = true;
        owed_waking = std::max(owed_waking, entry.population.waking);
        if (launch_count() != launches_before) abandon_step();
        throw;
    }
    entry.launches = launch_count() - launches_before;
    entry.broad_phase = now.broad_phase;
    pending.push_back(std::move(entry));
}

void Simulation::abandon_step() {
    settle();
    kept_count = 0;
    if (!placement.resolution->has_old_contacts()) {
        forget_contacts();
        placement.resolution->swap_contacts(); // so that constraints no longer lie where contacts may be put back
    }
    search_anew();
}

void Simulation::poll() {
    while (!pending.empty() && placement.resolution->finished(pending.front().tickets.resolution))
        finish_oldest();
}

void Simulation::settle() {
    if (!pending.empty()) ++transferred.waits;
    while (!pending.empty())
        finish_oldest();
}

void Simulation::finish_oldest() {
    const Pending& done = pending.front();
    Device& device = *placement.resolution;
    const Tickets tickets = done.tickets;
    device.wait(tickets.resolution);
    const std::span<const uint> counters = device.counters(tickets.resolution);
    const uint reasons = counters[k_counter_did_not_fit];
    if ((reasons & ~k_fit_reports) != 0) {
        redo(counters);
        return;
    }
    ++finished_count;
    pairs_last.note(counters[k_counter_strayed] != 0);
    list_lasts.note(counters[k_counter_searched] != 0 || counters[k_counter_searched_tree] != 0);
    graph_lasts.note(counters[k_counter_graph_was_due] != 0);
    const bool some_sleep = counters[k_counter_sleeping_bodies] > 0;
    few_are_solved.note(!some_sleep || counters[k_counter_manifold_count] >= device.constraints_beside() / 2);
    newest_device = &device;
    newest_ticket = tickets.resolution;
    if (info.kind == DeviceKind::Gpu && !waits_on_cpu()) cpu.reset(); // that may have made the step before
    newest_has_poses = done.with_poses;
    newest_report.dispatches = static_cast<std::uint32_t>(done.launches);
    newest_report.broad_phase = done.broad_phase;
    pending.pop_front();

    StepReport& report = newest_report;
    report.step = finished_count;
    report.device = waits_on_cpu() ? DeviceKind::Cpu : info.kind;
    report.pairs = counters[k_counter_pair_count];
    solved_count = counters[k_counter_manifold_count];
    kept_count = solved_count;
    report.manifolds = solved_count + counters[k_counter_sleeping_manifolds];
    report.sleeping_bodies = counters[k_counter_sleeping_bodies];
    report.contacts = counters[k_counter_contact_count];
    report.colours = counters[k_counter_colour_demand];
    report.hubs = counters[k_counter_hub_count];
    report.overflow_manifolds = counters[k_counter_overflow_count];
    report.substeps = counters[k_counter_substep_demand];
    if (counters[k_counter_frozen_bodies] > report.frozen_bodies)
        log(LogLevel::Warning, fmt::format("step {}: {} bodies have become non-finite so far, and are frozen",
                                           report.step, counters[k_counter_frozen_bodies]));
    report.frozen_bodies = counters[k_counter_frozen_bodies];
    report.growths = growths;
    const std::span<const double> stage_ms = device.stage_ms(newest_ticket);
    report.stage_ms.assign(stage_ms.begin(), stage_ms.end());
    if (placement.hybrid()) {
        placement.detection->wait(tickets.detection);
        const std::span<const double> detection_ms = placement.detection->stage_ms(tickets.detection);
        for (std::size_t i = 0; i < detection_ms.size(); ++i)
            report.stage_ms[i] += detection_ms[i];
    }
    report.step_ms = std::accumulate(report.stage_ms.begin(), report.stage_ms.end(), 0.0);
    follow_demand(counters);
    if (plan.watch != ContactWatch::None) collect_reports(newest_ticket, counters);
    if (reasons != 0) redo(counters); // the steps behind it
}

void Simulation::collect_reports(Ticket ticket, std::span<const uint> counters) {
    Device& device = *placement.resolution;
    const uint count = counters[k_counter_report_count];
    StepReports& newest = reports.emplace_back(StepReports{finished_count, {}});
    if (count <= plan.report_room) {
        const std::span<const ContactReport> left = device.reports(ticket);
        TALUS_ASSERT(left.size() == count, "a contact report was lost on its way to the host");
        newest.reports.assign(left.begin(), left.end());
    } else { // the steps behind it have left the device's buffer as it was
        newest.reports.resize(count);
        device.read(
            std::array{ReadRequest{BufferId::ContactReports, count * sizeof(ContactReport), newest.reports.data()}});
        plan.report_room = with_headroom(count, plan.report_room);
    }
    if (count == 0) reports.pop_back();
}

void Simulation::follow_demand(std::span<const uint> counters) {
    const uint colours = counters[k_counter_launched_colours], substeps = counters[k_counter_launched_substeps];
    const uint hub_manifolds = counters[k_counter_hub_manifolds];
    const uint overflow_count = counters[k_counter_launched_overflow];
    const bool singles = counters[k_counter_singles] > 0;
    plan.overflow_count = std::max(plan.overflow_count, overflow_count);
    window_overflow = std::max(window_overflow, overflow_count);
    const uint launched = std::max(counters[k_counter_launched_manifolds], counters[k_counter_launched_bodies]);
    plan.most_launched = std::max(plan.most_launched, launched);
    window_launched = std::max(window_launched, launched);
    plan.largest_island = std::max(plan.largest_island, counters[k_counter_largest_island]);
    window_largest = std::max(window_largest, counters[k_counter_largest_island]);
    plan.singles = plan.singles || singles;
    window_singles = window_singles || singles;
    const uint wanted_colours = std::min(colours + 1, k_first_hub_colour); // one to spare
    plan.colour_capacity = std::max(plan.colour_capacity, wanted_colours);
    plan.substep_capacity = std::max(plan.substep_capacity, substeps);
    window_colours = std::max(window_colours, wanted_colours);
    window_substeps = std::max(window_substeps, substeps);
    window_hub_manifolds = std::max(window_hub_manifolds, hub_manifolds);
    if (++window_steps < k_demand_window) return;
    plan.colour_capacity = window_colours;
    plan.substep_capacity = window_substeps;
    plan.overflow_count = window_overflow;
    plan.most_launched = window_launched;
    plan.largest_island = window_largest;
    plan.singles = window_singles;
    if (window_hub_manifolds == 0) plan.hub_capacity = 0;
    window_singles = false;
    window_steps = window_largest = window_overflow = window_launched = window_colours = window_substeps =
        window_hub_manifolds = 0;
}

void Simulation::make_contact_room(uint pairs, uint manifolds) {
    const bool goes_on = finished_count < pairs_grew_at + k_demand_window;
    const uint pair_room = with_headroom(pairs, plan.pair_capacity, share_of_pairs(pairs, goes_on));
    if (pairs > plan.pair_capacity) pairs_grew_at = finished_count;
    const uint manifold_room = std::max(with_headroom(manifolds, plan.manifold_capacity, share_of_manifolds(manifolds)),
                                        likely_manifolds(pairs));
    try {
        grow_contacts(pair_room, std::min(manifold_room, std::max(pair_room, plan.pair_capacity)));
    } catch (const Error&) {
        grow_contacts(pairs, manifolds);
    }
}

void Simulation::make_hub_room(uint manifolds) {
    try {
        reserve_hub_manifolds(with_headroom(manifolds, plan.hub_capacity));
    } catch (const Error&) {
        reserve_hub_manifolds(manifolds);
    }
}

uint Simulation::likely_manifolds(uint pairs) const {
    const std::uint64_t pairs_before = report().pairs;
    if (pairs_before == 0) return 0;
    const auto likely = static_cast<uint>(std::uint64_t{solved_count} * pairs / pairs_before);
    return with_headroom(likely, plan.manifold_capacity, share_of_manifolds(likely));
}

void Simulation::mend_velocities() {
    Device& device = *placement.resolution;
    const std::size_t count = device.size(BufferId::Velocities) / sizeof(BodyVelocity);
    std::vector<BodyVelocity> velocities(count);
    std::vector<BodyProperties> properties(count);
    std::vector<BodyPose> poses(count);
    device.read(std::array{
        ReadRequest{BufferId::Velocities, count * sizeof(BodyVelocity), velocities.data()},
        ReadRequest{BufferId::Properties, count * sizeof(BodyProperties), properties.data()},
        ReadRequest{BufferId::Poses, count * sizeof(BodyPose), poses.data()},
    });
    for (std::size_t i = 0; i < count; ++i) {
        const bool frozen = (poses[i].flags & k_body_frozen) != 0;
        velocities[i].inverse_mass = frozen ? 0.0f : properties[i].inverse_mass;
        velocities[i].stamp = 0;
    }
    write_bytes(BufferId::Velocities, 0, std::as_bytes(std::span(velocities)));
}

void Simulation::forget_contacts() {
    constexpr uint none = 0;
    write_bytes(BufferId::Counters, k_counter_old_pair_count * sizeof(uint), std::as_bytes(std::span(&none, 1)));
    newest_report.pairs = newest_report.manifolds = newest_report.contacts = 0;
    solved_count = kept_count = 0;
    owed_waking = Waking::All; // what touches what sleeps is not known
}

void Simulation::redo(std::span<const uint> counters) {
    const uint reasons = counters[k_counter_did_not_fit];
    const uint pair_demand = pairs_wanted(counters);
    const uint manifolds = counters[k_counter_manifold_count];
    const uint hub_manifolds = counters[k_counter_hub_manifolds];
    if ((reasons & ~k_fit_graph) != 0) pairs_last.begin_anew();
    if ((reasons & ~(k_fit_graph | k_fit_strays)) != 0) list_lasts.begin_anew();
    graph_lasts.begin_anew();
    if ((reasons & k_fit_strays) != 0) pairs_last.was_wrong();
    if ((reasons & k_fit_all) != 0) list_lasts.was_wrong();
    if ((reasons & k_fit_graph) != 0) graph_lasts.was_wrong();
    const bool manifolds_grow = (reasons & k_fit_manifolds) != 0 && manifolds > plan.manifold_capacity;
    // Constraints that had no room beside the contacts lie over these, as they otherwise do.
    if ((reasons & k_fit_manifolds) != 0 && !manifolds_grow) few_are_solved.was_wrong();
    if (manifolds_grow || (reasons & ~(k_fit_strays | k_fit_all | k_fit_graph | k_fit_manifolds)) != 0) {
        log(LogLevel::Info, what_did_not_fit(counters));
        ++growths;
    }
    if ((reasons & (k_fit_colours | k_fit_substeps)) != 0) follow_demand(counters);
    newest_has_poses = false; // the ring goes on, and soon has no room for that frame

    other_records = true;
    // The steps behind it changed nothing either, but each has exchanged the manifolds with the old ones; and a step
    // that broke off behind them has put the constraints over these.
    std::deque<Pending> again = std::exchange(pending, {});
    Device& device = *placement.resolution;
    if (!again.empty()) device.wait(again.back().tickets.resolution);
    for (std::size_t i = 0; i < again.size(); ++i)
        swap_manifolds(device);
    constexpr uint fits = 0;
    write_bytes(BufferId::Counters, k_counter_did_not_fit * sizeof(uint), std::as_bytes(std::span(&fits, 1)));
    try {
        if ((reasons & k_fit_search) != 0)
            throw Error(
                "a body has so many others around it that this renderer, which ends long loops, does not search the "
                "tree of the broad phase to the end; the device Cpu does");
        if ((reasons & k_fit_groups) != 0) {
            mend_velocities();
            if (!watches_contacts()) forget_contacts();
            throw Error(
                "this GPU did not run work groups, or the invocations of one, side by side as they need, so a step "
                "went wrong; TALUS_RESIDENT_GROUPS=0 in the environment has them meet at barriers instead");
        }
        if ((reasons & k_fit_pairs) != 0 || manifolds_grow)
            make_contact_room((reasons & k_fit_pairs) != 0 ? pair_demand : 0, manifolds_grow ? manifolds : 0);
        if ((reasons & k_fit_hubs) != 0) make_hub_room(hub_manifolds);
    } catch (const Error&) {
        // The world is left as it was before these steps, but for what the caller has changed, and for what groups
        // which gave up have changed. Only what the last step's impulses were may be lost, if not what the next one
        // starts from: new contacts, or what comes before them, may lie over the constraints.
        kept_count = 0;
        for (const Pending& entry : again) {
            apply_now(entry.population, entry.changes);
            owed_waking = std::max(owed_waking, entry.population.waking);
        }
        search_anew(); // pairs and boxes may be of a search that came to nothing
        throw;
    }
    while (!again.empty()) {
        Pending entry = std::move(again.front());
        again.pop_front();
        try {
            enqueue(std::move(entry));
        } catch (const Error&) { // nor is what the caller has changed before the others lost
            settle();
            for (const Pending& other : again) {
                apply_now(other.population, other.changes);
                owed_waking = std::max(owed_waking, other.population.waking);
            }
            search_anew();
            throw;
        }
    }
}

std::span<const BodyPose> Simulation::newest_poses() const {
    if (!newest_has_poses) return {};
    return newest_device->poses(newest_ticket);
}

} // namespace talus::engine
