// SPDX-License-Identifier: MIT
// Which four points of a face contact to keep (thesis, algorithm 8). Needs narrow_phase/clip_face.shared.glsl.

// A point that is not this much deeper than a corner of the contact's outline is not worth giving up the corner (m).
const float k_depth_tie = 1.0e-3f;
// A point that is this much farther above the other box than the deepest one, or than its surface, carries nothing soon
// (m).
const float k_near = 2.5e-3f;
// What a point is worth, however large the area that it gives. Two bits.
const uint k_worth_none = 0u; // there is no point
const uint k_worth_far = 1u;
const uint k_worth_near = 2u;
const uint k_worth_carrying = 3u; // it carried load in the last step

// Below the score of any point.
const uint k_no_score = 1u << 30;

// The best point so far.
struct Pick {
    uint score;
    uint feature;
    vec3 point;
};

// Worth first, then gain: the bits of positive numbers are in their order. What has no worth or no gain is below
// k_no_score.
inline uint score_of(uint worth, float gain)
{
    return gain > 0.0f ? (worth << 30) | (floatBitsToUint(gain) >> 1) : 0u;
}

inline Pick no_pick(vec3 point, uint feature)
{
    Pick pick;
    pick.score = k_no_score;
    pick.feature = feature;
    pick.point = point;
    return pick;
}

inline bool is_picked(Pick pick) { return pick.score > k_no_score; }

inline Pick better_pick(Pick best, Candidates candidates, uint slot, uint worth, float gain)
{
    uint score = score_of(worth, gain);
    if (score > best.score) {
        best.score = score;
        best.feature = candidates.features[slot];
        best.point = candidates.points[slot];
    }
    return best;
}

// Twice the signed area of a triangle, seen in the reference face.
inline float triangle_area(vec3 a, vec3 b, vec3 c)
{
    precise float area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    return area;
}

inline float square_apart(vec3 a, vec3 b)
{
    precise vec3 d = b - a;
    precise float square = d.x * d.x + d.y * d.y;
    return square;
}

// A slot's worth, of all slots' in two bits each.
inline uint worth_of(uint worths, uint slot) { return (worths >> (2u * slot)) & 3u; }

// The first three are the triangle. Which of points that tie is the first is left to their last bits: with the same one
// in all contacts and all steps the solver errs to the same side in each, and a tower of 30 boxes sways by 1.3 mm
// instead of 0.5.
struct Picks {
    Pick picks[4];
    uint count;
};

// The deepest, the farthest from it, the one that makes the largest triangle with these, and the one that adds most
// area beyond its sides. Points that add nothing are left out: those that come twice, or lie on a line with others.
//
// Differs from the thesis in two ways. Of points that are about as deep, the one farthest from the middle is taken
// first: in a resting contact all are, and clipping leaves some amid a side; to start from one of those costs a corner,
// and a tower rocks on the three that are left. And a larger area is no reason to give up what matters: the first two
// are of those that carried load, and the others of those that are near. A box that stands on an edge has few of
// either, and rocks for ever where one comes and goes.
inline Picks reduce_points(Candidates candidates, Carriers carriers)
{
    vec3 sum = vec3(0.0f, 0.0f, 0.0f);
    uint count = 0u;
    Pick deepest = no_pick(vec3(0.0f, 0.0f, k_far_apart), 0u);
    for (uint i = 0u; i < k_candidate_count; i += 1u) {
        if (is_present(candidates, i)) {
            precise vec3 more = sum + candidates.points[i];
            sum = more;
            count += 1u;
            if (candidates.points[i].z < deepest.point.z) {
                deepest.score = k_no_score + 1u;
                deepest.feature = candidates.features[i];
                deepest.point = candidates.points[i];
            }
        }
    }
    precise float near = max(deepest.point.z, 0.0f) + k_near;
    uint worths = 0u;
    for (uint i = 0u; i < k_candidate_count; i += 1u) {
        uint worth = candidates.points[i].z <= near ? k_worth_near : k_worth_far;
        if (carried_load(carriers, candidates.features[i])) worth = k_worth_carrying;
        if (is_present(candidates, i)) worths |= worth << (2u * i);
    }

    vec3 middle = scale3(sum, reciprocal(float(max(count, 1u))));
    Pick first = deepest;
    for (uint i = 0u; i < k_candidate_count; i += 1u)
        first = better_pick(first, candidates, i, worth_of(worths, i), square_apart(middle, candidates.points[i]));
    precise float higher = first.point.z - deepest.point.z;
    if (higher > k_depth_tie) first = deepest;
    vec3 a = first.point;

    Pick second = no_pick(a, first.feature);
    for (uint i = 0u; i < k_candidate_count; i += 1u)
        second = better_pick(second, candidates, i, worth_of(worths, i), square_apart(a, candidates.points[i]));
    vec3 b = second.point;

    Pick third = no_pick(a, first.feature);
    for (uint i = 0u; i < k_candidate_count; i += 1u) {
        float area = abs(triangle_area(a, b, candidates.points[i]));
        third = better_pick(third, candidates, i, min(worth_of(worths, i), k_worth_near), area);
    }
    // Anticlockwise, the area beyond a side is negative.
    bool is_clockwise = triangle_area(a, b, third.point) < 0.0f;
    vec3 c = is_clockwise ? b : third.point;
    b = is_clockwise ? third.point : b;
    Pick fourth = no_pick(a, first.feature);
    for (uint i = 0u; i < k_candidate_count; i += 1u) {
        vec3 p = candidates.points[i];
        float inside = min(triangle_area(a, b, p), min(triangle_area(b, c, p), triangle_area(c, a, p)));
        fourth = better_pick(fourth, candidates, i, min(worth_of(worths, i), k_worth_near), -inside);
    }

    Picks kept;
    kept.picks[0] = first;
    kept.picks[1] = is_picked(third) ? third : second;
    kept.picks[2] = second;
    kept.picks[3] = fourth;
    kept.count = (is_picked(first) ? 1u : 0u) + (is_picked(second) ? 1u : 0u) + (is_picked(third) ? 1u : 0u) +
                 (is_picked(fourth) ? 1u : 0u);
    return kept;
}
