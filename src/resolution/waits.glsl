// SPDX-License-Identifier: MIT
// What contacts that wait for each other one by one have in common, be it across groups (solve_in_order.glsl) or within one
// (solve_in_turn.glsl). Before this file the kernel defines
//   bool have_given_up(), whether somebody has waited in vain, so that nobody is to wait any longer
//   void give_up(), which says so, and lets the host hear of it

uint passes_in_order = 0u; // so far

// Where so many contacts of a body have been solved in this pass.
uint number_after(uint contacts) { return k_max_colours * passes_in_order + contacts; }

const uint k_most_looks = 1u << 22; // some seconds across groups, some tenths of one within: no partner that runs takes so long
const uint k_looks_between = 1024u; // looks at whether somebody has given up

// Whether to look once more at what is not there yet.
bool looks_again(inout uint looks)
{
    ++looks;
    if (looks == k_most_looks) give_up();
    return looks % k_looks_between != 0u || !have_given_up();
}
