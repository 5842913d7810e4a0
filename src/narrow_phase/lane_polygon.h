// SPDX-License-Identifier: MIT
// The corners of a polygon in each lane: polygon.h for device/cpu/lane_formulas.h, which includes it.

constexpr std::uint32_t k_polygon_corners = 8;

struct Corner {
    vec3 position;
    ULanes label;
};

/// A corner of each lane, in the order in which a register has the halves that are read together: 0, 4, 1, 5, ...
struct alignas(16 * k_lanes) CornerRow {
    std::uint32_t words[4 * k_lanes];
};

/// Its corners lie row by row, and behind them is a row for what does not fit.
struct Polygon {
    CornerRow* rows;
    CornerRow* rows_beside; ///< room for another
    ULanes count;           ///< corners, at most k_polygon_corners
};

/// As in a work group, there is room for two.
inline Polygon empty_polygon() {
    static thread_local CornerRow rows[2][k_polygon_corners + 1];
    return {rows[0], rows[1], 0u};
}

/// An empty one that may be filled while this one is read.
inline Polygon polygon_beside(Polygon polygon) {
    return {polygon.rows_beside, polygon.rows, 0u};
}

inline Corner corner_from(FourLanes words) {
    return {three_of(words), floatBitsToUint(words.w)};
}

/// Of row i.
inline Corner corner_in_row(Polygon polygon, std::uint32_t i) {
    const FloatVector* const row = reinterpret_cast<const FloatVector*>(&polygon.rows[i]);
    return corner_from(transposed({Lanes(row[0]), Lanes(row[1]), Lanes(row[2]), Lanes(row[3])}));
}

/// All lanes of i are the same.
inline Corner corner_of(Polygon polygon, ULanes i) {
    return corner_in_row(polygon, i.v[0]);
}
inline Corner corner_after(Polygon polygon, ULanes i) {
    const Corner next = corner_in_row(polygon, i.v[0] + 1), first = corner_in_row(polygon, 0);
    const Mask is_there = i + 1u < polygon.count;
    return {choose(is_there, next.position, first.position), choose(is_there, next.label, first.label)};
}

/// What a row has of one lane.
struct alignas(16) CornerWords {
    std::uint32_t words[4];
};
inline CornerWords* words_of(Polygon polygon) {
    return reinterpret_cast<CornerWords*>(polygon.rows);
}

/// Of each lane's corner i.
inline Offsets<sizeof(CornerWords)> corner_places(ULanes i) {
#if TALUS_LANES == 4
    constexpr UintVector k_place{0, 16, 32, 48};
#else
    constexpr UintVector k_place{0, 32, 64, 96, 16, 48, 80, 112};
#endif
    const ULanes places = i * std::uint32_t{sizeof(CornerRow)} + ULanes(k_place);
    Offsets<sizeof(CornerWords)> offsets;
    for (int lane = 0; lane < k_lanes; ++lane)
        offsets.bytes[lane] = places.v[lane];
    return offsets;
}

/// A lane that has no such corner gets any.
inline Corner corner_at(Polygon polygon, ULanes i) {
    return corner_from(gather(words_of(polygon), corner_places(min(i, k_polygon_corners)), 0));
}

/// What does not fit is left out: rounding may ask for a ninth.
inline void add_corner(Polygon& polygon, Mask is_wanted, vec3 corner, ULanes label) {
    scatter(words_of(polygon), corner_places(polygon.count), 0, k_lane_mask,
            {corner.x, corner.y, corner.z, uintBitsToFloat(label)});
    polygon.count += choose(is_wanted && polygon.count < k_polygon_corners, 1u, 0u);
}
