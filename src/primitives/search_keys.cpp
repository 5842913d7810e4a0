// SPDX-License-Identifier: MIT
// CPU twin of search_keys.comp.glsl.
#include <algorithm>

#include "device/cpu/cpu_state.h"
#include "primitives/kernels.h"

namespace talus::engine {

static void search_keys_on_cpu(CpuState& state, const Launch& launch) {
    const uint* keys = state.words(launch.bound("Keys")).data;
    const Array<uint> offsets = state.words(launch.bound("Offsets"));
    const uint key_count = state.counters[launch.args[0]];

    for (uint wanted = 0; wanted <= k_digits; ++wanted)
        offsets[wanted] = static_cast<uint>(std::lower_bound(keys, keys + key_count, wanted) - keys);
}

const Kernel search_keys{"primitives/search_keys", search_keys_on_cpu};

} // namespace talus::engine
