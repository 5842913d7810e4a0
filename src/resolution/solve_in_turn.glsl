// SPDX-License-Identifier: MIT
// A pass over the contacts of a work group. Where its invocations run side by side (k_waits_freely) contacts wait for each other one
// by one: each for those of earlier colours at its two bodies, and for no other. Else there is a barrier after each colour. The order at
// each body is that of the colours in both, and so the bits are; but a barrier takes as long as the slowest contact, and as the next
// manifold that somebody makes ready. See docs/decisions/contacts-wait-one-by-one.md; solve_in_order.glsl does so across groups.
//
// For solve_in_group.glsl, behind solve_substeps.glsl.

// Where contacts wait, what runs in step is to have contacts of one colour; but of several small islands there are few of a colour.
const uint k_dealt_together = k_waits_freely && k_one_island ? k_in_step : 1u;

uint count_of(uint colour) { return colour_offsets[colour + 1u] - colour_offsets[colour]; }
uint manifold_of(uint colour, uint i) { return colour_offsets[colour] + i; }

#include "resolution/deal.glsl"

bool is_first_worker() { return worker == 0u; }

// ---- turns ----

shared uint has_given_up;

bool have_given_up() { return has_given_up != 0u; }

void give_up()
{
    has_given_up = 1u;
    atomicOr(counters[k_counter_did_not_fit], k_fit_groups);
}

#include "resolution/waits.glsl"

// Of each body, as number_after says. All of its contacts have a sub-step whenever one has.
shared uint turns[k_waits_freely ? k_room + 1u : 1u]; // where there are 32 KB for a group they would not fit

void begin_turns(uint slot)
{
    if (k_waits_freely) turns[slot] = 0u;
}

uint needed_turn_a; // 0: any
uint needed_turn_b;

uint turn_after(uint contacts) { return contacts == 0u ? 0u : number_after(contacts); }

void find_turns(uint index)
{
    needed_turn_a = turn_after(earlier_of(counts, k_earlier_of_a));
    needed_turn_b = turn_after(earlier_of(counts, k_earlier_of_b));
    // The overflow set is the first worker's, one contact after the other, behind all that have a colour.
    if (index >= end_index) {
        needed_turn_a = turn_after(contacts_of_body(unpack(inertias[body_a]).traits));
        needed_turn_b = turn_after(contacts_of_body(unpack(inertias[body_b]).traits));
    }
}

bool is_turn()
{
    memoryBarrierShared(); // each look is another one
    return turns[slot_a] >= needed_turn_a && turns[slot_b] >= needed_turn_b;
}

void end_turns(uint index)
{
    bool has_colour = index < end_index;
    if (has_colour && is_pushed(traits)) turns[slot_a] = number_after(earlier_of(counts, k_earlier_of_a) + 1u);
    if (has_colour && is_pushed(traits >> k_traits_of_b))
        turns[slot_b] = number_after(earlier_of(counts, k_earlier_of_b) + 1u);
}

// In one island what runs in step is at contacts of one colour, none of which waits for another one, so all go on together. Else
// each goes on as soon as it is its turn. Some drivers end a loop after so many rounds.
void pass_in_turn(uint pass, uint tick, uint index, PassTarget target)
{
    uint looks = 0u;
    bool is_its_turn = !k_waits_freely || is_turn();
    while (k_one_island && !is_its_turn && looks_again(looks))
        is_its_turn = is_turn();
    bool is_done = false;
    do {
        if (k_one_island || is_its_turn) {
            groupMemoryBarrier();
            pass_over_constraint(pass, tick, index, target);
            groupMemoryBarrier();
            if (k_waits_freely) end_turns(index);
            is_done = true;
        } else {
            is_its_turn = is_turn();
        }
    } while (!k_one_island && !is_done && looks_again(looks));
    if (!is_its_turn || !is_done) give_up();
}

// ---- the deal ----

void deal_manifolds()
{
    worker = gl_LocalInvocationID.x;
    find_places();
    find_end_of_places(true);
}

// ---- a pass ----

// Where contacts wait for each other there is one stage, with all colours; else one for each, with a barrier behind it. What runs in
// step stays at one colour, at places without a manifold too: so nothing here leaves a round of the loop early.
void pass_over_contacts(uint pass, uint tick, bool ends_tick)
{
    ++passes_in_order;
    worker_colour = first_colour;
    uint first = k_none; // of the worker's manifolds; the next pass begins with it
    uint place = worker;
    for (uint colour = k_waits_freely ? k_overflow_colour : first_colour; colour <= k_overflow_colour; ++colour) {
        if (!k_waits_freely && colour_offsets[colour] == colour_offsets[colour + 1u]) continue;
        uint end = end_of_places(colour);
        bool is_end = false; // in the last round of the last stage the first manifold is taken in hand
        while (!is_end) {
            is_end = place >= end;
            uint index = !is_end ? own_manifold_at(place) : end == end_place ? first : k_none;
            // To ask others than the one in hand is a load. Those of one island have the same number of sub-steps.
            if (index != k_none && (k_one_island || has_substep(index, tick))) {
                take_in_hand(index, false);
                if (!is_end && has_substep(index, tick)) {
                    if (first == k_none) first = index;
                    PassTarget target;
                    if (pass != k_warm_start) target = target_of_pass(pass, true); // shared memory has most
                    find_turns(index);
                    pass_in_turn(pass, tick, index, target);
                }
            }
            if (!is_end) place += workers();
        }
        wait_for_workers();
    }
}
