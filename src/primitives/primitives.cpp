// SPDX-License-Identifier: MIT
// What the host launches for a scan and for a sort.
#include "primitives/primitives.h"

#include <utility>

#include "primitives/kernels.h"

namespace talus::engine {
namespace {

static_assert(k_scan_tile == k_scan_group * k_scan_run);
static_assert(k_digits == 1u << k_digit_bits);
static_assert(32 / k_digit_bits % 2 == 0, "whole words are sorted where they are");
static_assert(k_sort_group == k_digits && k_sort_group == 32 * k_mask_words && k_sort_tile % k_sort_group == 0);

// Up to here one group is done before two dependent dispatches would be.
constexpr uint k_longest_group_scan = 4 * k_scan_tile;

constexpr std::size_t k_cell_bytes = 16; // records are rows of cells

void reserve_words(Device& device, BufferId buffer, std::size_t words) {
    if (device.size(buffer) < words * sizeof(uint)) device.grow(buffer, words * sizeof(uint));
}

/// Scans scan_count(Counters[count_counter], divisor, factor) words.
void scan(Device& device, BufferId values, uint capacity, uint count_counter, uint total_counter, uint divisor,
          uint factor) {
    const uint value_capacity = scan_count(capacity, divisor, factor);
    const std::array<uint, 4> args{count_counter, total_counter, divisor, factor};
    if (value_capacity <= k_longest_group_scan) {
        device.run({.kernel = scan_group, .items = 1, .args = args, .bindings = {{"Values", values}}});
        return;
    }
    reserve_words(device, BufferId::ScanSums, divide_up(value_capacity, k_scan_tile));
    device.run({.kernel = sum_tiles, .items = value_capacity, .args = args, .bindings = {{"Values", values}}});
    device.run({.kernel = scan_tiles, .items = value_capacity, .args = args, .bindings = {{"Values", values}}});
}

/// Up to so many tiles each group that scatters keys adds up the counts of all, which takes less time than a scan.
constexpr uint k_most_added_tiles = 256;

bool takes_one_group(const Sort& sort) {
    return sort.capacity <= k_sort_in_group_keys;
}

SortPlace sorted_place(const Sort& sort) {
    return {sort.keys, sort.values};
}

SortPlace scratch_place(Device& device, const Sort& sort) {
    reserve_words(device, BufferId::SwapKeys, sort.capacity);
    reserve_words(device, BufferId::SwapValues, sort.capacity);
    return {BufferId::SwapKeys, BufferId::SwapValues};
}

bool begins_in_scratch(const Sort& sort) {
    return !takes_one_group(sort) && divide_up(sort.bits, k_digit_bits) % 2 == 1;
}

/// A pass for every digit, from the lowest up, each stable.
void sort_digit_by_digit(Device& device, const Sort& sort) {
    SortPlace from = unsorted_place(device, sort), to = spare_place(device, sort);
    reserve_words(device, BufferId::DigitCounts, scan_count(sort.capacity, k_sort_tile, k_digits));

    const uint adds_up = divide_up(sort.capacity, k_sort_tile) <= k_most_added_tiles ? 1 : 0;
    for (uint shift = 0; shift < sort.bits; shift += k_digit_bits) {
        const bool is_first = shift == 0, is_last = shift + k_digit_bits >= sort.bits;
        const uint values = (is_first ? k_values_are_numbers : 0) | (is_last ? k_gives_places : 0);
        const std::array<uint, 4> args{sort.count_counter, shift, adds_up, sort.gives_places ? values : 0};
        device.run({.kernel = count_digits,
                    .items = sort.capacity,
                    .slot = sort.slot,
                    .args = args,
                    .bindings = {{"Keys", from.keys}}});
        if (adds_up == 0)
            scan(device, BufferId::DigitCounts, sort.capacity, sort.count_counter, k_none, k_sort_tile, k_digits);
        device.run(
            {.kernel = scatter_keys,
             .items = sort.capacity,
             .slot = sort.slot,
             .args = args,
             .bindings = {
                 {"Keys", from.keys}, {"Values", from.values}, {"SortedKeys", to.keys}, {"SortedValues", to.values}}});
        std::swap(from, to);
    }
}

} // namespace

void exclusive_scan(Device& device, BufferId values, uint capacity, uint count_counter, uint total_counter,
                    uint group_size) {
    scan(device, values, capacity, count_counter, total_counter, group_size, 1);
}

SortPlace unsorted_place(Device& device, const Sort& sort) {
    return begins_in_scratch(sort) ? scratch_place(device, sort) : sorted_place(sort);
}

SortPlace spare_place(Device& device, const Sort& sort) {
    return begins_in_scratch(sort) ? sorted_place(sort) : scratch_place(device, sort);
}

void sort_by_key(Device& device, const Sort& sort) {
    if (!takes_one_group(sort)) return sort_digit_by_digit(device, sort);
    device.run({.kernel = sort_in_group,
                .items = 1,
                .args = {sort.count_counter, sort.gives_places},
                .bindings = {{"Keys", sort.keys}, {"Values", sort.values}}});
}

void scatter_changed_records(Device& device, BufferId target, uint count) {
    const uint cells = static_cast<uint>(k_buffers[static_cast<std::size_t>(target)].stride / k_cell_bytes);
    device.run(
        {.kernel = scatter_records, .items = count * cells, .args = {count, cells}, .bindings = {{"Target", target}}});
}

} // namespace talus::engine
