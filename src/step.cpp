// SPDX-License-Identifier: MIT
// The step: every stage in run order. Start reading here.
#include "step.h"

#include "broad_phase/broad_phase.h"
#include "finish/finish.h"
#include "hand_over.h"
#include "narrow_phase/narrow_phase.h"
#include "resolution/resolution.h"

namespace talus::engine {

void run_stage(Device& device, Stage stage, const StepPlan& plan) {
    device.begin_stage(stage);
    switch (stage) {
    case Stage::BroadPhase:
        return broad_phase(device, plan); // boxes -> candidate pairs
    case Stage::NarrowPhase:
        return narrow_phase(device, plan); // pairs -> manifolds, old impulses matched
    case Stage::ConstraintGraph:
        return constraint_graph(device, plan); // manifolds -> batches without shared bodies
    case Stage::Prepare:
        return prepare(device, plan); // effective masses
    case Stage::Solve:
        return solve(device, plan); // sub-steps: velocities and movements
    case Stage::StoreImpulses:
        return store_impulses(device, plan); // for the next step's warm start
    case Stage::Finish:
        return finish(device, plan); // contact events, new poses
    case Stage::count:
        break;
    }
}

Tickets step(const Placement& placement, const StepPlan& plan, bool with_poses, const BodyChanges& changes) {
    apply_changes(*placement.resolution, changes);
    wake(*placement.resolution, plan);
    if (placement.hybrid()) {
        hand_over_counters(*placement.resolution, *placement.detection);
        apply_changes(*placement.detection, changes);
        hand_over_bodies(*placement.resolution, *placement.detection, plan); // who has been woken, too
    }
    Tickets tickets;
    for (const Stage stage : k_stages) {
        if (placement.hybrid() && stage == Stage::ConstraintGraph) {
            hand_over_manifolds(*placement.detection, *placement.resolution);
            // Contact events compare with the last step's manifolds.
            if (plan.watch != ContactWatch::None) index_old_manifolds(*placement.resolution);
            tickets.detection = placement.detection->end_step(false);
        }
        run_stage(placement.of(stage), stage, plan);
    }
    if (placement.hybrid()) hand_over_impulses(*placement.resolution, *placement.detection);
    const uint report_room = plan.watch != ContactWatch::None ? plan.report_room : 0;
    tickets.resolution = placement.resolution->end_step(with_poses, report_room);
    if (!placement.hybrid()) tickets.detection = tickets.resolution;
    return tickets;
}

} // namespace talus::engine
