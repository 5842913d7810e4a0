// SPDX-License-Identifier: MIT
// CPU twin of sort_in_group.comp.glsl.
#include <algorithm>

#include "device/cpu/cpu_state.h"
#include "primitives/kernels.h"

namespace talus::engine {
namespace {

struct Entry {
    uint key;
    uint value;
};

} // namespace

static void sort_in_group_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint> keys = state.words(launch.bound("Keys"));
    const Array<uint> values = state.words(launch.bound("Values"));
    const uint key_count = state.counters[launch.args[0]];

    std::vector<Entry> entries(key_count);
    for (uint i = 0; i < key_count; ++i)
        entries[i] = {keys[i], values[i]};
    std::stable_sort(entries.begin(), entries.end(), [](Entry a, Entry b) { return a.key < b.key; });
    for (uint i = 0; i < key_count; ++i) {
        keys[i] = entries[i].key;
        values[i] = entries[i].value;
    }
}

const Kernel sort_in_group{"primitives/sort_in_group", sort_in_group_on_cpu, 1};

} // namespace talus::engine
