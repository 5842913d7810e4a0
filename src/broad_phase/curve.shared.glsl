// SPDX-License-Identifier: MIT
// The order of the bodies in the tree: by size first, then along a Hilbert curve, so that neighbours in the order are
// neighbours in space. A node of the tree is a run of that order; along a Morton curve, which jumps, runs are longer
// boxes, and a search meets half as many nodes again and more (docs/performance.md).

const uint k_curve_cells = 1024u; // along each axis: 10 bits

// What the order needs to know, from the sums over all movable bodies. Cells are cubes, because a box is near what is
// near along any axis, and reach two standard deviations to each side of the mean, on the axis of largest spread: one
// body that has gone astray does not make them coarse. What lies beyond counts to the outermost cells. Variance is a
// difference of squares; where the bodies are far from the origin it is lost in rounding, so the reach has a share of
// that distance for its least value.
// `body_count`: for the end, should no slot be empty.
inline TreeGrid choose_tree_grid(SpreadSum sum, uint body_count)
{
    precise float inverse_count = reciprocal(max(sum.count, 1.0f));
    precise vec3 mean = sum.centre * inverse_count;
    precise vec3 variance = sum.centre_squared * inverse_count - mean * mean;
    precise float extent = (sum.extent.x + sum.extent.y + sum.extent.z) * inverse_count * (1.0f / 3.0f);
    precise float deviation = square_root(max(max(variance.x, 0.0f), max(variance.y, variance.z)));
    precise float far = 0.002f * max(abs(mean.x), max(abs(mean.y), abs(mean.z)));
    precise float reach = max(max(2.0f * deviation, extent), max(far, 0.001f));
    precise vec3 lower = mean - vec3(reach, reach, reach);
    precise float inverse_cell = (0.5f * float(k_curve_cells)) * reciprocal(reach);
    precise float small_extent = 4.0f * extent;
    TreeGrid grid;
    grid.lower = lower;
    grid.inverse_cell = inverse_cell;
    grid.small_extent = small_extent;
    grid.end = body_count;
    grid.reserved_1 = 0u;
    grid.reserved_2 = 0u;
    return grid;
}

// Bodies of a size have a part of the order to themselves. Large ones among small ones would make all nodes above them
// large, and most bodies would meet those. As each body looks only at those after it, small ones find the large, and a
// floor that a million bodies touch does not have to find them alone.
inline uint size_class(Aabb box, float small_extent)
{
    precise vec3 extent = box.upper - box.lower;
    float longest = max(extent.x, max(extent.y, extent.z));
    if (longest <= small_extent) return 0u;
    if (longest <= 4.0f * small_extent) return 1u;
    return longest <= 16.0f * small_extent ? 2u : 3u;
}

inline uint curve_cell(float centre, float lower, float inverse_cell)
{
    precise float cell = (centre - lower) * inverse_cell;
    if (!(cell > 0.0f)) return 0u; // also what is no number
    return cell >= float(k_curve_cells - 1u) ? k_curve_cells - 1u : uint(cell);
}

// Ten bits, three places apart.
inline uint spread_bits(uint x)
{
    uint bits = (x | (x << 16u)) & 0x030000ffu;
    bits = (bits | (bits << 8u)) & 0x0300f00fu;
    bits = (bits | (bits << 4u)) & 0x030c30c3u;
    return (bits | (bits << 2u)) & 0x09249249u;
}

// Place of a cell along the Hilbert curve, 30 bits (J. Skilling, "Programming the Hilbert curve", 2004). From the
// coarsest cells to the finest, each cell's own curve is turned into a common position; then the bits, interleaved, are
// a Gray code.
inline uint hilbert_place(uint cell_x, uint cell_y, uint cell_z)
{
    uint x = cell_x;
    uint y = cell_y;
    uint z = cell_z;
    for (uint bit = k_curve_cells / 2u; bit > 1u; bit /= 2u) {
        uint finer = bit - 1u;
        if ((x & bit) != 0u) x ^= finer;
        uint change = (y & bit) != 0u ? 0u : (x ^ y) & finer;
        x ^= (y & bit) != 0u ? finer : change;
        y ^= change;
        change = (z & bit) != 0u ? 0u : (x ^ z) & finer;
        x ^= (z & bit) != 0u ? finer : change;
        z ^= change;
    }
    y ^= x;
    z ^= y;
    uint flips = 0u;
    for (uint bit = k_curve_cells / 2u; bit > 1u; bit /= 2u)
        if ((z & bit) != 0u) flips ^= bit - 1u;
    return (spread_bits(x ^ flips) << 2u) | (spread_bits(y ^ flips) << 1u) | spread_bits(z ^ flips);
}

// Whether a box overlaps anything at all: an empty body slot has none, and a body that is nowhere has no numbers.
inline bool has_room(Aabb box)
{
    return box.lower.x <= box.upper.x && box.lower.y <= box.upper.y && box.lower.z <= box.upper.z;
}

// Sorts bodies into the order of the tree; empty slots come last. Bodies of one cell stay in the order of their slots.
inline uint tree_key(Aabb box, TreeGrid grid)
{
    if (!has_room(box)) return k_absent_key;
    precise vec3 centre = 0.5f * (box.lower + box.upper);
    uint place = hilbert_place(curve_cell(centre.x, grid.lower.x, grid.inverse_cell),
                               curve_cell(centre.y, grid.lower.y, grid.inverse_cell),
                               curve_cell(centre.z, grid.lower.z, grid.inverse_cell));
    return min((size_class(box, grid.small_extent) << 30u) | place, k_absent_key - 1u);
}
