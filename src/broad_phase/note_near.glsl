// SPDX-License-Identifier: MIT
// What search_strays and compare_strays ask about a stray and another body, and the list of those that are near. Needs the blocks
// StrayMarks, Aabbs, OrientedBoxes, NearPairs, NearTable and Counters, broad_phase/box_now.glsl,
// broad_phase/strays.shared.glsl and narrow_phase/pair_table.shared.glsl. The CPU's counterpart is note_near.h.

// By the boxes that both had, of which the list was made: then they are in it.
bool was_near(uint stray, uint body)
{
    return is_candidate(unpack(aabbs[stray]), unpack(aabbs[body])) &&
           !faces_part(unpack(oriented_boxes[stray]), unpack(oriented_boxes[body]));
}

void note_near(uint stray, uint body)
{
    stray_marks[stray] = k_stray_near; // others may write the same
    uint place = atomicAdd(counters[k_counter_near_pairs], 1u);
    if (place >= most_near_pairs(parameters.body_count)) {
        counters[k_counter_search_count] = parameters.body_count; // all write the same
        return;
    }
    Pair pair = make_pair(stray, body);
    near_pairs[place] = pair;
    uint last = near_table_size(parameters.body_count) - 1u;
    uint slot = hash_pair(pair.body_a, pair.body_b) & last;
    while (atomicCompSwap(near_table[slot], k_none, place) != k_none)
        slot = (slot + 1u) & last;
}

// Of two strays the one with the lower slot finds the pair.
void look_at(uint stray, OrientedBox box, uint body)
{
    bool both = stray_marks[body] != 0u;
    if (body == stray || (both && body < stray)) return;
    OrientedBox other = unpack(oriented_boxes[body]);
    if (both) other = box_with_skin(body);
    if (!faces_part(box, other) && !was_near(stray, body)) note_near(stray, body);
}
