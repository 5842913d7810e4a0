// SPDX-License-Identifier: MIT
// Which groups of a persistent launch pass over which colours, and which of their invocations over which manifolds.
// A colour is passed over by a team of groups. Where half of the groups have an invocation for each of its manifolds there are
// two teams that take turns: while one passes over its colour the other makes those of the next one ready. The first colours
// are those that only a few manifolds have needed. The first group solves these alone while the others make ready for their
// first: a wait among groups takes longer than such a colour does.
// For solve_persistent.glsl, behind solve_substeps.glsl and grid_barrier.glsl.

const uint k_few = 128u; // in all the first colours together, one for an invocation; with more it is slower
const uint k_few_team = 0u;
const uint k_even_team = 1u; // of the colours with even numbers: every other one of the groups that are not alone
const uint k_odd_team = 2u;
const uint k_whole_team = 3u; // both

// For each colour and the overflow set.
shared uint teams[k_max_colours + 1u];         // that pass over it
shared uint dealt_before[k_max_colours + 1u];  // manifolds of earlier colours that its team has, less whole rounds
shared uint ticks_between[k_max_colours + 1u]; // in which some manifold of it may have a sub-step
shared uint expected_arrivals[k_teams];        // known to the first invocation

uint lone_groups;  // that have only the first colours: 1 or none
uvec2 own_colours; // bits for those of which the worker has a manifold
uint own_colour;   // of the manifold that it has come by last
uint own_step;     // to its next one of this colour

// ---- workers ----

// Neighbours in the order of manifolds are 32 by 32 in different groups, as there are often fewer of a colour than
// invocations: all multiprocessors are to have some.
const uint k_neighbours = 32u;

// Of the workers of `groups` groups, if this one's has the number `group`.
uint worker_among(uint group, uint groups)
{
    uint me = gl_LocalInvocationID.x;
    return (me / k_neighbours * groups + group) * k_neighbours + me % k_neighbours;
}

uint worker() { return worker_among(gl_WorkGroupID.x, gl_NumWorkGroups.x); }

bool is_lone() { return gl_WorkGroupID.x < lone_groups; }
uint group_in_teams() { return gl_WorkGroupID.x - lone_groups; }
uint own_team() { return is_lone() ? k_few_team : k_even_team + group_in_teams() % 2u; }

uint groups_of(uint team)
{
    uint both = gl_NumWorkGroups.x - lone_groups;
    return team == k_few_team ? 1u : team == k_whole_team ? both : (both + k_odd_team - team) / 2u;
}

uint workers_of(uint team) { return groups_of(team) * gl_WorkGroupSize.x; }

uint worker_in(uint team)
{
    if (team == k_few_team) return gl_LocalInvocationID.x;
    return worker_among(team == k_whole_team ? group_in_teams() : group_in_teams() / 2u, groups_of(team));
}

// ---- what is dealt ----

bool is_own_colour(uint colour)
{
    uint team = teams[colour];
    return team == own_team() || (team == k_whole_team && !is_lone());
}

bool has_colour(uint colour, uint tick) { return !k_multirate_islands || tick % ticks_between[colour] == 0u; }

// The worker's first manifold of the colour, if that has so many.
uint first_of(uint colour)
{
    uint team = teams[colour];
    uint me = worker_in(team);
    uint dealt = dealt_before[colour];
    own_step = workers_of(team);
    return colour_offsets[colour] + (me < dealt ? me + own_step : me) - dealt;
}

uvec2 bits_from(uint colour)
{
    return colour < 32u ? uvec2(~0u << colour, ~0u) : uvec2(0u, colour < k_max_colours ? ~0u << (colour - 32u) : 0u);
}

// From this colour on. The overflow set is the first worker's, one after the other.
uint first_own_from(uint colour)
{
    uvec2 later = own_colours & bits_from(colour);
    if ((later.x | later.y) != 0u) {
        own_colour = later.x != 0u ? uint(findLSB(later.x)) : 32u + uint(findLSB(later.y));
        return first_of(own_colour);
    }
    bool is_first = !is_lone() && worker_in(k_whole_team) == 0u;
    if (!is_first || colour > k_overflow_colour || colour_offsets[k_overflow_colour + 1u] == end_index) return k_none;
    own_colour = k_overflow_colour;
    own_step = 1u;
    return end_index;
}

uint first_own() { return first_own_from(0u); }

uint after(uint index) { return index + own_step; }

uint settled(uint index)
{
    return index == k_none || index < colour_offsets[own_colour + 1u] ? index : first_own_from(own_colour + 1u);
}

// ---- the deal ----

uint count_of(uint colour) { return colour_offsets[colour + 1u] - colour_offsets[colour]; }

uint team_for(uint colour, uint end_of_few)
{
    if (colour < end_of_few) return k_few_team;
    bool one_is_enough = count_of(colour) <= workers_of(k_odd_team) && colour < k_first_hub_colour;
    return one_is_enough ? k_even_team + colour % 2u : k_whole_team;
}

void deal_manifolds()
{
    uint few_end = gl_NumWorkGroups.x > 1u ? colour_offsets[0] + k_few : 0u;
    uint end_of_few = first_colour; // the first colour that is not one of them
    while (end_of_few < k_first_hub_colour && colour_offsets[end_of_few + 1u] <= few_end)
        ++end_of_few;
    lone_groups = end_of_few > first_colour ? 1u : 0u;
    uint me = gl_LocalInvocationID.x;
    if (me < k_teams) expected_arrivals[me] = 0u;
    for (uint colour = me; colour <= k_overflow_colour; colour += gl_WorkGroupSize.x)
        teams[colour] = team_for(colour, end_of_few);
    barrier();
    for (uint colour = me; colour <= k_overflow_colour; colour += gl_WorkGroupSize.x) {
        uint dealt = 0u;
        for (uint before = first_colour; before < colour; ++before)
            dealt += teams[before] == teams[colour] ? count_of(before) : 0u;
        dealt_before[colour] = dealt % max(workers_of(teams[colour]), 1u); // a single group is no odd team
        if (!k_multirate_islands) continue;
        ticks_between[colour] = ticks_apart * like_substeps / max(colour_substeps[colour], like_substeps);
    }
    barrier();
    own_colours = uvec2(0u);
    for (uint colour = first_colour; colour < k_max_colours; ++colour) {
        if (is_own_colour(colour) && first_of(colour) < colour_offsets[colour + 1u])
            own_colours |= bits_from(colour) & ~bits_from(colour + 1u);
    }
}

// ---- waits ----

void note_pass(uint colour)
{
    uint team = teams[colour];
    if (gl_LocalInvocationID.x == 0u) expected_arrivals[team] += groups_of(team);
}

void arrive(uint colour) { arrive_at(k_team_arrivals + teams[colour]); }

void wait_for_colour(uint colour)
{
    uint team = teams[colour];
    if (team == k_few_team && is_lone())
        memoryBarrierBuffer(); // it has arrived, and barrier() orders shared memory only
    else
        wait_for_arrivals(k_team_arrivals + team, expected_arrivals[team]);
}
