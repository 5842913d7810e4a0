// SPDX-License-Identifier: MIT
// Threads by oneTBB: an arena of their own, so that a program which uses oneTBB too keeps its settings.
#include "device/cpu/cpu_threads.h"

#include <optional>
#include <string>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include "device/cpu/flush_denormals.h"

namespace talus::engine {

struct CpuThreads::Arena {
    // oneTBB starts no more threads than the machine has unless it is told. It is told only where more are wanted,
    // because the limit holds for the whole process: it is never lowered from here.
    std::optional<tbb::global_control> limit;
    tbb::task_arena arena;

    explicit Arena(uint count) : arena(static_cast<int>(count)) {
        if (count > available_threads()) limit.emplace(tbb::global_control::max_allowed_parallelism, count);
        arena.initialize();
    }
};

CpuThreads::CpuThreads(uint count) : arena(std::make_unique<Arena>(count)) {}
CpuThreads::~CpuThreads() = default;

uint CpuThreads::count() const {
    return static_cast<uint>(arena->arena.max_concurrency());
}

void CpuThreads::run(uint count, uint grain, void (*range)(const void* context, uint begin, uint end),
                     const void* context) const {
    if (count <= grain || arena->arena.max_concurrency() == 1) {
        if (count > 0) range(context, 0, count);
        return;
    }
    arena->arena.execute([&] {
        tbb::parallel_for(tbb::blocked_range<uint>(0, count, grain), [&](const tbb::blocked_range<uint>& part) {
            const FlushDenormals flush; // a worker's mode is its own
            range(context, part.begin(), part.end());
        });
    });
}

uint available_threads() {
    return static_cast<uint>(tbb::info::default_concurrency());
}

uint threads_asked_for(uint wanted) {
    return wanted > 0 ? wanted : available_threads();
}

} // namespace talus::engine
