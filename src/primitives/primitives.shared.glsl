// SPDX-License-Identifier: MIT
// Sizes and index arithmetic of the scan and the sort.

const uint k_scan_group = 256u;      // invocations of a group that scans
const uint k_scan_run = 8u;          // consecutive values of one invocation
const uint k_scan_tile = 2048u;      // k_scan_group * k_scan_run
const uint k_sort_group = 256u;      // invocations of a group that sorts: one a digit where digits are treated
const uint k_digit_bits = 8u;        // k_digits = 2 ^ k_digit_bits
const uint k_mask_words = 8u;        // words of a bit mask over the invocations of a sorting group
// What a pass of a sort that gives places does with its values:
const uint k_values_are_numbers = 1u; // the first: each key's value is its number
const uint k_gives_places = 2u;       // the last: each number gets the place of its key
const uint k_sort_in_group_keys = 2048u; // most keys of a sort by a single group: 24 KiB of its shared memory

inline uint divide_up(uint a, uint b)
{
    return (a + b - 1u) / b;
}

// Number of values to scan: `factor` values for every `divisor` things counted, the last ones rounded up.
inline uint scan_count(uint counted, uint divisor, uint factor)
{
    return divide_up(counted, divisor) * factor;
}

inline uint digit_of(uint key, uint shift)
{
    return (key >> shift) & (k_digits - 1u);
}

// DigitCounts has a digit's tiles side by side: after its scan, the entry is the place of the first such key.
inline uint digit_count_index(uint digit, uint tile, uint tile_count)
{
    return digit * tile_count + tile;
}
