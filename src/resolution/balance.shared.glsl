// SPDX-License-Identifier: MIT
// Balance: whether a sleeper beside something awake still carries what it carried when it fell asleep. docs/solver.md, Sleep.
//
// What stays at rest is in balance: the impulses of its contacts and its weight cancel, and so do their moments (Newton's and Euler's
// laws). A sleeper's contacts with other sleepers have the impulses of then; once those with what is awake have others by more than
// a share of the load, it is out of balance. Sums are whole numbers of a unit of speed, so that it does not matter who adds first.
// In Balances each body has k_balance_words.

const uint k_balance_impulse = 0u;            // three words: impulses over the mass
const uint k_balance_moment = 3u;             // three words: speeds_by_moment
const uint k_balance_load = 6u;               // sizes of the impulses over the mass
const uint k_balance_words = 7u;
const float k_balance_unit = 0.000030517578125f; // m/s
const float k_most_balance = 33554432.0f;        // units that a contact adds at most: sixty of them fit into a word
const float k_share_of_load = 0.125f;            // of the load on a body, by which it may be out of balance
const float k_rounded = 16.0f * k_balance_unit;  // m/s: what may be lost in whole numbers

// What a contact does to one of its bodies in a step.
struct Push {
    vec3 impulse; // N s
    vec3 moment;  // N m s, about the body's centre
    float size;   // N s: the normal impulses alone
};

inline Push add_to_push(Push push, vec3 impulse, vec3 arm)
{
    precise vec3 sum = push.impulse + impulse;
    precise vec3 moment = push.moment + cross3(arm, impulse);
    push.impulse = sum;
    push.moment = moment;
    return push;
}

// `anchors`: from A's centre. `centre`: the body's, from A's. `side`: -1 for A, 1 for B.
inline Push push_of_contact(Manifold manifold, vec4 normal_impulses, vec3 anchors[4], vec3 centre, float side)
{
    Axes frame = contact_frame(manifold.normal);
    Push push;
    push.impulse = vec3(0.0f, 0.0f, 0.0f);
    precise float twist = side * manifold.twist_impulse;
    push.moment = scale3(manifold.normal, twist);
    push.size = 0.0f;
    vec3 middle = vec3(0.0f, 0.0f, 0.0f);
    for (int i = 0; i < 4; ++i) {
        if (uint(i) >= manifold.point_count) continue;
        precise vec3 arm = anchors[i] - centre;
        precise float impulse = side * normal_impulses[i];
        precise float size = push.size + normal_impulses[i];
        push = add_to_push(push, scale3(manifold.normal, impulse), arm);
        push.size = size;
        middle = add_scaled(middle, arm, reciprocal(float(manifold.point_count)));
    }
    precise vec3 friction =
        (frame.x * manifold.tangent_impulse_1 + frame.y * manifold.tangent_impulse_2) * side;
    return add_to_push(push, friction, middle);
}

// How fast a moment (N m s) makes the points of a body go that are farthest from each of its own axes, m/s.
inline vec3 speeds_by_moment(vec3 moment, vec4 rotation, BodyProperties body, BodyShape shape)
{
    vec3 h = shape.half_extents;
    vec3 reach = vec3(length3(vec3(0.0f, h.y, h.z)), length3(vec3(h.x, 0.0f, h.z)), length3(vec3(h.x, h.y, 0.0f)));
    if (is_sphere(shape)) reach = h;
    return multiply3(multiply3(body.inverse_inertia, reach), rotate_back(rotation, moment));
}

// m/s in whole units, as a word.
inline uint balance_word(float speed)
{
    precise float units = speed / k_balance_unit;
    float most = is_finite(units) ? units : k_most_balance; // which is out of balance
    return uint(int(clamp_to(most, -k_most_balance, k_most_balance)));
}

inline float speed_of_balance(uint word)
{
    precise float speed = float(int(word)) * k_balance_unit;
    return speed;
}

// `impulses`, `moments`, `load`: sums of all contacts. What is left is a change of speed, of the centre and of what
// is farthest from an axis of the body.
inline bool is_balanced(vec3 impulses, vec3 moments, float load, float gravity_scale, Parameters p)
{
    precise vec3 weight = p.gravity * (gravity_scale * p.dt);
    precise vec3 left = impulses + weight;
    precise float carried = 0.5f * (load + length3(weight));
    precise float of_load = k_share_of_load * carried;
    float most = max(of_load, k_rounded);
    return length3(left) <= most && length3(moments) <= most;
}
