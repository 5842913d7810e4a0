// SPDX-License-Identifier: MIT
// The shared formulas one by one, against the same in double precision.
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <set>
#include <unordered_set>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "parameters.h"
#include "state/formulas.h"

namespace talus::engine {
namespace {

constexpr uint k_mantissas = 1u << 23;

/// |value - exact| in units in the last place of a float of the size of `exact`.
double error_in_ulps(float value, double exact) {
    const double ulp = std::ldexp(1.0, std::ilogb(exact) - 23);
    return std::abs(value - exact) / ulp;
}

class Samples {
public:
    float number(float lower, float upper) { return std::uniform_real_distribution<float>(lower, upper)(random); }
    vec3 vector(float size = 1.0f) {
        const float x = number(-size, size), y = number(-size, size);
        return {x, y, number(-size, size)};
    }
    vec3 direction() {
        std::normal_distribution<double> normal;
        const glm::dvec3 v(normal(random), normal(random), normal(random));
        return glm::normalize(v);
    }
    vec4 rotation() {
        std::normal_distribution<double> normal;
        const glm::dvec4 q(normal(random), normal(random), normal(random), normal(random));
        return glm::normalize(q);
    }

private:
    std::mt19937 random{12345};
};

glm::dmat3 matrix_of(vec4 q) {
    return glm::mat3_cast(glm::dquat(q.w, q.x, q.y, q.z));
}

double distance(glm::dvec3 a, glm::dvec3 b) {
    return glm::length(a - b);
}

// ---- numbers ----

TEST(Math, reciprocal_is_within_two_units_in_the_last_place) {
    // The method treats all exponents alike, so one is tried with every mantissa, and the others with some.
    double largest = 0.0;
    for (uint mantissa = 0; mantissa < k_mantissas; ++mantissa) {
        const float x = uintBitsToFloat(0x3f800000u | mantissa);
        largest = std::max(largest, error_in_ulps(reciprocal(x), 1.0 / x));
    }
    for (uint exponent = 2; exponent <= 251; ++exponent) {
        for (uint mantissa = 0; mantissa < k_mantissas; mantissa += 10007) {
            const float x = uintBitsToFloat(exponent << 23 | mantissa);
            largest = std::max(largest, error_in_ulps(reciprocal(x), 1.0 / x));
            ASSERT_EQ(reciprocal(-x), -reciprocal(x)) << x;
        }
    }
    EXPECT_LE(largest, 2.0);
}

TEST(Math, inverse_square_root_is_within_two_units_in_the_last_place) {
    double largest = 0.0;
    for (const uint exponent : {0x3f800000u, 0x40000000u}) { // even and odd powers of two differ
        for (uint mantissa = 0; mantissa < k_mantissas; ++mantissa) {
            const float x = uintBitsToFloat(exponent | mantissa);
            largest = std::max(largest, error_in_ulps(inverse_sqrt(x), 1.0 / std::sqrt(double{x})));
        }
    }
    for (uint exponent = 2; exponent <= 254; ++exponent) {
        for (uint mantissa = 0; mantissa < k_mantissas; mantissa += 10007) {
            const float x = uintBitsToFloat(exponent << 23 | mantissa);
            largest = std::max(largest, error_in_ulps(inverse_sqrt(x), 1.0 / std::sqrt(double{x})));
        }
    }
    EXPECT_LE(largest, 2.0);
}

TEST(Math, square_root_of_nothing_is_nothing) {
    EXPECT_TRUE(std::isfinite(inverse_sqrt(0.0f)));
    EXPECT_EQ(square_root(0.0f), 0.0f);
    EXPECT_EQ(length3(vec3(0.0f)), 0.0f);
    EXPECT_NEAR(length3(vec3(3.0f, 4.0f, 12.0f)), 13.0f, 4e-6f);
}

TEST(Math, finite_numbers_are_told_from_the_others) {
    using Limits = std::numeric_limits<float>;
    for (const float x :
         {0.0f, -0.0f, 1.0f, -1.0f, Limits::max(), Limits::lowest(), Limits::min(), Limits::denorm_min()})
        EXPECT_TRUE(is_finite(x)) << x;
    for (const float x : {Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN(), -Limits::quiet_NaN()}) {
        EXPECT_FALSE(is_finite(x)) << x;
        for (int i = 0; i < 3; ++i) {
            vec3 v(1.0f);
            v[i] = x;
            EXPECT_FALSE(is_finite3(v)) << i;
        }
    }
}

// ---- rotations ----

TEST(Math, a_quaternion_turns_a_vector_as_its_matrix_does) {
    Samples samples;
    for (int i = 0; i < 10'000; ++i) {
        const vec4 q = samples.rotation();
        const vec3 v = samples.vector(10.0f);
        const glm::dmat3 matrix = matrix_of(q);
        const Axes axes = rotation_axes(q);
        // 10 m times a few roundings of 6e-8 each.
        ASSERT_LT(distance(rotate(q, v), matrix * glm::dvec3(v)), 1e-5);
        ASSERT_LT(distance(rotate_back(q, v), glm::transpose(matrix) * glm::dvec3(v)), 1e-5);
        ASSERT_LT(distance(to_world(axes, v), matrix * glm::dvec3(v)), 1e-5);
        ASSERT_LT(distance(to_local(axes, v), glm::transpose(matrix) * glm::dvec3(v)), 1e-5);
    }
}

TEST(Math, the_product_of_two_quaternions_turns_by_the_right_one_first) {
    Samples samples;
    for (int i = 0; i < 1'000; ++i) {
        const vec4 a = samples.rotation(), b = samples.rotation();
        const vec3 v = samples.vector();
        ASSERT_LT(distance(rotate(multiply_quaternions(a, b), v), rotate(a, rotate(b, v))), 2e-6);
    }
}

TEST(Math, a_rotation_is_integrated_to_fifth_order) {
    Samples samples;
    for (int i = 0; i < 10'000; ++i) {
        const vec4 start = samples.rotation();
        const vec3 axis = samples.direction();
        const float angle = samples.number(0.0f, 0.8f), h = samples.number(1e-3f, 0.1f);
        const vec4 end = integrate_rotation(start, axis * (angle / h), h);
        const double s = std::sin(0.5 * angle);
        const glm::dquat exact = glm::dquat(std::cos(0.5 * angle), s * axis.x, s * axis.y, s * axis.z) *
                                 glm::dquat(start.w, start.x, start.y, start.z);
        const glm::dquat off = glm::conjugate(exact) * glm::dquat(end.w, end.x, end.y, end.z);
        const double angle_off = 2.0 * std::asin(glm::length(glm::dvec3(off.x, off.y, off.z)));
        // The next term of tan(a/2) is a^5 / 240, and the angle is twice that.
        ASSERT_LT(angle_off, std::pow(angle, 5) / 120.0 + 2e-6) << angle;
        ASSERT_NEAR(end.x * end.x + end.y * end.y + end.z * end.z + end.w * end.w, 1.0f, 1e-6f);
    }
}

TEST(Math, world_inertia_is_the_body_inertia_turned) {
    Samples samples;
    for (int i = 0; i < 1'000; ++i) {
        const vec4 q = samples.rotation();
        const vec3 inverse(samples.number(0.1f, 2.0f), samples.number(0.1f, 2.0f), samples.number(0.1f, 2.0f));
        const vec3 v = samples.vector();
        const glm::dmat3 r = matrix_of(q);
        const glm::dvec3 expected = r * (glm::dvec3(inverse) * (glm::transpose(r) * glm::dvec3(v)));
        ASSERT_LT(distance(multiply_inertia(world_inertia(q, inverse, k_trait_movable, 8), v), expected), 3e-6);
        ASSERT_EQ(multiply_inertia(world_inertia(q, inverse, 0, 8), v), vec3(0.0f));
    }
}

TEST(Math, a_free_turn_keeps_energy_and_angular_momentum) {
    Samples samples;
    for (int i = 0; i < 1'000; ++i) {
        const vec3 inertia(samples.number(0.5f, 2.0f), samples.number(0.5f, 2.0f), samples.number(0.5f, 2.0f));
        const vec3 w = samples.vector(10.0f);
        const vec3 next = turn_freely(w, 1.0f / inertia, 0.01f);
        const auto energy = [&](vec3 a) { return glm::dot(glm::dvec3(inertia) * glm::dvec3(a), glm::dvec3(a)); };
        const auto momentum = [&](vec3 a) { return glm::length(glm::dvec3(inertia) * glm::dvec3(a)); };
        // A tenth of a radian a step, four rounds of iteration: float precision.
        ASSERT_NEAR(energy(next) / energy(w), 1.0, 3e-5);
        ASSERT_NEAR(momentum(next) / momentum(w), 1.0, 3e-5);
    }
}

// ---- contacts ----

TEST(Math, contact_frames_are_right_handed) {
    Samples samples;
    std::vector<vec3> normals{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const float z : {1e-7f, -1e-7f, 1.0f - 1e-6f, -1.0f + 1e-6f})
        normals.push_back(glm::normalize(vec3(std::sqrt(1.0f - z * z), 0.0f, z)));
    for (int i = 0; i < 10'000; ++i)
        normals.push_back(samples.direction());
    for (const vec3 n : normals) {
        const Axes frame = contact_frame(n);
        ASSERT_EQ(frame.z, n);
        ASSERT_NEAR(glm::length(frame.x), 1.0f, 2e-6f);
        ASSERT_NEAR(glm::length(frame.y), 1.0f, 2e-6f);
        ASSERT_NEAR(glm::dot(frame.x, frame.y), 0.0f, 2e-6f);
        ASSERT_LT(distance(glm::cross(frame.x, frame.y), n), 4e-6);
    }
}

Parameters parameters_for(const Settings& settings) {
    const Passes passes = passes_of(settings);
    StepPlan plan;
    plan.least_substeps = passes.least_substeps;
    plan.most_substeps = passes.most_substeps;
    plan.iterations = passes.iterations;
    plan.relax = passes.relax;
    return make_parameters(settings, plan);
}

TEST(Math, a_soft_contact_never_overshoots) {
    for (const float hertz : {0.001f, 1.0f, 30.0f, 1e5f}) {
        for (const float damping : {0.0f, 1.0f, 10.0f, 1000.0f}) {
            for (const std::uint32_t substeps : {1u, 4u, 100u}) {
                Settings settings;
                settings.contact_hertz = hertz;
                settings.contact_damping_ratio = damping;
                const Parameters p = parameters_for(settings);
                SCOPED_TRACE(testing::Message() << hertz << " Hz, damping " << damping << ", sub-steps " << substeps);
                const float h = substep_length(substeps, p);
                for (const bool against_static : {false, true}) {
                    for (const float load_speed : {0.0f, 300.0f, 1e30f}) {
                        const Softness s = make_substep(substeps, against_static, load_speed, p).soft;
                        // At most the whole overlap is removed in a sub-step, and the row is between absent and rigid.
                        EXPECT_GE(s.bias_rate * h, 0.0f);
                        EXPECT_LE(s.bias_rate * h, 1.000001f);
                        EXPECT_NEAR(s.mass_scale + s.impulse_scale, 1.0f, 1e-6f);
                        EXPECT_GE(s.mass_scale, 0.0f);
                        EXPECT_LE(s.mass_scale, 1.0f);
                    }
                }
                const Softness moving = make_substep(substeps, false, 0.0f, p).soft;
                const Softness against_static = make_substep(substeps, true, 0.0f, p).soft;
                EXPECT_GE(against_static.mass_scale, moving.mass_scale);
                EXPECT_GE(against_static.bias_rate, moving.bias_rate);
            }
        }
    }
}

TEST(Math, softness_has_the_limits_of_its_spring) {
    Settings settings;
    settings.contact_hertz = 1e-3f;
    settings.contact_damping_ratio = 1.0f;
    Softness soft = make_substep(4, false, 0.0f, parameters_for(settings)).soft;
    EXPECT_LT(soft.mass_scale, 1e-3f) << "a spring of almost no stiffness";
    EXPECT_NEAR(soft.bias_rate, std::numbers::pi_v<float> * 1e-3f, 1e-6f) << "w / 2z where h w is small";

    // Stiffer than an eighth of the sub-step rate is not possible.
    settings.contact_hertz = 4.0f * 60.0f / 8.0f;
    soft = make_substep(4, false, 0.0f, parameters_for(settings)).soft;
    settings.contact_hertz = 1e5f;
    EXPECT_FLOAT_EQ(make_substep(4, false, 0.0f, parameters_for(settings)).soft.bias_rate, soft.bias_rate);
    EXPECT_GT(make_substep(5, false, 0.0f, parameters_for(settings)).soft.bias_rate, soft.bias_rate);

    settings.stabilisation = Stabilisation::Baumgarte; // equation 3.17: beta / dt, and a rigid row
    settings.baumgarte = 0.3f;
    const Parameters p = parameters_for(settings);
    soft = make_substep(1, false, 0.0f, p).soft;
    EXPECT_FLOAT_EQ(substep_length(1, p), settings.dt);
    EXPECT_FLOAT_EQ(soft.bias_rate, 0.3f / settings.dt);
    EXPECT_EQ(soft.mass_scale, 1.0f);
    EXPECT_EQ(soft.impulse_scale, 0.0f);
    EXPECT_EQ(p.relax, 0u);
    EXPECT_EQ(p.most_substeps, 1u);
}

TEST(Math, a_heavy_load_is_damped_in_proportion_and_pushed_apart_more_slowly) {
    Settings settings;
    const auto of_damping = [&](float ratio, float load_speed) {
        settings.contact_damping_ratio = ratio;
        return make_substep(8, false, load_speed, parameters_for(settings));
    };
    const Substep light = of_damping(5.0f, 8.0f), heavy = of_damping(5.0f, 800.0f);
    EXPECT_EQ(light.soft.bias_rate, of_damping(5.0f, 0.0f).soft.bias_rate) << "up to 8 m/s nothing is heavy";
    EXPECT_EQ(light.push_speed, settings.contact_push_speed);
    // A hundred times the mass on the same spring has a tenth of the damping ratio: ten times as much is asked for.
    EXPECT_NEAR(heavy.soft.bias_rate / of_damping(50.0f, 0.0f).soft.bias_rate, 1.0f, 1e-5f);
    EXPECT_NEAR(of_damping(5.0f, 16.0f).push_speed, 0.5f * settings.contact_push_speed, 1e-5f);
    EXPECT_NEAR(heavy.push_speed, settings.contact_push_speed / 6.0f, 1e-5f);

    settings.stabilisation = Stabilisation::Baumgarte;
    EXPECT_EQ(of_damping(5.0f, 800.0f).push_speed, settings.contact_push_speed);
}

TEST(Math, substeps_grow_with_the_load_and_are_enough_for_it) {
    const Parameters p = parameters_for(Settings{});
    EXPECT_EQ(substeps_for(needed_substeps(0.0f, 1.0f, k_unknown_height, false), p.least_substeps, p), 8u);
    EXPECT_EQ(substeps_for(needed_substeps(14.0f, 1.0f, k_unknown_height, false), p.least_substeps, p), 8u);
    EXPECT_EQ(substeps_for(needed_substeps(1e30f, 1.0f, k_unknown_height, false), p.least_substeps, p), 128u);
    uint before = 8;
    for (float weights = 0.0f; weights < 200.0f; weights += 0.25f) {
        const uint substeps =
            substeps_for(needed_substeps(weights, 1.0f, k_unknown_height, false), p.least_substeps, p);
        EXPECT_GE(substeps, before) << weights;
        EXPECT_LE(substeps, std::max(8.0f, 1.5f * std::max(std::sqrt(weights), 0.0901f * std::pow(weights, 1.5f))))
            << weights;
        EXPECT_GE(static_cast<float>(substeps), std::min(128.0f, 0.0899f * std::pow(weights, 1.5f))) << weights;
        before = substeps;
    }
    // A low column of heavily loaded contacts: 40 weights on a single one, and on ten.
    EXPECT_EQ(substeps_for(needed_substeps(40.0f, 1.0f, 1, false), p.least_substeps, p), 8u);
    EXPECT_EQ(substeps_for(needed_substeps(40.0f, 1.0f, 10, false), p.least_substeps, p), 12u);
    EXPECT_EQ(substeps_for(needed_substeps(40.0f, 1.0f, 40, false), p.least_substeps, p), 24u);
    EXPECT_EQ(substeps_for(needed_substeps(40.0f, 1.0f, 41, false), p.least_substeps, p), 24u)
        << "it is no higher than its load says";
    EXPECT_EQ(substeps_for(needed_substeps(1000.0f, 1.0f, 1, false), p.least_substeps, p), 32u)
        << "its contact may sink by 4.4 mm";
    EXPECT_EQ(substeps_for(needed_substeps(1000.0f, 1.0f, 1, true), p.least_substeps, p), 16u)
        << "the ground is stiffer";
    Settings few;
    few.substeps = few.max_substeps = 7;
    EXPECT_EQ(substeps_for(needed_substeps(500.0f, 1.0f, k_unknown_height, false), parameters_for(few).least_substeps,
                           parameters_for(few)),
              7u)
        << "a number of the caller's";
}

TEST(Math, the_height_of_a_column_is_told_from_above) {
    EXPECT_EQ(height_of_column(0, 0, 0), 1u) << "nothing stands on it";
    const uint twenty = 20 * k_own_mass;
    EXPECT_EQ(height_of_column(twenty, 11, twenty + k_own_mass), 12u);
    EXPECT_EQ(height_of_column(k_enough_told - 1, 11, k_own_mass), 1u) << "less than three times its own mass";
    EXPECT_EQ(height_of_column(twenty, k_unknown_height, twenty), k_unknown_height);
    EXPECT_EQ(height_of_column(twenty, 40, 5 * twenty + k_own_mass), 21u)
        << "four fifths join from the side: 40 / 2 + 1";
    EXPECT_EQ(height_of_column(twenty, 40, twenty / 2), 41u) << "it stands on two";
    for (uint height = 1; height < 254; ++height) // of a tower
        ASSERT_EQ(height_of_column(max(height, 3u) * k_own_mass, height, (height + 1) * k_own_mass), height + 1);
    // 5.6 weights of the lighter of 1 kg and 2 kg are 2.8 times the heavier one's mass.
    EXPECT_EQ(told_mass(5.6f, 0.5f, 1.0f), 44u);
    EXPECT_EQ(told_mass(2.03f, 1.0f, 0.5f), 32u);
    EXPECT_EQ(told_mass(2.03f, 1.0f, 0.0f), 32u) << "pressed by what cannot be pushed";
    EXPECT_EQ(told_mass(k_most_weights, 1e6f, 1e-6f), k_most_told);
    EXPECT_EQ(substeps_of(make_demand(1000, 2007, 6, 255)), 1000u);
    EXPECT_EQ(idle_steps_of(make_demand(1000, 2007, 6, 255)), 2007u);
    EXPECT_EQ(foot_rate_of(make_demand(1000, 2007, 6, 255)), 6u);
    EXPECT_EQ(height_of(make_demand(1000, 2007, 6, 255)), 255u);
}

TEST(Math, a_storey_stands_plumb_on_a_lower_body) {
    const Parameters p = parameters_for(Settings{});
    const auto standing = [&](vec3 normal, vec3 centre_a, vec3 centre_b) { // from A to B
        return find_standing(normal, centre_a, centre_b, vec3(0.0f, 0.0f, 0.0f), p);
    };
    const vec3 down(0.0f, -0.5f, 0.0f), up(0.0f, 0.5f, 0.0f); // the points' middle from a centre
    EXPECT_TRUE(standing({0.0f, -1.0f, 0.0f}, down, up).is_storey);
    EXPECT_TRUE(standing({0.0f, -1.0f, 0.0f}, down, up).b_below);
    EXPECT_TRUE(standing({0.0f, 1.0f, 0.0f}, up, down).is_storey);
    EXPECT_FALSE(standing({0.0f, 1.0f, 0.0f}, up, down).b_below);
    EXPECT_TRUE(standing({0.59f, -0.81f, 0.0f}, down, up).is_storey) << "36 degrees from the plumb line";
    EXPECT_FALSE(standing({0.62f, -0.78f, 0.0f}, down, up).is_storey) << "39 degrees";
    EXPECT_FALSE(standing({0.0f, -1.0f, 0.0f}, up, down).is_storey) << "what is below has the higher centre";
}

TEST(Math, a_column_counts_storeys_and_without_gravity_its_load) {
    Settings settings;
    const Standing storey{true, true}, leaning{true, false};
    const uint told = 20 * k_own_mass;
    const Parameters p = parameters_for(settings);
    EXPECT_EQ(column_height(storey, 21.0f, 1.0f, 1.0f, told, 11, p), 12u);
    EXPECT_EQ(column_height(leaning, 21.0f, 1.0f, 1.0f, told, 11, p), 1u);
    settings.gravity = {};
    EXPECT_EQ(column_height(leaning, 21.0f, 1.0f, 1.0f, told, 11, parameters_for(settings)), k_unknown_height);
}

TEST(Math, what_asks_for_less_than_its_island_has_does_not_change_it) {
    const auto demand = [](uint substeps, uint height, uint foot_rate = 0) {
        return engine::make_demand(substeps, 0, foot_rate, height);
    };
    EXPECT_TRUE(engine::asks_alike(demand(8, 1), demand(12, 30), 16, false));
    EXPECT_TRUE(engine::asks_alike(demand(16, 1), demand(16, 30), 16, false));
    EXPECT_FALSE(engine::asks_alike(demand(8, 1), demand(16, 1), 16, false))
        << "it may now be the one that asks for most";
    EXPECT_FALSE(engine::asks_alike(demand(16, 1), demand(8, 1), 16, false)) << "it may have been the only one";
    EXPECT_FALSE(engine::asks_alike(demand(8, 1), demand(24, 1), 16, false));
    EXPECT_FALSE(engine::asks_alike(demand(8, 1), demand(12, 1), 16, true)) << "each has its own";
    EXPECT_FALSE(engine::asks_alike(demand(8, 1), demand(8, 1, 2), 16, true)) << "or what the foot below asks for";
    EXPECT_TRUE(engine::asks_alike(demand(8, 1, 2), demand(8, 1), 16, false));
    EXPECT_TRUE(engine::asks_alike(demand(8, 1), demand(8, 2), 16, true));
}

TEST(Math, fewer_substeps_are_the_next_number_in_use) {
    const Parameters p = parameters_for(Settings{});
    for (const auto& [substeps, fewer] : {std::pair{8u, 8u}, {12u, 8u}, {16u, 12u}, {100u, 96u}, {128u, 96u}})
        EXPECT_EQ(fewer_substeps(substeps, p.least_substeps), fewer) << substeps;
    EXPECT_EQ(fewer_substeps(5, p.least_substeps), 5u) << "the caller's most";
}

TEST(Math, what_lasts_of_a_load_falls_with_it_and_rises_slowly_to_three_quarters) {
    EXPECT_EQ(next_lasting_load(1.0f, 20.0f, true), 20.0f) << "on trial";
    EXPECT_EQ(next_lasting_load(20.0f, 5.0f, false), 5.0f);
    EXPECT_EQ(next_lasting_load(16.0f, 20.0f, false), 16.0f) << "within the band";
    float lasting = 0.0f;
    for (int i = 0; i < 60 * 17; ++i)
        lasting = next_lasting_load(lasting, 20.0f, false);
    EXPECT_NEAR(lasting, 15.0f * (1.0f - std::exp(-1.0f)), 0.05f);
    for (int i = 0; i < 10'000; ++i)
        lasting = next_lasting_load(lasting, 20.0f, false);
    EXPECT_NEAR(lasting, 15.0f, 0.01f);
}

TEST(Math, a_contact_is_lifted_by_three_quarters_of_what_it_gives_way) {
    Settings settings;
    const Parameters p = parameters_for(settings);
    const float w = contact_frequency_at(8, false, p), gives_way = 500.0f / (w * w * 2.0f);
    EXPECT_NEAR(lift_of(500.0f, 2.0f, 8, false, p), 0.75f * gives_way, 1e-8f);
    EXPECT_NEAR(lift_of(500.0f, 2.0f, 8, true, p), 0.75f * gives_way / 4.0f, 1e-8f) << "of twice the frequency";
    EXPECT_EQ(lift_of(1e9f, 2.0f, 8, false, p), k_most_lift);
    EXPECT_EQ(lift_of(500.0f, 0.0f, 8, false, p), 0.0f) << "it has no points";
    EXPECT_EQ(lift_of(NAN, 2.0f, 8, false, p), 0.0f);
    settings.stabilisation = Stabilisation::Baumgarte;
    EXPECT_EQ(lift_of(500.0f, 2.0f, 8, false, parameters_for(settings)), 0.0f) << "its rows are rigid";
}

/// One point, or many on a lever, that press with this force and torque limit.
FrictionTarget friction_of(vec3 mass, float force, float torque) {
    ManifoldRows rows{};
    rows.friction_mass = mass;
    rows.friction = 1.0f;
    rows.lever = vec4(force > 0.0f ? torque / force : 0.0f, 0.0f, 0.0f, 0.0f);
    return make_friction_target(rows, vec4(force, 0.0f, 0.0f, 0.0f));
}

TEST(Math, friction_stays_in_a_round_cone) {
    Samples samples;
    for (int i = 0; i < 1'000; ++i) {
        const float limit = samples.number(0.0f, 4.0f);
        const float impulse_1 = samples.number(-5.0f, 5.0f), impulse_2 = samples.number(-5.0f, 5.0f);
        const float v1 = samples.number(-5.0f, 5.0f), v2 = samples.number(-5.0f, 5.0f);
        const vec3 rows = solve_friction_rows(vec3(impulse_1, impulse_2, 0.0f), vec3(2.0f), vec3(v1, v2, 9.0f),
                                              friction_of(vec3(2.0f), limit, 0.0f));
        ASSERT_EQ(rows.z, 0.0f) << "a single point does not hold a twist";
        const vec2 held(rows.x, rows.y);
        const vec2 free(impulse_1 - 2.0f * v1, impulse_2 - 2.0f * v2);
        ASSERT_LE(glm::length(held), limit * 1.00001f);
        ASSERT_NEAR(glm::length(held), std::min(limit, glm::length(free)), 1e-5f * (1.0f + limit));
        ASSERT_NEAR(held.x * free.y, held.y * free.x, 1e-4f) << "held in the direction it had";
    }
}

TEST(Math, friction_points_against_the_sliding) {
    // However different the masses along the two tangents are, as they are at a box's corners.
    Samples samples;
    for (int i = 0; i < 1'000; ++i) {
        const float mass_1 = samples.number(0.5f, 4.0f), mass_2 = samples.number(0.5f, 4.0f);
        const float angle = samples.number(-3.14f, 3.14f);
        const vec2 sliding(std::cos(angle), std::sin(angle));
        vec3 impulse(0.0f);
        for (int pass = 0; pass < 50; ++pass)
            impulse = solve_friction_rows(impulse, vec3(mass_1, mass_2, 1.0f), vec3(sliding, 0.0f),
                                          friction_of(vec3(mass_1, mass_2, 1.0f), 0.3f, 0.2f));
        ASSERT_NEAR(glm::dot(vec2(impulse.x, impulse.y), sliding), -0.3f, 1e-5f);
    }
}

TEST(Math, materials_combine_by_the_rule_that_is_listed_first) {
    EXPECT_EQ(combine(0.2f, 0.6f, k_combine_average, k_combine_multiply), 0.4f);
    EXPECT_EQ(combine(0.2f, 0.6f, k_combine_maximum, k_combine_minimum), 0.2f);
    EXPECT_EQ(combine(0.2f, 0.6f, k_combine_multiply, k_combine_maximum), 0.6f);
    EXPECT_FLOAT_EQ(combine(0.2f, 0.6f, k_combine_multiply, k_combine_multiply), 0.12f);
}

// ---- integers ----

TEST(Math, ranks_differ_at_a_body) {
    for (const uint body : {0u, 1u, 77u, 1'000'000u}) {
        std::unordered_set<uint> ranks;
        for (uint other = 0; other < 200'000; ++other) {
            if (other == body) continue;
            const bool both_movable = other % 3 != 0;
            const uint rank = edge_rank(body, other, both_movable);
            ASSERT_NE(rank, 0u);
            ASSERT_EQ(rank, edge_rank(other, body, both_movable));
            ASSERT_TRUE(ranks.insert(rank).second) << body << ", " << other;
        }
    }
}

RC_GTEST_PROP(Math, ranks_of_any_two_edges_at_a_body_differ, (uint body, uint b, uint c, bool with_b, bool with_c)) {
    constexpr uint k_slots = 1u << 30; // more than any device has memory for
    body %= k_slots, b %= k_slots, c %= k_slots;
    RC_PRE(body != b && body != c && b != c);
    RC_ASSERT(edge_rank(body, b, with_b) != edge_rank(body, c, with_c));
    if (with_b && !with_c) RC_ASSERT(edge_rank(body, b, with_b) < edge_rank(body, c, with_c));
}

RC_GTEST_PROP(Math, the_first_free_colour_is_free_and_the_last, (uint low, uint high, uint usable, bool both_movable)) {
    usable %= k_first_hub_colour + 1;
    std::uint64_t used = std::uint64_t{high} << 32 | low;
    const uint colour = first_free_colour(low, high, usable, both_movable), least = k_first_hub_colour - usable;
    const bool two_more = (used >> (k_ground_colour - 2) & 3) == 3;
    if (both_movable && !two_more) used |= std::uint64_t{1} << k_ground_colour;
    if (colour != k_overflow_colour) {
        RC_ASSERT(colour >= least && colour <= k_ground_colour);
        RC_ASSERT((used >> colour & 1) == 0);
    }
    for (uint other = colour != k_overflow_colour ? colour + 1 : least; other <= k_ground_colour; ++other)
        RC_ASSERT((used >> other & 1) == 1);
}

TEST(Math, when_all_colours_are_used_there_is_the_overflow_set) {
    EXPECT_EQ(first_free_colour(UINT32_MAX, UINT32_MAX, k_first_hub_colour, false), k_overflow_colour);
    EXPECT_EQ(first_free_colour(UINT32_MAX - 1, UINT32_MAX, k_first_hub_colour, false), 0u);
    EXPECT_EQ(first_free_colour(0, 0, 0, false), k_overflow_colour);
    EXPECT_EQ(first_free_colour(0, 0, 1, true), k_overflow_colour) << "the first is not for two that can be pushed";
}

RC_GTEST_PROP(Math, a_stamp_tells_the_number_that_it_was_made_from, (uint x, uint y, uint z, uint number)) {
    const uint stamp = engine::stamp_of(x, y, z, number);
    const uint of_frozen = stamp | engine::k_stamp_of_frozen;
    RC_ASSERT(engine::is_stamp(stamp, stamp));
    RC_ASSERT(engine::is_stamp(of_frozen, stamp));
    for (uint apart = 1; apart < 1000; ++apart)
        for (const uint other :
             {number + apart, number - apart, number + apart * apart * 97, number - apart * apart * 97})
            RC_ASSERT_FALSE(engine::is_stamp(of_frozen, engine::stamp_of(x, y, z, other)));
}

RC_GTEST_PROP(Math, an_inverse_mass_is_no_stamp, (uint x, uint y, uint z, uint number, float mass)) {
    RC_ASSERT_FALSE(engine::is_stamp(glm::floatBitsToUint(std::abs(mass)), engine::stamp_of(x, y, z, number)));
}

TEST(Math, launches_cover_their_items_within_the_limits_of_a_dimension) {
    for (const uint group_size : {1u, 64u, 1024u}) {
        for (const uint items :
             {0u, 1u, 63u, 64u, 65u, 65'535u, 65'536u, 65'535u * 64u, 65'535u * 64u + 1u, 50'000'000u}) {
            const Dispatch d = groups_for(items, group_size);
            const std::uint64_t groups = std::uint64_t{d.groups_x} * d.groups_y * d.groups_z;
            SCOPED_TRACE(testing::Message() << items << " in groups of " << group_size);
            EXPECT_EQ(d.items, items);
            EXPECT_LE(d.groups_x, 65'535u);
            EXPECT_LE(d.groups_y, 65'535u);
            EXPECT_GE(groups * group_size, items);
            EXPECT_EQ(groups == 0, items == 0);
            // No more than a row of groups is idle.
            EXPECT_LT(groups * group_size, items + std::uint64_t{d.groups_x} * group_size + 1);
        }
    }
}

RC_GTEST_PROP(Math, sweep_keys_sort_as_floats_do, (float a, float b)) {
    RC_PRE(std::isfinite(a) && std::isfinite(b));
    const SweepAxis sweep{0, 1e30f, 0, 0};
    const auto key = [&](float lower) {
        Aabb box{};
        box.lower = vec3(lower, 0.0f, 0.0f);
        box.upper = vec3(lower, 0.0f, 0.0f);
        return sweep_key(box, sweep);
    };
    if (a < b) RC_ASSERT(key(a) < key(b));
    RC_ASSERT(key(a) < k_large_key);
}

} // namespace
} // namespace talus::engine
