// SPDX-License-Identifier: MIT
// Last part of a pass of the radix sort: every key and its value go to their place; equal digits keep their order.
// One invocation is a key of each row of the tile, and a digit value between rows; one group is a tile.
// Reads: Keys, Values; DigitCounts; Counters[args.x], the number of keys. args.y: first bit of the digit. args.z: 1 where the
// counts have not been scanned, and each group adds them up itself. args.w: k_values_are_numbers, k_gives_places.
// Writes: SortedKeys, SortedValues.
// Needs: a barrier after the counting, or the scan. Each invocation sets its own bit, so the order of the atomics does not show.
// Overflow: none; every key has a place of its own below the number of keys.
#include "primitives/primitives.shared.glsl"
#include "primitives/group_scan.glsl"

layout(local_size_x = 256) in; // k_sort_group

layout(std430) readonly buffer Keys { uint keys[]; };
layout(std430) readonly buffer Values { uint values[]; };
layout(std430) readonly buffer Counters { uint counters[]; };
layout(std430) readonly buffer DigitCounts { uint digit_counts[]; };
layout(std430) writeonly buffer SortedKeys { uint sorted_keys[]; };
layout(std430) writeonly buffer SortedValues { uint sorted_values[]; };

// Place of the next key with a digit value.
shared uint places[k_digits];
// For each digit value, a bit for every invocation whose key has it. Word by word, so that neighbouring invocations
// clear neighbouring words.
shared uint masks[k_mask_words * k_digits];

// Of the first key of the tile with the digit value that is the invocation's. Every invocation must call it.
uint place_of_first(uint tile, uint tile_count)
{
    uint me = gl_LocalInvocationID.x;
    if (args.z == 0u) return digit_counts[digit_count_index(me, tile, tile_count)];
    uint in_all_tiles = 0u;
    uint in_tiles_before = 0u;
    for (uint each = 0u; each < tile_count; ++each) {
        if (each == tile) in_tiles_before = in_all_tiles;
        in_all_tiles += digit_counts[digit_count_index(me, each, tile_count)];
    }
    uint key_count;
    return group_scan(in_all_tiles, key_count) + in_tiles_before;
}

void main()
{
    uint key_count = counters[args.x];
    uint tile_count = divide_up(key_count, k_sort_tile);
    uint tile = group_index();
    if (tile >= tile_count) return;

    uint me = gl_LocalInvocationID.x;
    uint my_word = me / 32u;
    uint my_bit = 1u << (me % 32u);
    places[me] = place_of_first(tile, tile_count);
    for (uint word = 0u; word < k_mask_words; ++word)
        masks[word * k_digits + me] = 0u;
    barrier();

    for (uint row = 0u; row < k_sort_tile; row += k_sort_group) {
        uint i = tile * k_sort_tile + row + me;
        uint key = 0u;
        uint digit = 0u;
        if (i < key_count) {
            key = keys[i];
            digit = digit_of(key, args.y);
            atomicOr(masks[my_word * k_digits + digit], my_bit);
        }
        barrier();

        if (i < key_count) {
            uint rank = uint(bitCount(masks[my_word * k_digits + digit] & (my_bit - 1u)));
            for (uint word = 0u; word < my_word; ++word)
                rank += uint(bitCount(masks[word * k_digits + digit]));
            uint place = places[digit] + rank;
            sorted_keys[place] = key;
            uint value = (args.w & k_values_are_numbers) != 0u ? i : values[i];
            if ((args.w & k_gives_places) != 0u)
                sorted_values[value] = place;
            else
                sorted_values[place] = value;
        }
        barrier();

        uint found = 0u;
        for (uint word = 0u; word < k_mask_words; ++word) {
            found += uint(bitCount(masks[word * k_digits + me]));
            masks[word * k_digits + me] = 0u;
        }
        places[me] += found;
        barrier();
    }
}
