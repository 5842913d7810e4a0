// SPDX-License-Identifier: MIT
// The tree of bounding boxes over the sorted bodies, and the way through it. It has no pointers: a node at height h is
// the run of 4^h places that begins at a multiple of 4^h (F. Chitalu, C. Dubach, T. Komura, "Binary ostensibly-implicit
// trees for fast collision detection", 2020, which has 2 where this has 4). So it needs no hierarchy to be built, equal
// keys are no special case, and its boxes come from sums of fixed shape over neighbours.
//
// A height is written as a shift, 2 h: a node is the places of equal place >> shift. Nodes lie level by level from the
// root, so that the four children of a node are 128 bytes in a row.

const uint k_tree_bits = 2u;
const uint k_tree_children = 1u << k_tree_bits; // of a node; those of 16 levels have a bit each in 64
const uint k_tree_group = 256u; // nodes that one work group treats
const uint k_tree_shift = 8u;   // and how much higher the one node is that they come to

const uint k_most_first_nodes = 512u; // that strays begin with

const uint k_kept_partners = 8u; // of a body, that the search remembers from counting to writing

// The shift of the root.
inline uint tree_top(uint body_count)
{
    uint top = 0u;
    while ((1u << top) < body_count)
        top += k_tree_bits;
    return top;
}

// How many nodes a level has that hold body slots.
inline uint tree_level_size(uint body_count, uint shift)
{
    return (body_count + (1u << shift) - 1u) >> shift;
}

// The shift from which on strays go down the tree: those above are not made for them, as each is a launch that waits for the one before.
inline uint strays_begin_at(uint body_count)
{
    uint shift = k_tree_shift;
    while (tree_level_size(body_count, shift) > k_most_first_nodes)
        shift += k_tree_shift;
    uint top = tree_top(body_count);
    return shift < top ? shift : top;
}

// Index of the node of a place. Above a level of 4^d nodes are 1 + 4 + ... + 4^(d-1): binary 0101...01.
inline uint tree_node(uint place, uint shift, uint top)
{
    return (0x55555555u & ((1u << (top - shift)) - 1u)) + (place >> shift);
}

// The highest node that begins at a place other than the first: where a search goes on that has done with all before. The kernel
// knows it by the children that it has still to enter.
inline uint tree_shift_from(uint place)
{
    return uint(findLSB(place)) & ~(k_tree_bits - 1u);
}

inline Aabb empty_box()
{
    Aabb box;
    box.lower = vec3(3.0e38f, 3.0e38f, 3.0e38f);
    box.margin = 0.0f;
    box.upper = vec3(-3.0e38f, -3.0e38f, -3.0e38f);
    box.movable = 0u;
    return box;
}

// The box around two; movable where one of them is.
inline Aabb unite_boxes(Aabb a, Aabb b)
{
    Aabb box;
    box.lower = min(a.lower, b.lower);
    box.margin = 0.0f;
    box.upper = max(a.upper, b.upper);
    box.movable = a.movable | b.movable;
    return box;
}
