// SPDX-License-Identifier: MIT
// ContactConstraint::counts. From the low bits on: its points; how many contacts of its bodies a pass solves before it, and
// whether it is their last one; its sub-steps.
//
// The second is what a contact has to know where contacts wait for each other one by one, and not for whole colours. Colours are
// solved in ascending order, and a body has one contact of each. Those of hubs, and the overflow set, follow in an order of
// their own. At a body that contacts cannot push, or that was frozen before the step, nobody waits: there all is 0.

const uint k_point_bits = 3u;
const uint k_earlier_bits = 6u;
const uint k_earlier_of_a = k_point_bits;
const uint k_earlier_of_b = k_earlier_of_a + k_earlier_bits;
const uint k_last_of_a = k_earlier_of_b + k_earlier_bits;
const uint k_last_of_b = k_last_of_a + 1u;
const uint k_contact_substeps = k_last_of_b + 1u; // the rest, 15 bits

inline uint contacts_of_body(uint traits) { return (traits >> k_contacts_of_body) & ((1u << k_earlier_bits) - 1u); }

inline uint point_count_of(uint counts) { return counts & ((1u << k_point_bits) - 1u); }
inline uint earlier_of(uint counts, uint shift) { return (counts >> shift) & ((1u << k_earlier_bits) - 1u); }
inline bool is_last_of(uint counts, uint shift) { return ((counts >> shift) & 1u) != 0u; }
inline uint substeps_of_contact(uint counts) { return counts >> k_contact_substeps; }
