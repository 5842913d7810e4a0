// SPDX-License-Identifier: MIT
// All sub-steps of some bodies and the manifolds between them, in one kernel: its invocations are workers that share both among
// themselves. The passes and their order are those of for_each_pass in contact_passes.h, and so are the bits. A worker keeps the
// manifold that it has in hand from pass to pass. Each step of the work stands here once, as compilers put a function's code into
// every place that calls it.
// Before this file the kernel includes contact_passes.glsl and body_passes.glsl, has colour_offsets[] as the buffer
// ColourOffsets does, and says
//   const bool k_notes_unlike: workers note which manifolds may not have as many sub-steps as most
// Behind it, it defines these:

// Which manifolds are the worker's, once end_index and first_colour are known.
void deal_manifolds();
// All are here, and what they have written before is seen.
void wait_for_workers();

// One pass over all manifolds that have a sub-step at the tick, which begins behind a wait. It ends with one, but for a colour
// of hubs at its end, for which the next pass waits, and for a pass that ends the tick, if integrate_own_bodies waits instead.
void pass_over_contacts(uint pass, uint tick, bool ends_tick);
// Of the manifold in hand, which has another number of sub-steps than most, in the first pass over all.
void note_unlike();
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
// passes do. Nor are those of a multirate island that have places in order: where most have one, so has each of these.

uint come_by;       // how many manifolds the worker has come by in this pass
uvec2 unlike_marks; // bits for them in turns: one of them may have another number

bool is_multirate_solve() { return k_multirate_islands && counters[k_counter_multirate_islands] > 0u; }

bool most_have_substep(uint tick) { return !k_multirate_islands || tick % ticks_apart == 0u; }
uvec2 mark() { return (come_by & 32u) == 0u ? uvec2(1u << (come_by & 31u), 0u) : uvec2(0u, 1u << (come_by & 31u)); }
bool has_mark() { return (unlike_marks & mark()) != uvec2(0u); }

// Of the manifold in hand, in the first pass over all.
void note_whether_unlike()
{
    if (substeps == like_substeps && (1u << slowness(traits)) == ticks_apart) return;
    if (!is_multirate(traits) || index_in_hand >= colour_offsets[k_first_hub_colour]) unlike_marks |= mark();
    note_unlike();
}

bool has_substep(uint index, uint tick)
{
    bool is_early = tick < (k_multirate_islands ? 1u : parameters.least_substeps);
    bool has = is_early || most_have_substep(tick);
    if (!is_early && (!k_notes_unlike || has_mark())) {
        uint its_substeps = index == index_in_hand ? substeps : substeps_of_contact(cell_in_block(constraints, index, 0u).w);
        uint substep = tick;
        if (k_multirate_islands)
            substep = substep_at(tick, index == index_in_hand ? traits : cell_in_block(constraints, index, 4u).w);
        has = substep < its_substeps;
    }
    return has;
}

// ---- the worker's manifolds ----

void find_own_manifolds()
{
    end_index = colour_offsets[k_overflow_colour];
    first_colour = k_first_hub_colour;
    while (colour_offsets[first_colour] > colour_offsets[0])
        --first_colour;
    index_in_hand = k_none;
    unlike_marks = uvec2(0u);
    deal_manifolds();
}

// `of_hub`: see take_constraint.
void take_in_hand(uint index, bool of_hub)
{
    if (index != index_in_hand && index != k_none) {
        if (index_in_hand != k_none) put_back_impulses(index_in_hand);
        take_constraint(index, of_hub);
        index_in_hand = index;
    }
}

// ---- passes ----

// Of light contacts with as many sub-steps as most, by whether they are against what cannot be pushed. To find it anew would take
// each contact some hundred operations in each pass.
shared Substep usual_substeps[2];

void find_usual_substeps()
{
    uint own = gl_LocalInvocationID.x;
    if (own < 2u) usual_substeps[own] = make_substep(like_substeps, own == 1u, 0.0, parameters);
}

Substep substep_in_hand(float present_load_speed)
{
    bool against_static = is_against_static(traits);
    Substep substep;
    if (substeps == like_substeps && is_light(present_load_speed))
        substep = usual_substeps[choose(against_static, 1u, 0u)];
    else
        substep = make_substep(substeps, against_static, present_load_speed, parameters);
    return substep;
}

// `last`: the ticks, as many as the most sub-steps that a body has.
void solve_substeps(uint last)
{
    like_substeps = last;
    if (is_multirate_solve()) like_substeps = fewest_in_island(counters[k_counter_low_islands] == 0u, parameters);
    ticks_apart = last / like_substeps;
    find_own_manifolds();
    find_usual_substeps(); // all wait before the first pass
    for (uint tick = 0u; tick <= last; ++tick) {
        integrate_own_bodies(tick);
        wait_for_workers();
        bool is_end = tick == last;
        uint pass = is_end ? k_relax : tick == 0u ? k_warm_start : k_solve;
        uint passes = is_end ? parameters.relax : parameters.iterations + (tick == 0u ? 1u : 0u);
        for (uint i = 0u; i < passes; ++i) {
            pass_over_contacts(pass, is_end ? 0u : tick, i + 1u == passes);
            pass = min(pass + 1u, k_solve_again);
        }
    }
    if (index_in_hand != k_none) put_back_impulses(index_in_hand);
}
