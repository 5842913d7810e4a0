// SPDX-License-Identifier: MIT
// The hash table that finds a pair's manifold of the last step. Open addressing with linear probing; at most half full.

// The slot at which the search for a pair starts in the pair table. Multiplicative hashing; the mixing constants are
// those of the 32-bit MurmurHash3 finaliser.
inline uint hash_pair(uint body_a, uint body_b)
{
    uint h = body_a * 0x9e3779b1u + body_b;
    h ^= h >> 16;
    h *= 0x85ebca6bu;
    h ^= h >> 13;
    h *= 0xc2b2ae35u;
    h ^= h >> 16;
    return h;
}
