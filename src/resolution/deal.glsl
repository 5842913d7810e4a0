// SPDX-License-Identifier: MIT
// How manifolds are dealt to workers: by some of a colour, with the rest of it as the last ones, to that many workers next to each
// other. A place of the deal has a manifold or is empty.
// For kernels that include solve_substeps.glsl before this file, and say
//   const uint k_dealt_together, by how many
//   uint workers(), how many there are to deal to
//   uint count_of(uint colour), uint manifold_of(uint colour, uint i), which manifolds of a colour are dealt to them
//   bool is_first_worker(), of all

uint worker; // of these

shared uint first_places[k_max_colours + 1u]; // of each colour; then the end
uint worker_colour;                           // of the worker's present place

uint round_up(uint count, uint multiple) { return (count + multiple - 1u) / multiple * multiple; }

uint places_of(uint colour) { return round_up(count_of(colour), k_dealt_together); }

// By all invocations of a group.
void find_places()
{
    for (uint colour = gl_LocalInvocationID.x; colour <= k_max_colours; colour += gl_WorkGroupSize.x) {
        uint places = 0u;
        for (uint before = first_colour; before < colour; ++before)
            places += places_of(before);
        first_places[colour] = places;
    }
    barrier();
}

// Of later places one after the other.
uint manifold_at(uint place)
{
    if (k_dealt_together == 1u) return colour_offsets[0] + place; // none is empty
    while (first_places[worker_colour + 1u] <= place)
        ++worker_colour;
    uint i = place - first_places[worker_colour];
    return i < count_of(worker_colour) ? manifold_of(worker_colour, i) : k_none;
}

// ---- the overflow set ----
//
// It is the first worker's, one manifold after the other, behind all that have a colour.

bool is_first_worker();

uint overflow_place; // where it begins among the places
uint end_place;      // where all of them end

// `has_overflow`: the first worker is one of these.
void find_end_of_places(bool has_overflow)
{
    uint overflow = has_overflow ? colour_offsets[k_overflow_colour + 1u] - end_index : 0u;
    end_place = first_places[k_max_colours];
    overflow_place = overflow == 0u ? end_place : round_up(end_place, workers());
    if (overflow > 0u) end_place = overflow_place + overflow * workers();
}

// With the manifolds of a colour, or of the overflow set.
uint end_of_places(uint colour) { return colour == k_overflow_colour ? end_place : first_places[colour + 1u]; }

uint own_manifold_at(uint place)
{
    if (place < first_places[k_max_colours]) return manifold_at(place);
    return is_first_worker() && place >= overflow_place ? end_index + (place - overflow_place) / workers() : k_none;
}
