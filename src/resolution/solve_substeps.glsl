// SPDX-License-Identifier: MIT
// All sub-steps of some bodies and the manifolds between them, in one kernel: its invocations are workers that share both
// among themselves, and wait for each other after every colour. The passes and their order are those of for_each_pass in
// contact_passes.h, and so are the bits.
// A worker keeps the manifold that it has in hand from pass to pass. Where it has several it takes the next one before it
// waits for the others, so that nobody waits for memory. Each step of the work stands here once, as compilers put the
// code of a function into every place that calls it.
// Before this file the kernel includes contact_passes.glsl and body_passes.glsl, has colour_offsets[] as the buffer
// ColourOffsets does, and defines
//   uint worker(): which of the workers this is
//   uvec3 own_manifolds(uint begin): its first manifold with a colour, where they begin; how far it is from each to the
//     next; and where those of the first colours end that some workers solve among themselves
//   void wait_for_workers(): until all are here, and what they have written is seen
//   void wait_for_few(): the same of those workers, after one of these colours but the last
//   bool has_colour(uint colour, uint tick): whether some manifold of the colour may have a sub-step then
//   void finish_colour(uint colour, uint tick): what follows a colour's pass, once all are here
//   void wait_for_finish(): until all see what it has changed
//   void integrate_own_bodies(uint tick): integrate_body for the worker's bodies

uint end_index;     // of the manifolds with a colour; the overflow set follows
uint own_end;       // of those that the worker may have: the overflow set is the first one's
uint first_colour;  // in use
uint first_index;   // the worker's first manifold; k_none: it has none
uint stride;        // to its next one
uint end_of_few;    // of the manifolds of the first colours, if some of the workers solve those
uint index_in_hand; // k_none: none
uint like_substeps; // the number that most have
uint ticks_apart;   // from one of these to the next
uint unlike_marks;  // bits for its manifolds in turns: one of them may have another number

uint if_own(uint index) { return index < own_end ? index : k_none; }

// The worker's manifold after this one; the overflow set one after the other.
uint next_own(uint index)
{
    return if_own(index < end_index ? min(index + stride, end_index) : index + 1u);
}

void find_own_manifolds()
{
    end_index = colour_offsets[k_overflow_colour];
    own_end = worker() == 0u ? colour_offsets[k_overflow_colour + 1u] : end_index;
    first_colour = k_first_hub_colour;
    while (colour_offsets[first_colour] > colour_offsets[0])
        --first_colour;
    uvec3 own = own_manifolds(colour_offsets[0]);
    first_index = if_own(min(own.x, end_index));
    stride = own.y;
    end_of_few = own.z;
    index_in_hand = k_none;
}

bool is_multirate_solve() { return k_multirate_islands && counters[k_counter_multirate_islands] > 0u; }

uint mark_of(uint index) { return 1u << ((index - first_index) / stride & 31u); }

bool is_unlike(uint index) { return index >= end_index || (unlike_marks & mark_of(index)) != 0u; }

// Whether the manifold has a sub-step at this tick. Where most are known to have or not to have one they are not asked: a load
// for each would take as long as the passes do.
bool has_substep(uint index, uint tick)
{
    if (tick < (k_multirate_islands ? 1u : parameters.least_substeps)) return true;
    if (k_multirate_islands && !is_unlike(index)) return tick % ticks_apart == 0u;
    uint its_substeps = index == index_in_hand ? substeps : cell_in_block(constraints, index, 5u).w;
    if (!k_multirate_islands) return tick < its_substeps;
    return substep_at(tick, index == index_in_hand ? traits : cell_in_block(constraints, index, 4u).w) < its_substeps;
}

// The worker's first manifold from this one on that has a sub-step.
uint first_at(uint tick, uint index)
{
    while (index != k_none && !has_substep(index, tick))
        index = next_own(index);
    return index;
}

void take_in_hand(uint index)
{
    if (index == index_in_hand || index == k_none) return;
    if (index_in_hand != k_none) put_back_impulses(index_in_hand);
    take_constraint(index);
    index_in_hand = index;
    bool is_like = substeps == like_substeps && (1u << slowness(traits)) == ticks_apart;
    if (k_multirate_islands && !is_like && index < end_index) unlike_marks |= mark_of(index);
}

void pass_over_contacts(uint pass, uint tick)
{
    uint first = first_at(tick, first_index);
    uint index = first;    // the next manifold to pass over
    bool is_ready = false; // it is in hand, and its target is known
    PassTarget target;
    bool few_are_ahead = false; // not all have seen what they have done
    uint begin = colour_offsets[0];
    uint all_end = colour_offsets[k_overflow_colour + 1u];
    for (uint colour = first_colour; begin < all_end; ++colour) {
        uint end = colour_offsets[colour]; // before the first colour there are none to pass over: all make ready
        bool is_passed_over = begin < end && has_colour(colour - 1u, tick);
        if (is_passed_over) wait_for_finish();
        if (k_multirate_islands && is_passed_over && few_are_ahead && end > end_of_few) {
            wait_for_workers();
            few_are_ahead = false;
        }
        while (!is_ready || index < end) {
            if (is_ready) {
                pass_over_constraint(pass, tick, index, target);
                index = first_at(tick, next_own(index));
            }
            is_ready = true;
            take_in_hand(index == k_none ? first : index); // the next pass begins with the first
            if (pass != k_warm_start && index != k_none) target = target_of_pass(pass);
        }
        begin = end;
        if (!is_passed_over) continue;
        few_are_ahead = end < end_of_few;
        if (few_are_ahead)
            wait_for_few();
        else
            wait_for_workers();
        finish_colour(colour - 1u, tick);
    }
    if (k_multirate_islands && few_are_ahead) wait_for_workers();
}

// `last`: the ticks, as many as the most sub-steps that a body has.
void solve_substeps(uint last)
{
    find_own_manifolds();
    like_substeps = is_multirate_solve() ? parameters.least_substeps : last;
    ticks_apart = last / like_substeps;
    unlike_marks = 0u;
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
