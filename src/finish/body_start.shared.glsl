// SPDX-License-Identifier: MIT
// What is kept of how a step has moved a body: where it was, and a turn in one word. Needs state/math.shared.glsl.

const uint k_no_turn_known = k_none; // to which none is packed: with that exponent a component is 128 or more

// A turn that is small, as a vector along its axis (rad): three numbers of nine bits, two's complement, and the exponent that they
// share, from 2^-31 rad to 2. So each is within 1/256 of the largest of them.
const uint k_turn_bits = 9u;
const uint k_least_turn = 96u; // the exponent as a float has it
const float k_turn_round = 12582912.0f; // 1.5 2^23: a small number that is added to it ends in the last bits

inline uint packed_turn_component(float turn, float scale)
{
    precise float number = turn * scale;
    precise float rounded = clamp_to(number, -255.0f, 255.0f) + k_turn_round;
    return floatBitsToUint(rounded) & ((1u << k_turn_bits) - 1u);
}

inline uint pack_turn(vec3 turn)
{
    float largest = max(abs(turn.x), max(abs(turn.y), abs(turn.z)));
    uint exponent = min(max(floatBitsToUint(largest) >> 23, k_least_turn), k_least_turn + 31u);
    float scale = uintBitsToFloat((254u + 7u - exponent) << 23); // which makes the largest 128 to 255
    return packed_turn_component(turn.x, scale) | (packed_turn_component(turn.y, scale) << k_turn_bits) |
           (packed_turn_component(turn.z, scale) << (2u * k_turn_bits)) | ((exponent - k_least_turn) << (3u * k_turn_bits));
}

inline float unpacked_turn_component(uint word, float scale)
{
    uint bits = word & ((1u << k_turn_bits) - 1u);
    float number = float(bits) - choose((bits >> (k_turn_bits - 1u)) != 0u, 512.0f, 0.0f);
    precise float turn = number * scale;
    return turn;
}

inline vec3 unpack_turn(uint word)
{
    float scale = uintBitsToFloat(((word >> (3u * k_turn_bits)) + k_least_turn - 7u) << 23);
    return vec3(unpacked_turn_component(word, scale), unpacked_turn_component(word >> k_turn_bits, scale),
                unpacked_turn_component(word >> (2u * k_turn_bits), scale));
}

// Of a body that a step moves from one pose to another. The turn is what the rotations make of it, by their difference, as most of a
// small one is lost in their product: 2 (q' - q) q*, of which the vector is wanted.
inline BodyStart start_at(BodyPose pose, BodyPose moved)
{
    precise vec4 change = 2.0f * (moved.rotation - pose.rotation);
    vec4 back = vec4(-pose.rotation.x, -pose.rotation.y, -pose.rotation.z, pose.rotation.w);
    vec4 turn = multiply_quaternions(change, back);
    BodyStart start;
    start.position = pose.position;
    start.turn = pack_turn(vec3(turn.x, turn.y, turn.z));
    return start;
}

// Of a body that stays where it is.
inline BodyStart start_of_still(BodyPose pose)
{
    BodyStart start;
    start.position = pose.position;
    start.turn = 0u; // to which no turn is packed
    return start;
}

inline BodyStart forget_turn(BodyStart start)
{
    start.turn = k_no_turn_known;
    return start;
}
