// SPDX-License-Identifier: MIT
// The threads of a CPU device. oneTBB stays behind this header, so that twins do not compile it.
#pragma once

#include <memory>

#include "state/dialect.h"

namespace talus::engine {

class CpuThreads {
public:
    /// The caller of `run` is one of the `count` threads. Throws Error where the system refuses them.
    explicit CpuThreads(uint count);
    ~CpuThreads();
    CpuThreads(const CpuThreads&) = delete;
    CpuThreads& operator=(const CpuThreads&) = delete;

    uint count() const;

    /// Calls range(context, begin, end) for ranges of at least half a `grain` that together cover 0 to count - 1, in
    /// any order, with denormals flushed to zero; returns when all are done.
    void run(uint count, uint grain, void (*range)(const void* context, uint begin, uint end),
             const void* context) const;

private:
    struct Arena;
    std::unique_ptr<Arena> arena;
};

/// Threads that this process may use at once.
uint available_threads();
/// So many as a caller asks for; 0: all of these.
uint threads_asked_for(uint wanted);

} // namespace talus::engine
