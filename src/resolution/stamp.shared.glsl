// SPDX-License-Identifier: MIT
// Which number of contacts have made a velocity what it is: a word in each of its two cells that says so. See
// solve_in_order.glsl.
//
// A GPU moves a cell at once. Were one to do it in parts, what does not belong together would not fit: each word has its own
// factor (odd ones without a pattern) and rotation, so that changes of a few of its bits, which is all that changes where bodies
// rest, do not make up for those of another word, or of the number.

const uint k_stamp = 1u << 31u;    // in every stamp, and in no number that is not negative
const uint k_stamp_of_frozen = 1u; // and in those of a body that was frozen in this launch

inline uint rotate_left(uint word, uint bits) { return word << bits | word >> (32u - bits); }

// Of a cell with these other words. For the same words the stamps of two numbers differ, where these do by less than a hundred
// million.
inline uint stamp_of(uint x, uint y, uint z, uint number)
{
    uint words = x * 0x9e3779b1u + rotate_left(y, 5u) * 0x85ebca77u + rotate_left(z, 10u) * 0xc2b2ae3du;
    uint sum = words + number * 0xb55a4f09u;
    return ((sum ^ sum >> 15u) | k_stamp) & ~k_stamp_of_frozen;
}

inline bool is_stamp(uint word, uint stamp) { return (word & ~k_stamp_of_frozen) == stamp; }
