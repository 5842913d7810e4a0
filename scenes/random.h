// SPDX-License-Identifier: MIT
// Random numbers for scenes: the same seed gives the same scene with every compiler, standard library and machine. The
// generator is SplitMix64 (Steele, Lea, Flood 2014); floats are made from its top bits with exact operations and
// correctly rounded square roots only, where the distributions of <random> are free to differ from one library to the
// next.
#pragma once

#include <cmath>
#include <cstdint>

#include <talus/types.h>

namespace talus::scenes {

class Random {
public:
    explicit Random(std::uint64_t seed) : state(seed) {}

    std::uint64_t next() {
        state += 0x9e3779b97f4a7c15u;
        std::uint64_t z = state;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }

    /// Uniform in [0, 1): 24 bits, so that every value is a float.
    float unit() { return static_cast<float>(next() >> 40) * 0x1p-24f; }

    float between(float lower, float upper) { return lower + (upper - lower) * unit(); }

    /// Uniform over all rotations. Two points drawn in the unit disc, by rejection, make a point on the 3-sphere
    /// (Marsaglia 1972): no sine or cosine, whose last bit differs between machines.
    Quat rotation() {
        const Disc a = disc();
        Disc b = disc();
        while (b.square == 0.0f)
            b = disc();
        const float scale = std::sqrt((1.0f - a.square) / b.square);
        return {a.x, a.y, b.x * scale, b.y * scale};
    }

private:
    struct Disc {
        float x, y, square;
    };

    Disc disc() {
        for (;;) {
            const float x = between(-1.0f, 1.0f);
            const float y = between(-1.0f, 1.0f);
            const float square = x * x + y * y;
            if (square < 1.0f) return {x, y, square};
        }
    }

    std::uint64_t state;
};

} // namespace talus::scenes
