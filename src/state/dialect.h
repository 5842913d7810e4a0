// SPDX-License-Identifier: MIT
// Lets g++ and clang read the *.shared.glsl files. The GLSL side of the dialect is src/device/gl/dialect.glsl.
// docs/conventions.md lists its rules.
#pragma once

#include <bit>
#include <cstdint>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

// Marks a value whose operations must be carried out as written, so that every device gets the same bits. On the CPU
// the compiler option -ffp-contract=off says it for all.
#define precise

namespace talus::engine {

using uint = std::uint32_t;
using glm::vec2;
using glm::vec3;
using glm::vec4;

inline uint floatBitsToUint(float x) {
    return std::bit_cast<uint>(x);
}
inline float uintBitsToFloat(uint x) {
    return std::bit_cast<float>(x);
}
inline float min(float a, float b) {
    return b < a ? b : a;
}
inline float max(float a, float b) {
    return a < b ? b : a;
}
inline uint min(uint a, uint b) {
    return b < a ? b : a;
}
inline uint max(uint a, uint b) {
    return a < b ? b : a;
}
/// Place of the lowest bit that is set; -1 for 0.
inline int findLSB(uint x) {
    return x != 0 ? std::countr_zero(x) : -1;
}
/// Place of the highest bit that is set; -1 for 0.
inline int findMSB(uint x) {
    return 31 - std::countl_zero(x);
}
/// In sums of 2, 4 and 8 bits, of a word or of one in each lane: std::popcount is a call on processors of which it is
/// not known that they can count, and registers cannot.
template <typename Word> [[gnu::always_inline]] inline Word count_bits(Word x) {
    x = x - ((x >> 1) & 0x55555555u);
    x = (x & 0x33333333u) + ((x >> 2) & 0x33333333u);
    return (((x + (x >> 4)) & 0x0f0f0f0fu) * 0x01010101u) >> 24;
}
inline int bitCount(uint x) {
    return static_cast<int>(count_bits(x));
}
inline float abs(float x) {
    return uintBitsToFloat(floatBitsToUint(x) & 0x7fffffffu);
}
inline vec3 min(vec3 a, vec3 b) {
    return vec3(min(a.x, b.x), min(a.y, b.y), min(a.z, b.z));
}
inline vec3 max(vec3 a, vec3 b) {
    return vec3(max(a.x, b.x), max(a.y, b.y), max(a.z, b.z));
}
inline vec3 abs(vec3 v) {
    return vec3(abs(v.x), abs(v.y), abs(v.z));
}

} // namespace talus::engine
