// SPDX-License-Identifier: MIT
// All sub-steps of some bodies and the manifolds between them, in one kernel: its invocations are workers that share both among
// themselves, and wait for each other after every colour. The passes and their order are those of for_each_pass in
// contact_passes.h, and so are the bits. A worker keeps the manifold that it has in hand from pass to pass, and makes the next one
// ready before it waits. Each step of the work stands here once, as compilers put a function's code into every place that calls it.
// Before this file the kernel includes contact_passes.glsl and body_passes.glsl, has colour_offsets[] as the buffer
// ColourOffsets does, and says
//   const bool k_waits_are_long: to wait takes longer than to make a manifold ready, so a worker does that while others wait for
//     it no longer
//   const bool k_notes_unlike: it notes which manifolds may not have as many sub-steps as most
// Behind it, it defines these:

// Which manifolds are the worker's, once end_index and first_colour are known.
void deal_manifolds();
// Its first one; k_none: it has none.
uint first_own();
// Its next one, if that is of the same colour; otherwise the end of that or beyond.
uint after(uint index);
// Of what `after` gives: where that is its next one, or k_none.
uint settled(uint index);

// Whether the worker is one of those that pass over the colour.
bool is_own_colour(uint colour);
// Whether some manifold of the colour may have a sub-step then.
bool has_colour(uint colour, uint tick);
// All are here, and what they have written before is seen.
void wait_for_workers();
// Those that pass over a colour have done so, and are waited for by those that pass over the next one.
void arrive(uint colour);
void wait_for_colour(uint colour);
// Somebody passes over it.
void note_pass(uint colour);
// What follows the pass over a colour of hubs, and the wait until all see what that has changed.
void finish_colour(uint colour, uint tick);
void wait_for_finish();

// integrate_body for the worker's bodies.
void integrate_own_bodies(uint tick);

uint end_index;     // of the manifolds with a colour; the overflow set follows
uint first_colour;  // in use
uint index_in_hand; // k_none: none
uint like_substeps; // the number that most have, or are taken to have: where the solve is not multirate, the largest
uint ticks_apart;   // from one of these to the next

// ---- who has another number of sub-steps ----
//
// Those with the same as most are not asked whether they have a sub-step at a tick: a load for each would take as long as the
// passes do. In ticks in which they have none, a worker goes through a list of its others.

uint turn;         // how many of its manifolds, or of the list, the worker has come by in this pass
uint unlike_marks; // bits for its manifolds in turns: one of them may have another number

const uint k_most_listed = 12u; // 18 of the 32 KB of shared memory that OpenGL promises
shared uint unlike_list[k_multirate_islands ? k_most_listed * gl_WorkGroupSize.x : 1u];
uint unlike_count; // of the worker; with more than are listed it goes through all

bool is_multirate_solve() { return k_multirate_islands && counters[k_counter_multirate_islands] > 0u; }

bool most_have_substep(uint tick) { return !k_multirate_islands || tick % ticks_apart == 0u; }
bool goes_by_list(uint tick) { return !most_have_substep(tick) && unlike_count <= k_most_listed; }
uint list_place(uint i) { return i * gl_WorkGroupSize.x + gl_LocalInvocationID.x; }
uint listed() { return turn < unlike_count ? unlike_list[list_place(turn)] : k_none; }
uint mark() { return 1u << (turn & 31u); }

// Of the manifold in hand, in the first pass over all.
void note_whether_unlike()
{
    if (substeps == like_substeps && (1u << slowness(traits)) == ticks_apart) return;
    unlike_marks |= mark();
    if (k_multirate_islands && unlike_count < k_most_listed) unlike_list[list_place(unlike_count)] = index_in_hand;
    ++unlike_count;
}

bool has_substep(uint index, uint tick)
{
    if (tick < (k_multirate_islands ? 1u : parameters.least_substeps)) return true;
    if (k_notes_unlike && most_have_substep(tick) && (unlike_marks & mark()) == 0u) return true;
    uint its_substeps = index == index_in_hand ? substeps : cell_in_block(constraints, index, 5u).w;
    if (!k_multirate_islands) return tick < its_substeps;
    return substep_at(tick, index == index_in_hand ? traits : cell_in_block(constraints, index, 4u).w) < its_substeps;
}

// ---- the worker's manifolds at a tick ----

uint next_own(uint index, uint tick)
{
    ++turn;
    return goes_by_list(tick) ? listed() : after(index);
}

// From this one on, what next_own gives, the first that has a sub-step.
uint first_at(uint tick, uint index)
{
    for (;;) {
        if (!goes_by_list(tick)) index = settled(index);
        if (index == k_none || has_substep(index, tick)) return index;
        index = next_own(index, tick);
    }
}

uint first_own_at(uint tick)
{
    turn = 0u;
    return first_at(tick, goes_by_list(tick) ? listed() : first_own());
}

void find_own_manifolds()
{
    end_index = colour_offsets[k_overflow_colour];
    first_colour = k_first_hub_colour;
    while (colour_offsets[first_colour] > colour_offsets[0])
        --first_colour;
    index_in_hand = k_none;
    unlike_marks = 0u;
    unlike_count = 0u;
    deal_manifolds();
}

void take_in_hand(uint index)
{
    if (index == index_in_hand || index == k_none) return;
    if (index_in_hand != k_none) put_back_impulses(index_in_hand);
    take_constraint(index);
    index_in_hand = index;
}

void pass_over_contacts(uint pass, uint tick)
{
    uint first = first_own_at(tick);
    uint index = first;    // the next manifold to pass over
    bool is_found = true;  // it is; or else a later one
    bool is_ready = false; // it is in hand, and its target is known
    PassTarget target;
    // Two, but the compiler must not know: it would write out both.
    uint parts = k_waits_are_long ? min(parameters.iterations, 1u) + 1u : 1u;
    uint before = k_none; // the colour that others may still be at
    uint begin = colour_offsets[0];
    uint all_end = colour_offsets[k_overflow_colour + 1u];
    for (uint next = first_colour; begin < all_end; ++next) {
        uint colour = next - 1u; // before the first one there is none to pass over: all make ready
        uint end = colour_offsets[next];
        bool is_passed_over = begin < end && has_colour(colour, tick);
        bool is_own = is_passed_over && is_own_colour(colour);
        uint own_end = is_own ? end : 0u;
        begin = end;
        if (is_passed_over) wait_for_finish();
        if (is_own && before != k_none) wait_for_colour(before);
        // First those of the colour; then, while others still do theirs, the next one is made ready.
        for (uint part = 0u; part < parts; ++part) {
            bool is_last_part = part + 1u == parts;
            while (index < own_end || (is_last_part && !is_ready)) {
                if (is_ready) {
                    pass_over_constraint(pass, tick, index, target);
                    index = next_own(index, tick);
                    is_found = false;
                    is_ready = false;
                    if (!is_last_part && index >= own_end) break;
                }
                if (!is_found) index = first_at(tick, index);
                is_found = true;
                is_ready = true;
                take_in_hand(index == k_none ? first : index); // the next pass begins with the first
                if (index == k_none) continue;
                if (k_notes_unlike && pass == k_warm_start) note_whether_unlike();
                if (pass != k_warm_start) target = target_of_pass(pass);
            }
            if (part == 0u && is_own) arrive(colour);
        }
        if (!is_passed_over) continue;
        before = colour;
        note_pass(before);
        if (!k_waits_are_long || (k_hubs && is_hub_colour(before))) {
            wait_for_colour(before);
            finish_colour(before, tick);
            before = k_none;
        }
    }
    if (k_waits_are_long && before != k_none) wait_for_colour(before);
}

// `last`: the ticks, as many as the most sub-steps that a body has.
void solve_substeps(uint last)
{
    like_substeps = is_multirate_solve() ? parameters.least_substeps : last;
    ticks_apart = last / like_substeps;
    find_own_manifolds();
    for (uint tick = 0u; tick <= last; ++tick) {
        integrate_own_bodies(tick);
        wait_for_workers();
        bool is_end = tick == last;
        uint pass = is_end ? k_relax : tick == 0u ? k_warm_start : k_solve;
        uint passes = is_end ? parameters.relax : parameters.iterations + (tick == 0u ? 1u : 0u);
        for (uint i = 0u; i < passes; ++i) {
            pass_over_contacts(pass, is_end ? 0u : tick);
            pass = min(pass + 1u, k_solve_again);
        }
    }
    if (index_in_hand != k_none) put_back_impulses(index_in_hand);
}
