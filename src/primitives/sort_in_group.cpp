// SPDX-License-Identifier: MIT
// CPU twin of sort_in_group.comp.glsl: by three digits, one after the other (Knuth, volume 3, section 5.2.5).
#include <array>
#include <utility>
#include <vector>

#include "device/cpu/cpu_state.h"
#include "primitives/kernels.h"

namespace talus::engine {
namespace {

struct Entry {
    uint key;
    uint value;
};

constexpr uint k_bits_a_digit = 11;

/// Entries in the order of one digit, and among those with the same digit in the order in which they were.
void sort_by_digit(const std::vector<Entry>& entries, uint shift, std::vector<Entry>& sorted) {
    std::array<uint, 1u << k_bits_a_digit> places{};
    const auto digit_of = [&](Entry entry) { return entry.key >> shift & ((1u << k_bits_a_digit) - 1); };
    for (const Entry entry : entries)
        ++places[digit_of(entry)];
    uint before = 0;
    for (uint& place : places)
        before += std::exchange(place, before);
    for (const Entry entry : entries)
        sorted[places[digit_of(entry)]++] = entry;
}

} // namespace

static void sort_in_group_on_cpu(CpuState& state, const Launch& launch) {
    const Array<uint> keys = state.words(launch.bound("Keys"));
    const Array<uint> values = state.words(launch.bound("Values"));
    const uint key_count = state.counters[launch.args[0]];
    const bool gives_places = launch.args[1] == 1;

    std::vector<Entry> entries(key_count), sorted(key_count);
    for (uint i = 0; i < key_count; ++i)
        entries[i] = {keys[i], gives_places ? i : values[i]};
    for (uint shift = 0; shift < 32; shift += k_bits_a_digit) {
        sort_by_digit(entries, shift, sorted);
        entries.swap(sorted);
    }
    for (uint i = 0; i < key_count; ++i) {
        keys[i] = entries[i].key;
        values[gives_places ? entries[i].value : i] = gives_places ? i : entries[i].value;
    }
}

const Kernel sort_in_group{"primitives/sort_in_group", sort_in_group_on_cpu, 1};

} // namespace talus::engine
