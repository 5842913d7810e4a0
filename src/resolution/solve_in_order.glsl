// SPDX-License-Identifier: MIT
// A pass in which contacts wait for each other one by one: each for those of earlier colours at its two bodies, and for no
// other. Where it matters that is the order of colours, and so are the bits; but a wait among all groups for each colour takes
// longer than a contact needs to see what the one before it has stored. docs/decisions/contacts-wait-one-by-one.md.
//
// A velocity that is stored in such a pass has a stamp in each of its two cells: how many contacts of the body have been solved
// in it, and in which pass that was. So no barrier has to stand between the two: either cell tells by itself whether it is the
// one that is waited for. The first stamp stands where the inverse mass does otherwise, which the contacts know; the second is 0
// where the velocity has no stamps. See stamp.shared.glsl.
//
// What a GPU runs in step is at manifolds of one colour at a time, none of which waits for another one.
//
// For solve_persistent.glsl, behind solve_substeps.glsl and grid_barrier.glsl. The kernel defines

// What follows the pass over a colour of hubs, and the wait until all see what that has changed.
void finish_colour(uint colour, uint tick);
void wait_for_finish();

#include "resolution/waits.glsl"

// ---- stamps ----

uint stamp_of(uvec4 cell, uint number) { return stamp_of(cell.x, cell.y, cell.z, number); }
bool has_stamp(uvec4 cell, uint number) { return is_stamp(cell.w, stamp_of(cell, number)); }
bool has_stamps(BodyVelocityCells velocity) { return velocity.cell_1.w != 0u; }

// Whether the velocity is the one that follows `earlier` contacts. Before the first one all have waited for each other.
bool is_after(BodyVelocityCells velocity, uint earlier)
{
    uint number = number_after(earlier);
    return earlier == 0u || has_stamp(velocity.cell_0, number) && has_stamp(velocity.cell_1, number);
}

bool is_frozen(BodyVelocityCells velocity)
{
    return has_stamps(velocity) ? (velocity.cell_0.w & k_stamp_of_frozen) != 0u : velocity.cell_0.w == 0u;
}

BodyVelocity without_stamps(BodyVelocityCells cells, uint body)
{
    BodyVelocity velocity = unpack(cells);
    if (has_stamps(cells)) {
        velocity.inverse_mass = is_frozen(cells) ? 0.0 : unpack(properties[body]).inverse_mass;
        velocity.stamp = 0u;
    }
    return velocity;
}

BodyVelocity load_velocity(uint body)
{
    BodyVelocityCells cells = velocities[body];
    return without_stamps(cells, body);
}

// What contacts make of a body. Nobody waits for what they cannot push, or for the last contact of the last pass.
void store_in_order(uint body, uint its_traits, BodyVelocityCells before, BodyVelocity changed, uint earlier, bool is_last)
{
    bool pushes = is_pushed(its_traits);
    bool stays = is_frozen(before); // as it is, but those behind wait for it
    if (pushes && is_last && (has_stamps(before) || !stays)) store_velocity(body, stays ? frozen_velocity() : changed);
    if (pushes && !is_last) {
        BodyVelocityCells stored = before;
        if (!stays) stored = pack(changed);
        uint of_frozen = stays ? k_stamp_of_frozen : 0u;
        uint number = number_after(earlier + 1u);
        stored.cell_0.w = stamp_of(stored.cell_0, number) | of_frozen;
        stored.cell_1.w = stamp_of(stored.cell_1, number) | of_frozen;
        velocities[body] = stored;
    }
}

// Where no relax pass has done so.
void take_stamps_away(uint body)
{
    BodyVelocityCells stored = velocities[body];
    if (has_stamps(stored)) store_velocity(body, without_stamps(stored, body));
}

// ---- what is fast ----
//
// Most ticks may be such that few have a sub-step. To come by all others takes as long as a pass over them. Contacts that have one come
// first in each colour; bodies that may have one are listed before the first pass of a step, in any order, as anybody may move them.
// The slowest of these are by far the most, and have a sub-step in few of these ticks: they are listed from the end.

// A body slot's words: the colours of its fast contacts, two words for each power (see below); then one of the list of bodies.
layout(std430) coherent buffer FastBodies { uint fast_bodies[]; };

uint words_of_body() { return fast_body_words(parameters.fewest_substeps, parameters.most_substeps); }
uint list_word(uint place) { return words_of_body() * place + words_of_body() - 1u; }
uint word_from_end(uint place) { return list_word(parameters.body_count - 1u - place); }

uint ticks_power(uint tick) { return uint(findLSB(tick)); }
uint slowest_power() { return uint(findLSB(ticks_apart)); }
bool has_slowest(uint power) { return power + 1u >= slowest_power(); }

// An entry of the list has a body and, above it, its slowness: to come by one that has no sub-step no record of it is loaded.
uint listed_body(uint entry) { return entry % k_most_bodies; }
bool listed_has_substep(uint entry, uint tick) { return entry / k_most_bodies <= ticks_power(tick); }

// `r`: its slowness, if that is not the one of most.
void list_fast_body(uint body, uint r)
{
    uint entry = body + r * k_most_bodies;
    if (has_slowest(r))
        fast_bodies[word_from_end(atomicAdd(arrivals[k_all_other_fast_bodies], 1u))] = entry;
    else
        fast_bodies[list_word(atomicAdd(arrivals[k_all_fastest_bodies], 1u))] = entry;
}

uint fastest_body_count; // that are listed

uint count_fast_bodies(uint tick)
{
    fastest_body_count = arrivals[k_all_fastest_bodies];
    return fastest_body_count + (has_slowest(ticks_power(tick)) ? arrivals[k_all_other_fast_bodies] : 0u);
}

uint fast_entry(uint i) { return fast_bodies[i < fastest_body_count ? list_word(i) : word_from_end(i - fastest_body_count)]; }

// ---- the deal ----
//
// Each group has a part of every colour. Manifolds of one colour are in the order of pairs, so what a group has of all colours
// is close together in space: it finds what it reads of bodies where it has read it before, waits for few other groups, and these
// need not all load at a time and wait at a time. In a multirate island what is fast comes first in each colour, in that order, too, and
// each rate is shared by itself: it lies close together, and in the ticks in which most have no sub-step all groups would wait for a few.

// Where the group's part of so many begins; that of the next group ends it.
uint part_begin(uint count, uint group)
{
    uint groups = gl_NumWorkGroups.x;
    return count / groups * group + count % groups * group / groups;
}

// Of each colour, and in a multirate solve of each slowness in it, the group's part: where it begins, less what comes before it in the
// colour; and how many the group has of the colour with it.
const uint k_parts = k_multirate_islands ? k_slownesses : 1u;
shared uint part_starts[k_parts * k_max_colours];
shared uint part_ends[k_parts * k_max_colours];

uint part_word(uint colour, uint r) { return r * k_max_colours + colour; }
// With the slowness r or a lesser one.
uint count_up_to(uint colour, uint r) { return part_ends[part_word(colour, r)]; }
uint count_of(uint colour) { return count_up_to(colour, k_parts - 1u); }

uint manifold_of(uint colour, uint i)
{
    uint r = 0u;
    while (k_multirate_islands && i >= count_up_to(colour, r))
        ++r;
    return part_starts[part_word(colour, r)] + i;
}

void find_parts(uint colour)
{
    bool has_rates = is_multirate_solve();
    uint begin = colour_offsets[colour];
    uint count = 0u;
    for (uint r = 0u; r < k_parts; ++r) {
        uint end = colour_offsets[colour + 1u];
        if (has_rates && r + 1u < k_parts) end = stored_offsets[rate_end_word(colour, r)];
        uint first = begin + part_begin(end - begin, gl_WorkGroupID.x);
        part_starts[part_word(colour, r)] = first - count;
        count += begin + part_begin(end - begin, gl_WorkGroupID.x + 1u) - first;
        part_ends[part_word(colour, r)] = count;
        begin = end;
    }
}

const uint k_dealt_together = k_in_step;
uint workers() { return gl_WorkGroupSize.x; }

#include "resolution/deal.glsl"

bool is_first_worker() { return worker == 0u && gl_WorkGroupID.x == 0u; }

shared uint is_left[3]; // see goes_on

void deal_manifolds()
{
    worker = gl_LocalInvocationID.x;
    if (worker < 3u) is_left[worker] = 0u;
    for (uint colour = worker; colour < k_max_colours; colour += workers())
        find_parts(colour);
    barrier();
    find_places();
    find_end_of_places(gl_WorkGroupID.x == 0u);
}

uint first_place_from(uint end) { return worker + round_up(max(end, worker) - worker, workers()); }

// Whether the manifold at a place of the worker's colour stands among those of the slowness r or a lesser one; or some of it may that
// runs in step with it.
bool is_as_fast(uint place, uint r) { return place - first_places[worker_colour] < count_up_to(worker_colour, r); }
bool row_is_as_fast(uint place, uint r) { return is_as_fast(place / k_dealt_together * k_dealt_together, r); }

// The worker's next place, from one of its own on, where that is so. `end`: of places in order.
uint next_fast_place(uint place, uint r, uint end)
{
    uint next = place;
    bool is_found = false;
    while (!is_found && first_places[worker_colour] < end) {
        next = max(next, first_place_from(first_places[worker_colour]));
        is_found = row_is_as_fast(next, r);
        if (!is_found) ++worker_colour;
    }
    if (!is_found) next = first_place_from(end);
    return next;
}

// ---- ticks in which few have a sub-step ----
//
// In those the order at a body is that of its contacts which have one. Of a tick which 2^t is the highest power to divide, these
// are the contacts for which a tick in 2^t or in fewer begins a sub-step.

// `word`: k_used_low or k_used_high.
uint fast_word(uint body, uint power, uint word) { return words_of_body() * body + 2u * power + word; }

void forget_fast_colours(uint body)
{
    for (uint power = 0u; power < slowest_power(); ++power) {
        fast_bodies[fast_word(body, power, k_used_low)] = 0u;
        fast_bodies[fast_word(body, power, k_used_high)] = 0u;
    }
}

void note_fast_colour(uint body, uint its_traits, uint colour)
{
    uint end = is_pushed(its_traits) ? slowest_power() : 0u;
    for (uint power = slowness(traits); power < end; ++power)
        atomicOr(fast_bodies[fast_word(body, power, used_word(colour))], used_bit(colour));
}

uint count_earlier_fast(uint body, uint its_traits, uint colour, uint power)
{
    uint count = 0u;
    if (is_pushed(its_traits))
        count = count_earlier(fast_bodies[fast_word(body, power, k_used_low)],
                              fast_bodies[fast_word(body, power, k_used_high)], colour);
    return count;
}

void note_unlike()
{
    if (!k_multirate_islands || ticks_apart == 1u || index_in_hand >= colour_offsets[k_first_hub_colour]) return;
    note_fast_colour(body_a, traits, worker_colour);
    note_fast_colour(body_b, traits >> k_traits_of_b, worker_colour);
}

// ---- a pass ----

// Whether the one in hand has a sub-step at a tick at which most have none.
bool in_hand_has_substep(uint tick) { return substep_at(tick, traits) < substeps; }

uint earlier_a; // contacts of its bodies that come before the one in hand
uint earlier_b;

void find_earlier(uint tick)
{
    if (most_have_substep(tick)) {
        earlier_a = earlier_of(counts, k_earlier_of_a);
        earlier_b = earlier_of(counts, k_earlier_of_b);
    } else {
        uint power = ticks_power(tick);
        earlier_a = count_earlier_fast(body_a, traits, worker_colour, power);
        earlier_b = count_earlier_fast(body_b, traits >> k_traits_of_b, worker_colour, power);
    }
}

BodyVelocityCells cells_a; // the velocity as it was at the last look
BodyVelocityCells cells_b;

void look()
{
    cells_a = velocities[body_a];
    cells_b = velocities[body_b];
}

// The last look was at the contact in hand, and has not been used. Cleared where a pass begins.
bool has_looked = false;

// Most contacts of large heaps, which the kernel for multirate islands solves, need not wait: the first look at their bodies is loaded
// while the rest of their records are. In the other kernel a worker has one contact or two, which wait for others, and the early
// look only takes registers (docs/performance.md).
void look_early()
{
    if (!k_multirate_islands) return;
    look();
    has_looked = true;
}

bool fits_last_look() { return is_after(cells_a, earlier_a) && is_after(cells_b, earlier_b); }

// Whether it is the turn of the contact in hand.
bool is_turn()
{
    look();
    return fits_last_look();
}

// Where one group is alone on a device on which invocations must not wait, they meet after each look: renderers in software run them
// one after the other.
bool is_alone() { return !k_waits_freely && gl_NumWorkGroups.x == 1u; }

uint looks_in_hand; // at the contact in hand

// Whether it is the turn of the contact in hand, or somebody has given up. What runs in step waits here together, as none of it waits
// for another one. Some drivers end a loop after so many rounds.
bool wait_for_turn()
{
    bool fits = has_looked && fits_last_look();
    has_looked = false;
    if (!fits) fits = is_turn();
    if (is_alone()) return fits;
    bool is_to_look = !fits && looks_again(looks_in_hand);
    while (is_to_look) {
        fits = is_turn();
        is_to_look = !fits && looks_again(looks_in_hand);
    }
    if (!is_to_look && !fits) give_up();
    return !is_to_look;
}

void pass_in_turn(uint pass, uint index, PassTarget target)
{
    VelocityPair before;
    before.a = unpack(cells_a);
    before.b = unpack(cells_b);
    before.a.inverse_mass = rows.meeting.inverse_mass_a;
    before.b.inverse_mass = rows.meeting.inverse_mass_b;
    VelocityPair changed = solve_constraint(pass, index, target, before);
    bool is_end = pass == k_relax;
    if (k_multirate_islands && !is_end) {
        changed.a = change_in_part(before.a, changed.a, part_a);
        changed.b = change_in_part(before.b, changed.b, part_b);
    }
    bool is_last_of_a = is_end && is_last_of(counts, k_last_of_a);
    bool is_last_of_b = is_end && is_last_of(counts, k_last_of_b);
    store_in_order(body_a, traits, cells_a, changed.a, earlier_a, is_last_of_a);
    store_in_order(body_b, traits >> k_traits_of_b, cells_b, changed.b, earlier_b, is_last_of_b);
}

uint rounds = 0u;

// Whether the invocation goes on: as long as it has something to do itself, or one that it meets has. is_left is that of this
// round of looks, of the one before and of the next.
bool goes_on(bool has_more)
{
    if (!is_alone()) return has_more;
    if (has_more) is_left[rounds % 3u] = 1u;
    if (gl_LocalInvocationID.x == 0u) is_left[(rounds + 1u) % 3u] = 0u;
    memoryBarrierBuffer();
    barrier();
    return is_left[rounds++ % 3u] != 0u;
}

const uint k_many_each = 16u; // contacts that a worker has of each pass over all

bool is_settled = true; // all have waited for each other since the last pass

// If they have not, all contacts of the body have had a sub-step in it, and a body that contacts do not push does not move.
BodyVelocity load_settled_velocity(uint body, uint its_traits)
{
    uint contacts = is_settled ? 0u : contacts_of_body(its_traits);
    uint looks = 0u;
    BodyVelocityCells cells = velocities[body];
    while (!is_after(cells, contacts) && looks_again(looks))
        cells = velocities[body];
    if (!is_after(cells, contacts)) give_up();
    return without_stamps(cells, body);
}

// Behind those in order: the colours of hubs and the overflow set, with a wait behind each. `place`: the worker's first one of theirs.
// In one loop with the pass in order the two took registers from each other (docs/performance.md).
void pass_over_hubs_and_overflow(uint place, uint pass, uint tick)
{
    for (uint colour = k_first_hub_colour; colour <= k_overflow_colour; ++colour) {
        if (colour_offsets[colour] == colour_offsets[colour + 1u]) continue;
        wait_for_finish();
        for (; place < end_of_places(colour); place += workers()) {
            uint index = own_manifold_at(place);
            if (index != k_none && has_substep(index, tick)) {
                take_in_hand(index, true);
                PassTarget target;
                if (pass == k_warm_start)
                    note_whether_unlike();
                else
                    target = target_of_pass(pass, have_moved(pass, tick));
                pass_over_constraint(pass, tick, index, target);
            }
            ++come_by;
        }
        wait_for_workers();
        if (is_hub_colour(colour)) finish_colour(colour, tick);
    }
}

void pass_over_contacts(uint pass, uint tick, bool ends_tick)
{
    wait_for_finish();
    ++passes_in_order;
    has_looked = false; // what is in hand may have been taken at the end of the pass before
    uint end = first_places[k_first_hub_colour];
    bool all = most_have_substep(tick); // have a part in it, or what is fast
    uint power = all ? 0u : ticks_power(tick);
    worker_colour = first_colour;
    uint place = worker;
    if (!all) place = next_fast_place(place, power, end);
    uint first = k_none; // of the worker's manifolds that have a part in it
    bool is_ready = false;
    PassTarget target;
    while (goes_on(place < end)) {
        if (place >= end) continue;
        come_by = (place - worker) / workers();
        uint index = manifold_at(place);
        bool has_part = index != k_none;
        if (has_part) has_part = all ? has_substep(index, tick) : is_as_fast(place, power);
        if (has_part) {
            take_in_hand(index, false);
            if (!all) has_part = in_hand_has_substep(tick); // it may be slower than it stands, or of another island
        }
        if (has_part) {
            if (!is_ready) {
                if (pass == k_warm_start)
                    note_whether_unlike();
                else
                    target = target_of_pass(pass, have_moved(pass, tick));
                find_earlier(tick);
                looks_in_hand = 0u;
                is_ready = true;
                if (first == k_none) first = index;
            }
            if (!wait_for_turn()) continue;
            pass_in_turn(pass, index, target);
            is_ready = false;
        }
        place += workers();
        if (!all) place = next_fast_place(place, power, end);
    }
    if (place < end) give_up(); // a driver has ended the loop
    come_by = (place - worker) / workers();
    // The next pass begins with it. Workers with few end with the last colours, and all would wait for what they load.
    if (end > k_many_each * workers()) take_in_hand(first, false);
    bool are_all = colour_offsets[k_overflow_colour + 1u] == colour_offsets[k_first_hub_colour];
    bool move_by_themselves = args.y == 0u && parameters.relax == 1u && ticks_apart == 1u;
    is_settled = !(are_all && ends_tick && move_by_themselves);
    if (is_settled || is_alone()) wait_for_workers();
    if (!are_all) pass_over_hubs_and_overflow(place, pass, tick);
}
