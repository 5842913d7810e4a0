// SPDX-License-Identifier: MIT
// Numbers of several items side by side, a lane each: what a float, a uint, a bool and vectors of them are where a
// formula runs on TALUS_LANES items at once (lane_formulas.h). Every lane gets the bits that it would get alone.
//
// A file that includes this is compiled for one set of instructions, and names it by TALUS_LANES and TALUS_LANES_NAME.
// Everything is in a namespace of that name and inlined by force, since the linker would otherwise take any file's copy
// of a function for all.
#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/vec3.hpp>
#if TALUS_LANES == 8
#include <immintrin.h>
#endif

#include "state/dialect.h"

namespace talus::engine::TALUS_LANES_NAME {

#define TALUS_LANE [[gnu::always_inline]] inline

inline constexpr int k_lanes = TALUS_LANES;
inline constexpr std::uint32_t k_lane_mask = (1u << k_lanes) - 1u;

typedef float FloatVector __attribute__((vector_size(4 * TALUS_LANES), may_alias));
typedef std::uint32_t UintVector __attribute__((vector_size(4 * TALUS_LANES), may_alias));
typedef std::int32_t MaskVector __attribute__((vector_size(4 * TALUS_LANES), may_alias));

#if TALUS_LANES == 4
#define TALUS_EACH_LANE(x) x, x, x, x
#else
#define TALUS_EACH_LANE(x) x, x, x, x, x, x, x, x
#endif
static_assert(TALUS_LANES == 4 || TALUS_LANES == 8);

/// A bool a lane. A formula that would branch on it alone does not link.
struct Mask {
    MaskVector v;
    Mask() = default;
    constexpr Mask(bool b) : v{TALUS_EACH_LANE(b ? -1 : 0)} {}
    constexpr explicit Mask(MaskVector given) : v(given) {}
    explicit operator bool() const;
};

struct ULanes {
    UintVector v;
    ULanes() = default;
    constexpr ULanes(std::uint32_t x) : v{TALUS_EACH_LANE(x)} {}
    constexpr explicit ULanes(UintVector given) : v(given) {}
    TALUS_LANE explicit ULanes(struct Lanes);
    TALUS_LANE ULanes& operator+=(ULanes b) {
        v += b.v;
        return *this;
    }
    TALUS_LANE ULanes& operator&=(ULanes b) {
        v &= b.v;
        return *this;
    }
    TALUS_LANE ULanes& operator|=(ULanes b) {
        v |= b.v;
        return *this;
    }
    TALUS_LANE ULanes operator~() const { return ULanes(UintVector(~v)); }
};

struct Lanes {
    FloatVector v;
    Lanes() = default;
    constexpr Lanes(float x) : v{TALUS_EACH_LANE(x)} {}
    constexpr explicit Lanes(FloatVector given) : v(given) {}
    TALUS_LANE explicit Lanes(ULanes u) : v(__builtin_convertvector(u.v, FloatVector)) {}
    TALUS_LANE Lanes operator-() const { return Lanes(-v); }
};

/// Of numbers below 2^31; what is none gives 0.
TALUS_LANE ULanes::ULanes(Lanes x)
    : v(UintVector(__builtin_convertvector(x.v == x.v ? x.v : FloatVector{}, MaskVector))) {}

// In constant expressions, as a constant of a formula that others are made of may not be computed when the program
// starts: these instructions would run on machines that do not have them.
#define TALUS_OPERATOR(type, op)                                                                                       \
    TALUS_LANE constexpr type operator op(type a, type b) {                                                            \
        return type(a.v op b.v);                                                                                       \
    }
TALUS_OPERATOR(Lanes, +)
TALUS_OPERATOR(Lanes, -)
TALUS_OPERATOR(Lanes, *)
TALUS_OPERATOR(ULanes, +)
TALUS_OPERATOR(ULanes, -)
TALUS_OPERATOR(ULanes, *)
TALUS_OPERATOR(ULanes, /)
TALUS_OPERATOR(ULanes, %)
TALUS_OPERATOR(ULanes, &)
TALUS_OPERATOR(ULanes, |)
TALUS_OPERATOR(ULanes, ^)
TALUS_OPERATOR(ULanes, <<)
TALUS_OPERATOR(ULanes, >>)
#undef TALUS_OPERATOR

#define TALUS_COMPARISON(type, op)                                                                                     \
    TALUS_LANE Mask operator op(type a, type b) {                                                                      \
        return Mask(MaskVector(a.v op b.v));                                                                           \
    }
TALUS_COMPARISON(Lanes, <)
TALUS_COMPARISON(Lanes, <=)
TALUS_COMPARISON(Lanes, >)
TALUS_COMPARISON(Lanes, >=)
TALUS_COMPARISON(Lanes, ==)
TALUS_COMPARISON(Lanes, !=)
TALUS_COMPARISON(ULanes, <)
TALUS_COMPARISON(ULanes, <=)
TALUS_COMPARISON(ULanes, >)
TALUS_COMPARISON(ULanes, >=)
TALUS_COMPARISON(ULanes, ==)
TALUS_COMPARISON(ULanes, !=)
#undef TALUS_COMPARISON

TALUS_LANE Mask operator&&(Mask a, Mask b) {
    return Mask(a.v & b.v);
}
TALUS_LANE Mask operator||(Mask a, Mask b) {
    return Mask(a.v | b.v);
}
TALUS_LANE Mask operator!=(Mask a, Mask b) {
    return Mask(a.v ^ b.v);
}
TALUS_LANE Mask operator!(Mask a) {
    return Mask(~a.v);
}

/// A bit for each lane.
TALUS_LANE std::uint32_t bits_of(Mask m) {
#if defined(__clang__) || !defined(__SSE2__)
    std::uint32_t bits = 0;
    for (int lane = 0; lane < k_lanes; ++lane)
        bits |= m.v[lane] != 0 ? 1u << lane : 0u;
    return bits;
#elif TALUS_LANES == 4
    typedef float Bytes __attribute__((vector_size(16)));
    return static_cast<std::uint32_t>(__builtin_ia32_movmskps(Bytes(m.v)));
#else
    typedef float Bytes __attribute__((vector_size(32)));
    return static_cast<std::uint32_t>(__builtin_ia32_movmskps256(Bytes(m.v)));
#endif
}

TALUS_LANE Mask mask_of(std::uint32_t bits) {
#if TALUS_LANES == 4
    constexpr UintVector k_bits{1, 2, 4, 8};
#else
    constexpr UintVector k_bits{1, 2, 4, 8, 16, 32, 64, 128};
#endif
    return Mask(MaskVector((bits & k_bits) != 0));
}

TALUS_LANE bool all_lanes(Mask m) {
    return bits_of(m) == k_lane_mask;
}
TALUS_LANE bool any_lane(Mask m) {
    return bits_of(m) != 0;
}

TALUS_LANE Lanes choose(Mask m, Lanes yes, Lanes no) {
    return Lanes(m.v ? yes.v : no.v);
}
TALUS_LANE ULanes choose(Mask m, ULanes yes, ULanes no) {
    return ULanes(m.v ? yes.v : no.v);
}
TALUS_LANE Lanes choose(Mask m, float yes, float no) {
    return choose(m, Lanes(yes), Lanes(no));
}
TALUS_LANE ULanes choose(Mask m, ULanes yes, std::uint32_t no) {
    return choose(m, yes, ULanes(no));
}
TALUS_LANE ULanes choose(Mask m, std::uint32_t yes, std::uint32_t no) {
    return choose(m, ULanes(yes), ULanes(no));
}

TALUS_LANE ULanes floatBitsToUint(Lanes x) {
    return ULanes(UintVector(x.v));
}
TALUS_LANE Lanes uintBitsToFloat(ULanes x) {
    return Lanes(FloatVector(x.v));
}
TALUS_LANE Lanes min(Lanes a, Lanes b) {
    return choose(b < a, b, a);
}
TALUS_LANE Lanes max(Lanes a, Lanes b) {
    return choose(a < b, b, a);
}
TALUS_LANE ULanes min(ULanes a, ULanes b) {
    return choose(b < a, b, a);
}
TALUS_LANE ULanes max(ULanes a, ULanes b) {
    return choose(a < b, b, a);
}
TALUS_LANE Lanes abs(Lanes x) {
    return uintBitsToFloat(floatBitsToUint(x) & 0x7fffffffu);
}

TALUS_LANE ULanes bitCount(ULanes x) {
    return count_bits(x);
}
/// Place of the lowest bit that is set; 32 for 0.
TALUS_LANE ULanes findLSB(ULanes x) {
    return bitCount(~x & (x - 1u));
}

// ---- vectors ----

struct vec2 {
    Lanes x, y;
    vec2() = default;
    TALUS_LANE vec2(Lanes x0, Lanes y0) : x(x0), y(y0) {}
};

struct vec3 {
    Lanes x, y, z;
    vec3() = default;
    TALUS_LANE vec3(Lanes x0, Lanes y0, Lanes z0) : x(x0), y(y0), z(z0) {}
    TALUS_LANE explicit vec3(Lanes s) : x(s), y(s), z(s) {}
    TALUS_LANE vec3(glm::vec3 same_in_all) : x(same_in_all.x), y(same_in_all.y), z(same_in_all.z) {}
};

struct vec4 {
    Lanes x, y, z, w;
    vec4() = default;
    TALUS_LANE vec4(Lanes x0, Lanes y0, Lanes z0, Lanes w0) : x(x0), y(y0), z(z0), w(w0) {}
    TALUS_LANE explicit vec4(Lanes s) : x(s), y(s), z(s), w(s) {}
    TALUS_LANE Lanes& operator[](int i) { return i == 0 ? x : i == 1 ? y : i == 2 ? z : w; }
};

#define TALUS_OPERATOR(op)                                                                                             \
    TALUS_LANE vec3 operator op(vec3 a, vec3 b) {                                                                      \
        return {a.x op b.x, a.y op b.y, a.z op b.z};                                                                   \
    }                                                                                                                  \
    TALUS_LANE vec3 operator op(vec3 a, Lanes b) {                                                                     \
        return {a.x op b, a.y op b, a.z op b};                                                                         \
    }                                                                                                                  \
    TALUS_LANE vec3 operator op(Lanes a, vec3 b) {                                                                     \
        return {a op b.x, a op b.y, a op b.z};                                                                         \
    }                                                                                                                  \
    TALUS_LANE vec4 operator op(vec4 a, vec4 b) {                                                                      \
        return {a.x op b.x, a.y op b.y, a.z op b.z, a.w op b.w};                                                       \
    }                                                                                                                  \
    TALUS_LANE vec4 operator op(vec4 a, Lanes b) {                                                                     \
        return {a.x op b, a.y op b, a.z op b, a.w op b};                                                               \
    }                                                                                                                  \
    TALUS_LANE vec4 operator op(Lanes a, vec4 b) {                                                                     \
        return {a op b.x, a op b.y, a op b.z, a op b.w};                                                               \
    }
TALUS_OPERATOR(+)
TALUS_OPERATOR(-)
TALUS_OPERATOR(*)
#undef TALUS_OPERATOR

TALUS_LANE vec3 min(vec3 a, vec3 b) {
    return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)};
}
TALUS_LANE vec3 max(vec3 a, vec3 b) {
    return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)};
}
TALUS_LANE vec3 abs(vec3 v) {
    return {abs(v.x), abs(v.y), abs(v.z)};
}
TALUS_LANE vec3 choose(Mask m, vec3 yes, vec3 no) {
    return {choose(m, yes.x, no.x), choose(m, yes.y, no.y), choose(m, yes.z, no.z)};
}
TALUS_LANE vec4 choose(Mask m, vec4 yes, vec4 no) {
    return {choose(m, yes.x, no.x), choose(m, yes.y, no.y), choose(m, yes.z, no.z), choose(m, yes.w, no.w)};
}

// ---- records in memory ----

typedef float Cell __attribute__((vector_size(16), may_alias, aligned(4))); // four words of one item

/// Four of a thing, named one by one and nowhere seen by its address, so that the compiler keeps all in registers.
struct FourLanes {
    Lanes x, y, z, w;
};

/// In each quarter of the lanes, which are four, rows become columns.
TALUS_LANE FourLanes transposed(FourLanes r) {
    const auto low = [](Lanes a, Lanes b) __attribute__((always_inline)) {
#if TALUS_LANES == 4
        return __builtin_shufflevector(a.v, b.v, 0, 4, 1, 5);
#else
        return __builtin_shufflevector(a.v, b.v, 0, 8, 1, 9, 4, 12, 5, 13);
#endif
    };
    const auto high = [](Lanes a, Lanes b) __attribute__((always_inline)) {
#if TALUS_LANES == 4
        return __builtin_shufflevector(a.v, b.v, 2, 6, 3, 7);
#else
        return __builtin_shufflevector(a.v, b.v, 2, 10, 3, 11, 6, 14, 7, 15);
#endif
    };
    const Lanes xz_low(low(r.x, r.z)), yw_low(low(r.y, r.w)), xz_high(high(r.x, r.z)), yw_high(high(r.y, r.w));
    return {Lanes(low(xz_low, yw_low)), Lanes(high(xz_low, yw_low)), Lanes(low(xz_high, yw_high)),
            Lanes(high(xz_high, yw_high))};
}

/// Where an item lies in each lane: its number, or how many bytes after the first one.
template <std::size_t record_size> struct Offsets { std::size_t bytes[k_lanes]; };
template <typename Record> TALUS_LANE Record* item_at(Record* items, const std::uint32_t* places, std::size_t lane) {
    return items + places[lane];
}
template <typename Record>
TALUS_LANE Record* item_at(Record* items, const Offsets<sizeof(Record)>& places, std::size_t lane) {
    return reinterpret_cast<Record*>(reinterpret_cast<std::uintptr_t>(items) + places.bytes[lane]);
}

/// The four words of the cell `cell` of an item in each lane.
template <typename Record, typename Places>
TALUS_LANE FourLanes gather(const Record* items, const Places& places, std::size_t cell) {
    const auto at = [&](std::size_t lane) __attribute__((always_inline)) {
        return reinterpret_cast<const Cell*>(item_at(items, places, lane))[cell];
    };
    const auto row = [&](std::size_t lane) __attribute__((always_inline)) {
#if TALUS_LANES == 4
        return Lanes(FloatVector(at(lane)));
#else
        return Lanes(FloatVector(_mm256_set_m128(at(lane + 4), at(lane))));
#endif
    };
    return transposed({row(0), row(1), row(2), row(3)});
}

/// Writes them, to the items whose lane has its bit set.
template <typename Record, typename Places>
TALUS_LANE void scatter(Record* items, const Places& places, std::size_t cell, std::uint32_t lanes, FourLanes words) {
    const FourLanes rows = transposed(words);
    const auto put = [&](std::size_t lane, Lanes row, bool always) __attribute__((always_inline)) {
        const auto put_cell = [&](std::size_t to, Cell value) __attribute__((always_inline)) {
            if (always || (lanes >> to & 1u) != 0) reinterpret_cast<Cell*>(item_at(items, places, to))[cell] = value;
        };
#if TALUS_LANES == 4
        put_cell(lane, Cell(row.v));
#else
        put_cell(lane, _mm256_castps256_ps128(row.v));
        put_cell(lane + 4, _mm256_extractf128_ps(row.v, 1));
#endif
    };
    const auto put_rows = [&](bool always) __attribute__((always_inline)) {
        put(0, rows.x, always);
        put(1, rows.y, always);
        put(2, rows.z, always);
        put(3, rows.w, always);
    };
    if (lanes == k_lane_mask)
        put_rows(true);
    else
        put_rows(false);
}

/// The first three of four words.
TALUS_LANE vec3 three_of(FourLanes words) {
    return {words.x, words.y, words.z};
}
TALUS_LANE vec4 all_of(FourLanes words) {
    return {words.x, words.y, words.z, words.w};
}

} // namespace talus::engine::TALUS_LANES_NAME
