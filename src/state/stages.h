// SPDX-License-Identifier: MIT
// The stages of the step in run order. Profiler rows, GL debug groups, reports, `talus parity` and the headings of
// docs/architecture.md take their names from here.
#pragma once

#include <array>

namespace talus::engine {

#define TALUS_STAGES(X)                                                                                                \
    X(BroadPhase, "broad_phase")                                                                                       \
    X(NarrowPhase, "narrow_phase")                                                                                     \
    X(ConstraintGraph, "constraint_graph")                                                                             \
    X(Prepare, "prepare")                                                                                              \
    X(Solve, "solve")                                                                                                  \
    X(StoreImpulses, "store_impulses")                                                                                 \
    X(Finish, "finish")

enum class Stage {
#define X(stage, name) stage,
    TALUS_STAGES(X)
#undef X
        count
};

inline constexpr std::size_t k_stage_count = static_cast<std::size_t>(Stage::count);

inline constexpr std::array<Stage, k_stage_count> k_stages{
#define X(stage, name) Stage::stage,
    TALUS_STAGES(X)
#undef X
};

inline constexpr std::array<const char*, k_stage_count> k_stage_names{
#define X(stage, name) name,
    TALUS_STAGES(X)
#undef X
};

} // namespace talus::engine
