// SPDX-License-Identifier: MIT
// How soft contacts are in a sub-step. docs/solver.md has the derivation; load.shared.glsl has how many sub-steps there are.

struct Softness {
    float bias_rate;     // 1/s
    float mass_scale;    // 1 for a rigid row
    float impulse_scale; // 0 for a rigid row
};

// A spring and a damper of angular frequency w and damping ratio z, stepped implicitly over h, which is stable however
// stiff they are. Catto, "Soft Contacts" (2023) and "Solver2D" (2024).
inline Softness soft_row(float w, float z, float h)
{
    precise float a = 2.0f * z + h * w;
    precise float b = h * w * a;
    precise float bias_rate = w * reciprocal(a);
    precise float impulse_scale = reciprocal(1.0f + b);
    precise float mass_scale = b * impulse_scale;
    Softness soft;
    soft.bias_rate = bias_rate;
    soft.mass_scale = mass_scale;
    soft.impulse_scale = impulse_scale;
    return soft;
}

// What a contact needs to know of one of the equal parts of a step.
struct Substep {
    float inv_h; // 1/s
    Softness soft;
    float push_speed; // m/s, of what overlaps, at most
    float let_go;     // how many times faster impulses fall that throw: see let_go_of_thrown in contact.shared.glsl
};

// How many times as heavy as the two bodies is what they carry or stop, roughly: the speed that the impulses of the last
// step, or of this one so far, give to both, over one that a light load does not reach. solver.md, Heavy on light.
const float k_per_light_load = 0.125f; // s/m: over 8 m/s

inline float heaviness(float load_speed)
{
    precise float ratio = load_speed * k_per_light_load;
    return clamp_to(ratio, 1.0f, 1.0e6f);
}

// Most contacts are, and then a sub-step is the same for all of one length.
inline bool is_light(float load_speed) { return heaviness(load_speed) <= 1.0f; }

// What is heavy is pushed apart more slowly: down to this share of the push speed, as more than one contact may push it.
const float k_least_push_share = 0.166666672f; // a sixth

// Heavier than this is what a light body would throw back. Less is what light bodies carry at rest in a heap, which
// never came to rest where their impulses were taken away.
const float k_throwing = 8.0f;

inline float substep_length(uint substeps, Parameters p)
{
    precise float h = p.dt * reciprocal(float(substeps));
    return h;
}

// rad/s: an eighth of the sub-step rate, the stiffest that does not ring, and at most Parameters::contact_frequency; twice
// that against a body that cannot be pushed.
inline float contact_frequency_at(uint substeps, bool against_static, Parameters p)
{
    precise float eighth = 0.785398163f * (p.inv_dt * float(substeps)); // 2 pi / 8
    precise float w = min(eighth, p.contact_frequency) * choose(against_static, 2.0f, 1.0f);
    return w;
}

// Baumgarte's rows are rigid, with the bias rate of equation 3.17. The damping ratio is meant for the mass that swings on the
// contact, so that it grows with the root of that. `load_speed`: see load_speed_so_far in contact.shared.glsl.
inline Substep make_substep(uint substeps, bool against_static, float load_speed, Parameters p)
{
    Substep s;
    float h = substep_length(substeps, p);
    precise float inv_h = p.inv_dt * float(substeps);
    s.inv_h = inv_h;
    if (p.baumgarte > 0.0f) {
        precise float rate = p.baumgarte * inv_h;
        s.soft.bias_rate = rate;
        s.soft.mass_scale = 1.0f;
        s.soft.impulse_scale = 0.0f;
        s.push_speed = p.contact_push_speed;
        s.let_go = 0.0f;
    } else {
        float w = contact_frequency_at(substeps, against_static, p);
        float heavy = heaviness(load_speed);
        precise float damping_ratio = p.contact_damping_ratio * square_root(heavy);
        s.soft = soft_row(w, damping_ratio, h);
        precise float slower = p.contact_push_speed * max(reciprocal(heavy), k_least_push_share);
        precise float let_go = max(heavy - k_throwing, 0.0f);
        s.let_go = let_go;
        s.push_speed = choose(heavy > 1.0f, slower, p.contact_push_speed);
    }
    return s;
}

// ---- lift ----

// A soft contact gives way to its load F by F / (w^2 m), with m the sum of its points' effective masses. Most of what it would
// give way to the load that lasts is taken for the distance at which the surfaces begin to push, so that under this load
// they touch where the shapes do. What the load does within a few steps meets the same spring as before. A part is
// left: contacts that carried a load together would pass it on to and fro if each kept its distance exactly.
const float k_lifted_share = 0.75f; // a spring of four times the stiffness, to what lasts
const float k_most_lift = 0.005f;   // m

// Baumgarte's rows are rigid: they have no frequency, and no lift.
inline float lift_of(float force, float effective_mass, uint substeps, bool against_static, Parameters p)
{
    float w = contact_frequency_at(substeps, against_static, p);
    precise float stiffness = w * w * effective_mass;
    precise float lift = k_lifted_share * force * reciprocal(stiffness);
    return choose(stiffness > 0.0f && lift > 0.0f, min(lift, k_most_lift), 0.0f);
}
