// SPDX-License-Identifier: MIT
// The state as the CPU twins see it: one typed array a buffer, the step's constants, and the threads to run loops on.
#pragma once

#include <algorithm>
#include <memory>

#include "device/cpu/cpu_threads.h"
#include "device/device.h"

namespace talus::engine {

/// A buffer in the host's memory. As with a GLSL block, whoever may see it may write to its elements.
template <typename T> struct Array {
    T* data = nullptr;
    std::size_t size = 0; ///< elements
    T& operator[](std::size_t i) const { return data[i]; }
};

/// Items that make a loop worth a second thread, where one item is a body or a pair.
inline constexpr uint k_parallel_grain = 256;

struct CpuState {
#define X(block, field, element, layout, role) Array<element> field;
    TALUS_BUFFERS(X)
#undef X
    Parameters parameters{};

    /// The buffer that a block stands for which a launch may bind. Only for buffers of words.
    Array<uint> words(BufferId) const;

    /// Calls body(i) for every i below count, on all threads of the device. Which thread takes which item, and in which
    /// order, must not matter. Loops of fewer than `grain` items run on the caller's thread.
    template <typename Body> void parallel(uint count, const Body& body, uint grain = k_parallel_grain) const {
        const auto range = [](const void* context, uint begin, uint end) {
            const Body& call = *static_cast<const Body*>(context);
            for (uint i = begin; i < end; ++i)
                call(i);
        };
        threads->run(count, grain, range, &body);
    }

    /// Calls body(part, first, end) for parts of `size` items, the last of which may have fewer: `first` to `end` - 1.
    template <typename Body>
    void parallel_parts(uint count, uint size, const Body& body, uint grain = k_parallel_grain) const {
        const auto call = [&](uint part) { body(part, part * size, std::min((part + 1) * size, count)); };
        parallel((count + size - 1) / size, call, grain / size);
    }

    const CpuThreads* threads = nullptr;
    bool some_bounce = false; ///< so that hits are kept, as the launch says that solves
    // What twins keep from launch to launch:
    std::shared_ptr<class SearchMemory> search_memory;    ///< of the broad phase
    std::shared_ptr<struct SolverBatches> solver_batches; ///< integrate_bodies, solve_contacts
    std::shared_ptr<class IslandMemory> island_memory;    ///< those that solve islands
};

} // namespace talus::engine
