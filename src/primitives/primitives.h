// SPDX-License-Identifier: MIT
// Prefix sums and sorting on a device. They know nothing of physics: buffers of words go in, the number of words is
// read on the device. No result depends on the order in which a device runs its invocations, nor on how large buffers
// are.
//
// `capacity` is what the host knows: the count is never more. It decides how much is launched, so it may be generous,
// and the scratch buffers ScanSums, DigitCounts, SwapKeys and SwapValues are grown to it.
#pragma once

#include "device/device.h"

namespace talus::engine {

/// Replaces each of the first Counters[count_counter] words of `values` by the sum of those before it, and writes the
/// sum of all to Counters[total_counter], unless that is k_none; it must not be the count's own word, which other
/// groups still read. Sums are modulo 2^32. `group_size`: so many of what is counted share a word.
void exclusive_scan(Device&, BufferId values, uint capacity, uint count_counter, uint total_counter,
                    uint group_size = 1);

/// What a sort works on, besides SwapKeys and SwapValues.
struct Sort {
    BufferId keys;
    BufferId values;    ///< move with their keys, unless the sort gives places
    uint capacity;      ///< keys
    uint count_counter; ///< word of Counters with the number of keys
    uint bits = 32;     ///< keys are below 2^bits
    /// Entry of Dispatches with a group for each k_sort_tile keys; k_none: launched for `capacity` keys.
    uint slot = k_none;
    /// `values` gets the place of each key instead, in the order in which the keys were; nothing there is read.
    bool gives_places = false;
};

/// Keys and their values.
struct SortPlace {
    BufferId keys;
    BufferId values;
};

/// Where to write what is to be sorted, so that the result comes to lie at `keys` and `values`. With an even number of
/// passes it is there, with an odd number in SwapKeys and SwapValues, which get their room here.
SortPlace unsorted_place(Device&, const Sort&);
/// The other of the two, of which nothing is wanted until then, unless nothing is sorted and the last result is to
/// stay.
SortPlace spare_place(Device&, const Sort&);

/// Sorts by key, lowest first; equal keys keep their order. A capacity of up to k_sort_in_group_keys (2,048) takes a
/// single dispatch, a larger one a pass for every 8 bits.
void sort_by_key(Device&, const Sort&);

/// Puts the first `count` records of Changes (see the kernel scatter_records) to their places in a buffer of records,
/// or nothing after a step that did not fit.
void scatter_changed_records(Device&, BufferId target, uint count);

} // namespace talus::engine
