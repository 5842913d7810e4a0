// SPDX-License-Identifier: MIT
// The CPU device's passes over several items side by side give the bits of the passes over one item at a time, for each
// set of instructions that this machine has.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broad_phase/box_now.h"
#include "broad_phase/lane_search.h"
#include "device/cpu/flush_denormals.h"
#include "device/cpu/instruction_set.h"
#include "finish/lane_moves.h"
#include "narrow_phase/lane_queries.h"
#include "resolution/body_passes.h"
#include "resolution/lane_passes.h"

namespace talus::engine {

TALUS_DECLARE_OF_SETS(LanePasses, lane_passes);
TALUS_DECLARE_OF_SETS(LaneQueries, lane_queries);
TALUS_DECLARE_OF_SETS(LaneSearch, lane_search);

namespace {

/// Those that this machine can run.
template <typename T, std::size_t count> std::vector<const T*> runnable(const std::array<const T*, count>& of_sets) {
    return {of_sets.begin(), of_sets.begin() + runnable_sets()};
}
#define TALUS_RUNNABLE(name) runnable(TALUS_OF_SETS(name))

/// Constraints each of two bodies of their own, or of one and a body that many share: a static one, or a hub.
struct Items {
    static constexpr uint k_count = 40, k_static_body = 2 * k_count, k_hub = k_static_body + 1, k_bodies = k_hub + 1;

    explicit Items(std::uint32_t seed, float restitution) : random(seed) {
        for (uint i = 0; i < k_bodies; ++i)
            add_body(i);
        for (uint i = 0; i < k_bodies; ++i) { // behind the warm starts of all
            BodyHits hits = no_hits(no_warm_start());
            hits.shift = vector(i % 8 == 0 ? 0.01f : 0.0f);
            warm_starts.push_back(std::bit_cast<BodyWarmStart>(hits));
        }
        warm_starts.resize(contact_hits_place(k_count, k_bodies), no_warm_start()); // none of the contacts has been hit
        for (uint i = 0; i < k_count; ++i)
            add_constraint(i, restitution);
        counters.resize(k_counter_words);
        hub_changes.resize(k_count, no_change(k_none));
        colour_offsets.resize(k_overflow_colour + 2, 0);
    }

    CpuState state() {
        CpuState s;
        s.parameters.gravity = vec3(0.0f, -9.81f, 0.0f);
        s.parameters.body_count = k_bodies;
        s.parameters.dt = 1.0f / 60.0f;
        s.parameters.inv_dt = 60.0f;
        s.parameters.inverse_weight = 60.0f / 9.81f;
        s.parameters.contact_push_speed = 3.0f;
        s.parameters.contact_frequency = 6283.0f;
        s.parameters.contact_damping_ratio = 5.0f;
        s.parameters.restitution_threshold = 1.0f;
        s.parameters.max_linear_speed = 500.0f;
        s.parameters.max_angular_speed = 4.0f; // some are faster
        s.parameters.body_count = k_bodies;
        s.poses = {poses.data(), poses.size()};
        s.velocities = {velocities.data(), velocities.size()};
        s.shapes = {shapes.data(), shapes.size()};
        s.properties = {properties.data(), properties.size()};
        s.loads = {loads.data(), loads.size()};
        s.inertias = {inertias.data(), inertias.size()};
        s.warm_starts = {warm_starts.data(), warm_starts.size()};
        s.some_bounce = some_bounce;
        s.deltas = {deltas.data(), deltas.size()};
        s.constraints = {constraints.data(), constraints.size()};
        s.counters = {counters.data(), counters.size()};
        s.hub_changes = {hub_changes.data(), hub_changes.size()};
        s.colour_offsets = {colour_offsets.data(), colour_offsets.size()};
        return s;
    }

    float number(float size) { return std::uniform_real_distribution<float>(-size, size)(random); }
    vec3 vector(float size) { return {number(size), number(size), number(size)}; }
    vec4 vector4(float size) { return {number(size), number(size), number(size), number(size)}; }

    void add_body(uint i) {
        const bool is_static = i == k_static_body;
        const float inverse_mass = is_static ? 0.0f : 1.0f + number(0.5f);
        const vec4 rotation = normalise_quaternion(vec4(number(1.0f), number(1.0f), number(1.0f), 1.0f));
        poses.push_back({vector(5.0f), i % 17 == 16 ? k_body_frozen : 0u, rotation});
        velocities.push_back({vector(8.0f), inverse_mass, vector(5.0f), 0});
        const uint kind = is_static ? k_kind_static : i % 9 == 8 ? k_kind_kinematic : k_kind_rigid;
        shapes.push_back({vec3(0.5f), k_shape_box | kind << 8 | (i % 10 == 4 ? k_sensor_bit : 0u)});
        const vec3 inverse_inertia = i % 3 == 0 ? vec3(6.0f) : vec3(6.0f, 5.0f + number(1.0f), 4.0f);
        properties.push_back(
            {inverse_inertia, inverse_mass, 1.0f, i % 4 == 0 ? 0.1f : 0.0f, 0.0f, 0.5f, 0.0f, 0, 0, 0});
        loads.push_back({vector(i % 5 == 0 ? 100.0f : 0.0f), 0, vector(i % 5 == 0 ? 10.0f : 0.0f), 0.0f});
        const uint moved = is_static ? 0 : kind == k_kind_kinematic ? k_trait_moves : k_trait_moves | k_trait_movable;
        const uint traits = moved | (i % 5 == 0 ? k_trait_loaded : 0u);
        inertias.push_back(world_inertia(rotation, inverse_inertia, traits, i % 7 == 6 ? 2 : 8));
        velocities.back().angular = i == 3 ? vec3(1e30f) : velocities.back().angular; // ends non-finite
        warm_starts.push_back(kept_warm_start(no_warm_start(), velocities.back()));
        warm_starts.back().linear += vector(0.1f);
        deltas.push_back(
            {vector(0.01f), 0.0f, normalise_quaternion(vec4(number(0.01f), number(0.01f), number(0.01f), 1.0f))});
    }

    void add_constraint(uint i, float restitution) {
        ContactConstraint c{};
        const bool a_is_hub = i % 5 == 2, b_is_static = i % 4 == 3, b_is_hub = i % 8 == 5 && !a_is_hub;
        c.body_a = a_is_hub ? k_hub : 2 * i;
        c.body_b = b_is_static ? k_static_body : b_is_hub ? k_hub : 2 * i + 1;
        c.counts = (1 + i % 4) | (i % 7 == 6 ? 2u : 8u) << k_contact_substeps;
        const vec3 n = vector(1.0f);
        c.normal = scale3(n, inverse_sqrt(dot3(n, n)));
        c.friction = 0.5f;
        c.restitution = restitution;
        c.centre_a = vector(0.5f);
        c.centre_b = vector(0.5f);
        c.inverse_mass_a = velocities[c.body_a].inverse_mass;
        c.inverse_mass_b = velocities[c.body_b].inverse_mass;
        c.gap = vector(0.001f);
        c.traits = k_trait_movable | (b_is_static ? 0u : k_trait_movable << k_traits_of_b) |
                   (i % 6 == 5 ? k_trait_round : 0u) | (a_is_hub ? k_trait_hub : 0u) |
                   (b_is_hub ? k_trait_hub << k_traits_of_b : 0u);
        c.hub_share = 0.1f + 0.05f * static_cast<float>(i % 3);
        c.friction_mass = vec3(0.4f, 0.4f, 0.1f);
        for (int k = 0; k < static_cast<int>(point_count_of(c.counts)); ++k) {
            c.x[k] = number(0.5f);
            c.y[k] = number(0.5f);
            c.lever[k] = 0.5f;
            c.base_separation[k] = number(0.02f);
            c.normal_mass[k] = 0.3f + number(0.1f);
            c.normal_impulse[k] = i % 5 == 0 ? 0.0f : 1.0f + number(1.0f);
            c.total_impulse[k] = c.normal_impulse[k] * 3.0f;
        }
        c.friction_impulse = vector(0.3f);
        c.slip = vector(0.01f);
        constraints.push_back(c);
    }

    std::mt19937 random;
    std::vector<BodyPose> poses;
    std::vector<BodyVelocity> velocities;
    std::vector<BodyShape> shapes;
    std::vector<BodyProperties> properties;
    std::vector<BodyLoad> loads;
    std::vector<BodyInertia> inertias;
    std::vector<BodyWarmStart> warm_starts;
    bool some_bounce = true;
    std::vector<BodyDelta> deltas;
    std::vector<ContactConstraint> constraints;
    std::vector<uint> counters;
    std::vector<HubChange> hub_changes;
    std::vector<uint> colour_offsets;
};

struct alignas(64) Line {
    std::byte bytes[64];
};

template <typename T> void expect_same(const std::vector<T>& one, const std::vector<T>& lanes, const char* what) {
    for (std::size_t i = 0; i < one.size(); ++i)
        EXPECT_EQ(std::memcmp(&one[i], &lanes[i], sizeof(T)), 0) << what << ' ' << i;
}

void expect_same(const Items& one, const Items& lanes) {
    expect_same(one.velocities, lanes.velocities, "velocity");
    expect_same(one.deltas, lanes.deltas, "movement");
    expect_same(one.warm_starts, lanes.warm_starts, "warm start");
    expect_same(one.constraints, lanes.constraints, "constraint");
    expect_same(one.poses, lanes.poses, "pose");
    expect_same(one.counters, lanes.counters, "counter");
    expect_same(one.hub_changes, lanes.hub_changes, "change of a hub");
}

std::vector<uint> first_items(uint count) {
    std::vector<uint> indices;
    for (uint i = 0; i < count; ++i)
        indices.push_back(count - 1 - i); // any order will do
    return indices;
}

/// Treats the items in parts, and returns how many were left to `one`.
template <typename Pass, typename One>
uint treat(const LanePasses& passes, const std::vector<uint>& indices, const Pass& pass, const One& one) {
    uint left = 0;
    for (uint first = 0; first < indices.size(); first += passes.lanes) {
        const uint count = min(passes.lanes, static_cast<uint>(indices.size()) - first);
        for (uint bits = pass(&indices[first], count); bits != 0; bits &= bits - 1, ++left)
            one(indices[first + static_cast<uint>(findLSB(bits))]);
    }
    return left;
}

struct PassOfSubstep {
    ContactPass pass;
    uint substep;
};

/// Those of a step of eight sub-steps with two iterations.
std::vector<PassOfSubstep> passes_of_step(bool relax) {
    std::vector<PassOfSubstep> passes;
    for_each_pass(
        8, 2, relax, [](uint) {},
        [&](ContactPass pass, uint substep) {
            passes.push_back({pass, substep});
        });
    return passes;
}

/// Some constraints in batches, as ConstraintBatches has them for the lanes of this machine.
class SomeBatches {
public:
    SomeBatches(const LanePasses& passes, const CpuState& state, std::vector<uint> indices)
        : passes_(passes), indices_(std::move(indices)), lines_(passes.constraint_batch_bytes / sizeof(Line) + 1),
          memory_(lines_ * (indices_.size() / passes.lanes + 1)) {
        treat(
            passes_, indices_,
            [&](const uint* part, uint size) {
                passes_.take_constraints(state, part, size, batch_of(part));
                return 0u;
            },
            [](uint) {});
    }
    /// How many were treated one at a time.
    uint pass_over(CpuState& state, PassOfSubstep each) {
        return treat(
            passes_, indices_,
            [&](const uint* part, uint) {
                return passes_.pass_over_constraints(state, each.pass, each.substep, batch_of(part));
            },
            [&](uint i) { pass_over_constraint(state, each.pass, each.substep, i); });
    }

private:
    void* batch_of(const uint* part) {
        return &memory_[static_cast<std::size_t>(part - indices_.data()) / passes_.lanes * lines_];
    }

    const LanePasses& passes_;
    std::vector<uint> indices_;
    std::size_t lines_; // a batch
    std::vector<Line> memory_;
};

TEST(Lanes, pass_over_contacts_with_the_bits_of_one_at_a_time) {
    const FlushDenormals flush;
    for (const LanePasses* passes : TALUS_RUNNABLE(lane_passes)) {
        for (const bool relax : {true, false}) {
            for (const uint count : {1u, 3u, 4u, 5u, 8u, 9u, Items::k_count}) {
                for (const float restitution : {0.0f, 0.5f}) {
                    Items one(count, restitution), lanes(count, restitution);
                    CpuState one_state = one.state(), lanes_state = lanes.state();
                    const std::vector<uint> indices = first_items(count);
                    SomeBatches batches(*passes, lanes_state, indices);
                    uint left = 0;
                    for (const PassOfSubstep each : passes_of_step(relax)) {
                        SCOPED_TRACE(std::to_string(passes->lanes) + " lanes, pass " +
                                     std::to_string(static_cast<uint>(each.pass)) + " of sub-step " +
                                     std::to_string(each.substep) + ", " + std::to_string(count));
                        for (const uint i : indices)
                            pass_over_constraint(one_state, each.pass, each.substep, i);
                        left += batches.pass_over(lanes_state, each);
                        expect_same(one.velocities, lanes.velocities, "velocity");
                        expect_same(one.hub_changes, lanes.hub_changes, "change of a hub");
                    }
                    expect_same(one, lanes); // the impulses, too
                    const uint most = static_cast<uint>(passes_of_step(relax).size());
                    EXPECT_LE(left, restitution > 0.0f ? count * most : most) << "hits, and one that is not finite";
                    if (restitution > 0.0f && count == Items::k_count) {
                        EXPECT_GT(left, 3u);
                    }
                }
            }
        }
    }
}

TEST(Lanes, integrate_bodies_with_the_bits_of_one_at_a_time) {
    const FlushDenormals flush;
    for (const LanePasses* passes : TALUS_RUNNABLE(lane_passes)) {
        for (const uint substep : {0u, 1u, 2u, 3u, 8u, 9u}) {
            for (const uint count : {1u, 7u, 8u, Items::k_bodies}) {
                SCOPED_TRACE(std::to_string(passes->lanes) + " lanes, sub-step " + std::to_string(substep));
                Items one(count, 0.0f), lanes(count, 0.0f);
                constexpr uint k_without_a_speed = 5;
                for (Items* items : {&one, &lanes})
                    items->velocities[k_without_a_speed].angular.x = std::numeric_limits<float>::quiet_NaN();
                one.some_bounce = lanes.some_bounce = substep % 2 == 0;
                CpuState one_state = one.state(), lanes_state = lanes.state();
                const std::vector<uint> indices = first_items(count);
                for (const uint i : indices)
                    integrate_body(one_state, i, substep);
                std::vector<Line> batch(passes->body_batch_bytes / sizeof(Line) + 1);
                treat(
                    *passes, indices,
                    [&](const uint* part, uint size) {
                        passes->take_bodies(lanes_state, part, size, batch.data());
                        return passes->integrate_bodies(lanes_state, substep, batch.data());
                    },
                    [&](uint i) { integrate_body(lanes_state, i, substep); });
                expect_same(one, lanes);
            }
        }
    }
}

/// What prepare_contacts.comp.glsl tells the body below, by the same formulas.
void tell_load_of(const CpuState& state, const ContactToPrepare& contact, const ContactConstraint& c,
                  std::vector<uint>& told) {
    const Manifold& manifold = state.manifolds[contact.manifold];
    const Standing standing = find_standing(c.normal, c.centre_a, c.centre_b, c.gap, state.parameters);
    const ToldFoot foot = told_foot(manifold, standing);
    uint& foot_told = told[told_foot_word(foot.body, state.parameters.body_count)];
    foot_told = max(foot_told, foot.rate);
    const LoadBelow load = load_below(manifold, standing, state.velocities[manifold.body_a].inverse_mass,
                                      state.velocities[manifold.body_b].inverse_mass);
    if (load.mass == 0) return;
    told[k_told_words * load.body + k_told_mass] += load.mass;
    uint& height = told[k_told_words * load.body + k_told_height];
    height = max(height, height_of(manifold.demand));
}

/// What prepare_contacts.comp.glsl makes of a manifold, by the same formulas.
ContactConstraint prepared(const CpuState& state, const ContactToPrepare& contact) {
    const Manifold& manifold = state.manifolds[contact.manifold];
    const BodyInertia &inertia_a = state.inertias[manifold.body_a], &inertia_b = state.inertias[manifold.body_b];
    const float inverse_mass_a = state.velocities[manifold.body_a].inverse_mass;
    const float inverse_mass_b = state.velocities[manifold.body_b].inverse_mass;
    ContactConstraint c = begin_constraint(manifold, contact.manifold, contact.colour, contact.order, contact.hub_share,
                                           inverse_mass_a, inverse_mass_b, inertia_a, inertia_b, state.parameters);
    const ManifoldPoint* const points = &state.manifold_points[std::size_t{4} * contact.manifold];
    const vec3 &position_a = state.poses[manifold.body_a].position, &position_b = state.poses[manifold.body_b].position;
    const Separations& separations = state.point_separations[contact.manifold];
    for (uint i = 0; i < manifold.point_count; ++i)
        c = add_to_centre(c, points[i].anchor, offset_at_meeting(position_a, position_b, separations.shift));
    c = end_centre(c, position_a, position_b);
    const vec4& impulses = state.point_impulses[contact.manifold].normal;
    const Meeting meeting = make_meeting(c, inertia_a, inertia_b);
    c.friction_mass = friction_masses(meeting);
    for (uint i = 0; i < manifold.point_count; ++i)
        c = add_point(c, static_cast<int>(i), points[i].anchor, separations.separation[static_cast<int>(i)],
                      impulses[static_cast<int>(i)], meeting, respond_to_normals(meeting));
    const float force = force_of(manifold.lasting_weights, inverse_mass_a, inverse_mass_b, state.parameters);
    c.base_separation = lifted_separation(c.base_separation, c.normal_mass, force, substeps_of_contact(c.counts),
                                          c.traits, state.parameters);
    return c;
}

TEST(Lanes, prepare_contacts_with_the_bits_of_one_at_a_time) {
    const FlushDenormals flush;
    Items items(1, 0.0f);
    items.inertias[Items::k_hub].traits |= k_trait_hub;
    std::vector<Manifold> manifolds;
    std::vector<ManifoldPoint> points;
    std::vector<Separations> separations;
    std::vector<NormalImpulses> impulses;
    std::vector<ContactToPrepare> contacts;
    for (uint i = 0; i < Items::k_count; ++i) {
        const ContactConstraint& c = items.constraints[i];
        const vec3 friction = items.vector(0.3f);
        const uint point_count = point_count_of(c.counts);
        manifolds.push_back({c.body_a, c.body_b, point_count, 0, c.normal, 0, 0.5f, 0.0f, friction.x, friction.y,
                             friction.z, 1.0f + items.number(0.9f), 1.0f + items.number(0.9f),
                             make_demand(8, 0, i % 7, 1 + i % 5)});
        for (uint k = 0; k < 4; ++k) // those that are not there may be anything
            points.push_back({k < point_count ? items.vector(0.5f) : vec3(NAN), k});
        separations.push_back({items.vector4(0.02f), items.vector(0.1f), 0.0f});
        impulses.push_back({items.vector4(1.0f) + 1.0f});
        const bool of_hub = c.body_a == Items::k_hub || c.body_b == Items::k_hub;
        const uint order = i % 3 << k_earlier_of_a | i % 5 << k_earlier_of_b | i % 2 << k_last_of_b;
        contacts.push_back({i, i, of_hub && i % 2 == 0 ? k_first_hub_colour : i % 3, order, of_hub ? 0.125f : 1.0f});
    }
    std::vector<ContactConstraint> wanted;
    std::vector<uint> wanted_loads((k_told_words + 1) * Items::k_bodies, 0);
    for (const LanePasses* passes : TALUS_RUNNABLE(lane_passes)) {
        SCOPED_TRACE(std::to_string(passes->lanes) + " lanes");
        std::vector<ContactConstraint> made(Items::k_count);
        std::vector<uint> told((k_told_words + 1) * Items::k_bodies, 0);
        CpuState state = items.state();
        state.manifolds = {manifolds.data(), manifolds.size()};
        state.manifold_points = {points.data(), points.size()};
        state.point_separations = {separations.data(), separations.size()};
        state.point_impulses = {impulses.data(), impulses.size()};
        state.constraints = {made.data(), made.size()};
        state.told_loads = {told.data(), told.size()};
        for (uint first = 0; first < Items::k_count;) { // parts of every size
            const uint count = min(1 + first % passes->lanes, Items::k_count - first);
            passes->prepare_contacts(state, &contacts[first], count);
            first += count;
        }
        if (wanted.empty()) {
            for (const ContactToPrepare& contact : contacts) {
                wanted.push_back(prepared(state, contact));
                tell_load_of(state, contact, wanted.back(), wanted_loads);
            }
        }
        expect_same(wanted, made, "constraint");
        EXPECT_EQ(told, wanted_loads);
        EXPECT_GT(*std::ranges::max_element(told), 0u);
    }
}

TEST(Lanes, update_boxes_and_find_strays_as_one_at_a_time) {
    const FlushDenormals flush;
    Items items(7, 0.0f);
    for (uint i = 0; i < Items::k_bodies; ++i) {
        const uint kind = i % 9 == 8 ? k_kind_absent : i % 3 == 0 ? k_kind_static : k_kind_rigid;
        items.shapes[i] = {vec3(0.3f) + items.vector(0.2f), (i % 5 == 4 ? k_shape_sphere : k_shape_box) | kind << 8};
    }
    for (const LaneSearch* search : TALUS_RUNNABLE(lane_search)) {
        SCOPED_TRACE(std::to_string(search->lanes) + " lanes");
        std::vector<OrientedBox> boxes(Items::k_bodies + 1);
        std::vector<Aabb> aabbs(Items::k_bodies + 1);
        CpuState state = items.state();
        state.oriented_boxes = {boxes.data(), boxes.size()};
        state.aabbs = {aabbs.data(), aabbs.size()};
        const auto for_parts = [&](const auto& part) { // of every size
            for (uint first = 0, count = 1; first < Items::k_bodies; first += count, count = 1 + first % search->lanes)
                part(first, min(count, Items::k_bodies - first));
        };
        for_parts([&](uint first, uint count) {
            search->update_boxes(state, first, count);
            EXPECT_EQ(boxes[first + count].type, 0u) << "a body that was not asked for";
        });
        for (uint i = 0; i < Items::k_bodies; ++i) {
            const OrientedBox box = box_with_skin(state, i);
            const Aabb aabb = compute_aabb(box);
            EXPECT_EQ(std::memcmp(&box, &boxes[i], sizeof box), 0) << i;
            EXPECT_EQ(std::memcmp(&aabb, &aabbs[i], sizeof aabb), 0) << i;
        }

        const std::vector<BodyPose> before = items.poses;
        for (uint i = 0; i < Items::k_bodies; ++i) {
            items.poses[i].position += items.vector(i % 2 == 0 ? 0.002f : 0.0f);
            if (i % 4 == 1) items.poses[i].rotation = normalise_quaternion(items.poses[i].rotation + vec4(0.01f));
            if (i % 7 == 0) items.shapes[i].half_extents.y += 1.0e-3f;
        }
        state = items.state();
        state.oriented_boxes = {boxes.data(), boxes.size()};
        uint strays = 0;
        for_parts([&](uint first, uint count) {
            const uint found = search->find_strays(state, first, count);
            EXPECT_LT(found, 1u << count);
            for (uint i = 0; i < count; ++i) {
                const bool strayed = !is_within(box_now(state, first + i), boxes[first + i]);
                EXPECT_EQ((found >> i & 1u) != 0, strayed) << first + i;
                strays += strayed ? 1 : 0;
            }
        });
        EXPECT_GT(strays, 10u);
        EXPECT_LT(strays, Items::k_bodies - 10);
        items.poses = before;
    }
}

TEST(Lanes, find_partners_as_one_at_a_time) {
    std::mt19937 random(5);
    const auto number = [&](float size) { return std::uniform_real_distribution<float>(-size, size)(random); };
    constexpr uint k_boxes = 77;
    std::vector<Aabb> boxes(k_boxes);
    for (uint i = 0; i < k_boxes; ++i) {
        const vec3 centre{number(3.0f), number(3.0f), number(3.0f)}, half{1.0f + number(0.9f)};
        boxes[i] = {centre - half, 0.01f, centre + half, i % 3 == 0 ? 0u : 1u};
        if (i % 10 == 9) boxes[i] = {vec3(3.0e38f), 0.0f, vec3(-3.0e38f), 0u}; // an empty slot
        if (i % 10 == 8) boxes[i].lower.x = boxes[i - 1].upper.x;              // these touch
    }
    for (const LaneSearch* sweep : TALUS_RUNNABLE(lane_search)) {
        SCOPED_TRACE(std::to_string(sweep->lanes) + " lanes");
        const std::size_t lines = sweep->batch_bytes / sizeof(Line);
        std::vector<Line> batches(lines * (k_boxes / sweep->lanes + 1));
        for (uint first = 0; first < k_boxes; first += sweep->lanes)
            sweep->take_boxes(&boxes[first], min(sweep->lanes, k_boxes - first),
                              &batches[lines * (first / sweep->lanes)]);
        for (uint i = 0; i < k_boxes; ++i) {
            for (const uint end : {i, min(i + 3, k_boxes), k_boxes}) {
                std::vector<uint> wanted, found(k_boxes);
                for (uint k = i; k < end; ++k)
                    if (is_candidate(boxes[i], boxes[k])) wanted.push_back(k);
                found.resize(sweep->find_partners(boxes[i], batches.data(), i, end, found.data()));
                EXPECT_EQ(found, wanted) << i;
            }
        }
    }
}

/// Boxes at random, some of them turned, some far larger than others, a third unmovable, and the tree over them in the
/// order in which they are; those from `end` on are empty.
struct TreeOfBoxes {
    TreeOfBoxes(uint count, uint end_of_bodies) : top(tree_top(count)), end(end_of_bodies) {
        std::mt19937 random(count);
        const auto number = [&](float size) { return std::uniform_real_distribution<float>(-size, size)(random); };
        for (uint i = 0; i < count; ++i) {
            const float size = i % 9 == 4 ? 2.0f : 0.5f;
            OrientedBox box{};
            box.centre = {number(4.0f), number(4.0f), number(4.0f)};
            box.rotation = i % 2 == 0 ? vec4(0.0f, 0.0f, 0.0f, 1.0f) : vec4(0.5f, -0.5f, 0.1f, 0.7f);
            box.half_extents = vec3(size) + vec3(number(0.2f), number(0.2f), number(0.2f));
            box.margin = 0.02f;
            box.type = (i % 3 == 0 ? k_kind_static : k_kind_rigid) << 8;
            boxes.push_back(box);
            bodies.push_back(count - 1 - i); // another order
        }
        nodes.resize(tree_node(count - 1, 0, top) + 1, empty_box());
        for (uint place = 0; place < end; ++place)
            nodes[tree_node(place, 0, top)] = compute_aabb(boxes[bodies[place]]);
        for (uint shift = k_tree_bits; shift <= top; shift += k_tree_bits)
            for (uint place = 0; place < end; ++place) {
                Aabb& node = nodes[tree_node(place, shift, top)];
                node = unite_boxes(node, nodes[tree_node(place, 0, top)]);
            }
    }

    std::vector<uint> partners_of(uint own) const {
        std::vector<uint> partners;
        for (uint place = own + 1; place < end; ++place)
            if (is_candidate(nodes[tree_node(own, 0, top)], nodes[tree_node(place, 0, top)]) &&
                !faces_part(boxes[bodies[own]], boxes[bodies[place]]))
                partners.push_back(place);
        return partners;
    }

    TreeView view() const { return {nodes.data(), boxes.data(), bodies.data(), top, end}; }

    uint top, end;
    std::vector<OrientedBox> boxes;
    std::vector<uint> bodies;
    std::vector<Aabb> nodes;
};

TEST(Lanes, search_a_tree_as_one_at_a_time) {
    for (const auto& [count, end] : std::vector<std::pair<uint, uint>>{
             {1, 1}, {2, 2}, {7, 7}, {8, 8}, {9, 8}, {64, 61}, {257, 256}, {300, 300}, {1025, 1025}}) {
        const TreeOfBoxes tree(count, end);
        for (const LaneSearch* search : TALUS_RUNNABLE(lane_search)) {
            SCOPED_TRACE(std::to_string(search->lanes) + " lanes, " + std::to_string(count) + " bodies");
            std::size_t sum = 0;
            for (uint first = 0; first < count; ++first) {
                const uint lanes = min(search->lanes, count - first);
                std::vector<std::vector<uint>> found(lanes);
                const TakePartner take = [](void* lists, uint place, uint bits) {
                    for (auto& list : *static_cast<std::vector<std::vector<uint>>*>(lists)) {
                        if ((bits & 1u) != 0) list.push_back(place);
                        bits >>= 1;
                    }
                    EXPECT_EQ(bits, 0u) << "a lane without a body";
                };
                search->search_tree(tree.view(), first, lanes, take, &found);
                for (uint lane = 0; lane < lanes; ++lane) {
                    EXPECT_EQ(found[lane], tree.partners_of(first + lane)) << first << " + " << lane;
                    sum += found[lane].size();
                }
            }
            if (count >= 64) {
                EXPECT_GT(sum, count);
            }
        }
    }
}

/// What one question gives by itself.
ContactGeometry collide(const CpuState& state, const BoxQuestion& question) {
    const uint a = question.body_a, b = question.body_b;
    const vec3 motion = motion_between(state.velocities[a], state.velocities[b], state.parameters);
    BodyPose pose_b = state.poses[b];
    pose_b.position = add_scaled(pose_b.position, motion, question.time);
    return collide_shapes(state.poses[a], state.shapes[a], pose_b, state.shapes[b], question.carriers,
                          contact_reach(motion, question.had_contact != 0, state.parameters));
}

TEST(Lanes, find_parted_as_one_at_a_time) {
    const TreeOfBoxes boxes(200, 200);
    std::vector<uint> places, partners;
    for (uint i = 0; i < 1'000; ++i) {
        places.push_back(i * 7 % 200);
        partners.push_back(i * 13 % 200);
    }
    const auto is_parted = [&](std::size_t i) {
        return faces_part(boxes.boxes[boxes.bodies[places[i]]], boxes.boxes[boxes.bodies[partners[i]]]);
    };
    for (const LaneSearch* search : TALUS_RUNNABLE(lane_search)) {
        int parted = 0;
        for (std::size_t first = 0; first + search->lanes <= places.size(); first += search->lanes) {
            const uint found =
                search->find_parted({boxes.boxes.data(), boxes.bodies.data()}, &places[first], &partners[first]);
            for (uint lane = 0; lane < search->lanes; ++lane) {
                EXPECT_EQ((found >> lane & 1u) != 0, is_parted(first + lane)) << first + lane;
                parted += is_parted(first + lane) ? 1 : 0;
            }
        }
        EXPECT_GT(parted, 100);
        EXPECT_LT(parted, 950);
    }
}

TEST(Lanes, collide_boxes_with_the_bits_of_one_at_a_time) {
    const FlushDenormals flush;
    Items items(1, 0.0f);
    for (uint a = 0; a < Items::k_bodies; ++a) {
        items.poses[a].position = items.vector(0.6f);
        if (a % 4 == 0) items.poses[a].rotation = vec4(0.0f, 0.0f, 0.0f, 1.0f); // their edges are parallel
        if (a % 4 == 1)                                                         // their edges lie on faces, nearly
            items.poses[a].rotation = normalise_quaternion(vec4(0.003f, items.number(1.0f), 0.002f, 1.0f));
        items.velocities[a].linear = items.vector(a % 3 == 0 ? 9.0f : 0.0f);
        items.shapes[a].half_extents = vec3(0.5f) + items.vector(0.3f);
    }
    items.poses[7].position.y = std::numeric_limits<float>::quiet_NaN();
    const CpuState state = items.state();
    std::vector<BoxQuestion> questions;
    for (uint a = 0; a < Items::k_bodies; ++a) {
        for (uint b = 0; b < a; ++b) {
            BoxQuestion question{a, b, no_carriers(), (a + b) % 5 == 0 ? 0.7f : 0.0f, (a + b) % 3 == 0 ? 0u : 1u};
            if (question.had_contact != 0) { // of which some points carried load
                const ContactGeometry g = collide(state, question);
                question.carriers.axis = a % 6 == 0 ? (a * b) % 15 : g.axis;
                for (uint i = 0; i < g.count; ++i)
                    question.carriers.features[i] = (i + b) % 2 == 0 ? g.features[i] : k_none;
            }
            questions.push_back(question);
        }
    }
    for (const LaneQueries* queries : TALUS_RUNNABLE(lane_queries)) {
        int apart = 0, at_faces = 0, at_edges = 0, of_four = 0;
        for (std::size_t first = 0; first + queries->lanes <= questions.size(); first += queries->lanes) {
            ContactGeometry answers[k_most_lanes];
            queries->collide_box_pairs(state, &questions[first], answers);
            for (uint lane = 0; lane < queries->lanes; ++lane) {
                const BoxQuestion& question = questions[first + lane];
                const ContactGeometry one = collide(state, question);
                EXPECT_EQ(std::memcmp(&one, &answers[lane], sizeof one), 0)
                    << question.body_a << " and " << question.body_b;
                ++(one.count == 0 ? apart : one.axis < 6 ? at_faces : at_edges);
                of_four += one.count == 4 ? 1 : 0;
            }
        }
        EXPECT_GT(apart, 100);
        EXPECT_GT(at_faces, 100);
        EXPECT_GT(at_edges, 100);
        EXPECT_GT(of_four, 100);
    }
}

TEST(Lanes, find_near_as_one_at_a_time) {
    const FlushDenormals flush;
    Items items(2, 0.0f);
    for (uint i = 0; i < Items::k_bodies; ++i) {
        items.poses[i].position = items.vector(1.0f);
        items.velocities[i].linear = items.vector(5.0f); // the faster, the farther it sees
        items.shapes[i].half_extents = vec3(0.3f) + items.vector(0.2f);
        const uint kind = i % 9 == 8 ? k_kind_absent : i % 3 == 0 ? k_kind_static : k_kind_rigid;
        items.shapes[i].type =
            (i % 5 == 4 ? k_shape_sphere : k_shape_box) | kind << 8 | (i % 7 == 6 ? k_sensor_bit : 0u);
    }
    items.poses[3].position.x = std::numeric_limits<float>::quiet_NaN();
    std::vector<Pair> pairs;
    for (uint a = 0; a < Items::k_bodies; ++a)
        for (uint b = 0; b < a; ++b)
            pairs.push_back(make_pair(a, b));
    const CpuState state = items.state();
    const auto box_of = [&](uint body) { return compute_aabb(box_now(state, body)); };
    const auto is_near = [&](const Pair& pair) { return is_candidate(box_of(pair.body_a), box_of(pair.body_b)); };
    const auto is_still_near = [&](const Pair& pair) {
        return is_still_candidate(box_of(pair.body_a), box_of(pair.body_b));
    };
    items.poses[1].position = items.poses[0].position; // and then beside it, apart by less than k_parting
    items.poses[1].position.x += box_of(0).upper.x - box_of(1).lower.x + 0.4f * k_parting;
    ASSERT_FALSE(is_near({0, 1}));
    ASSERT_TRUE(is_still_near({0, 1}));
    const auto near = std::ranges::count_if(pairs, is_near);
    ASSERT_GT(near, 100);
    ASSERT_LT(near, std::ssize(pairs) - 100);
    const auto expect_near = [&](const NearPairs& found, uint i, const Pair& pair, bool asked) {
        EXPECT_EQ(found.now >> i & 1u, asked && is_near(pair) ? 1u : 0u) << i;
        EXPECT_EQ(found.still >> i & 1u, asked && is_still_near(pair) ? 1u : 0u) << i;
    };
    for (const LaneQueries* queries : TALUS_RUNNABLE(lane_queries)) {
        for (std::size_t first = 0; first + queries->lanes <= pairs.size(); first += queries->lanes) {
            const NearPairs found = queries->find_near(state, &pairs[first]);
            for (uint lane = 0; lane < queries->lanes; ++lane)
                expect_near(found, lane, pairs[first + lane], true);
        }
    }
    for (uint count = 1; count <= 64; ++count) { // also such as fill no register
        const NearPairs found = find_near(state, pairs.data(), count);
        for (uint i = 0; i < 64; ++i)
            expect_near(found, i, pairs[i], i < count);
    }
}

/// What a pair's contact in the last step becomes in this one.
struct Renewed {
    bool may_last = false, in_place = false, stays = false, within_reach = false;
    bool stays_at_a_face = false; ///< would it, if it were one of faces
    Manifold manifold{};
    Separations separations{};
    ManifoldPoint points[4]{};

    bool lasts() const { return may_last && in_place && stays && within_reach; }
};

Renewed renewed(const CpuState& state, const LastContact& contact, float most) {
    const Parameters& p = state.parameters;
    const auto [body_a, body_b] = state.pairs[contact.pair];
    const BodyStart &start_a = state.starts[body_a], &start_b = state.starts[body_b];
    const BodyShape &shape_a = state.shapes[body_a], &shape_b = state.shapes[body_b];
    const BodyVelocity &velocity_a = state.velocities[body_a], &velocity_b = state.velocities[body_b];
    const Manifold& old = state.old_manifolds[contact.manifold];
    const Separations& old_separations = state.old_point_separations[contact.manifold];
    const ManifoldPoint* const old_points = &state.old_manifold_points[std::size_t{4} * contact.manifold];
    const Movement a = last_movement(state.poses[body_a], start_a), b = last_movement(state.poses[body_b], start_b);
    const vec3 offset = offset_at_meeting(start_a.position, start_b.position, vec3(0.0f));
    const MeetingPoint meeting = meeting_point(old_points[0].anchor, offset, shape_a, shape_b);
    const LastingAxis axis = lasting_axis(old, a, b, state.poses[body_a], state.poses[body_b]);
    const float way = way_after(old_separations, way_between(a, b, meeting), axis.leverage);
    Renewed made;
    made.manifold = lasting_manifold(old, axis.normal, p);
    vec4 opening(0.0f);
    for (uint i = 0; i < old.point_count; ++i) {
        opening[static_cast<int>(i)] = opening_at(made.manifold.normal, old_points[i].anchor, offset, a, b);
        made.points[i] = make_point(lasting_anchor(old_points[i].anchor, offset, a, b), old_points[i].feature_id);
    }
    made.separations = lasting_separations(old_separations, opening, way, old.point_count);
    made.may_last = may_last(start_a, shape_a, start_b, shape_b);
    made.in_place = was_found_in_place(old_separations);
    made.stays = stays(way, next_movement(velocity_a, p), next_movement(velocity_b, p), meeting, axis.leverage, most);
    made.stays_at_a_face = stays(way_after(old_separations, way_between(a, b, meeting), 1.0f),
                                 next_movement(velocity_a, p), next_movement(velocity_b, p), meeting, 1.0f, most);
    made.within_reach =
        is_within_reach(made.separations, old.point_count, motion_between(velocity_a, velocity_b, p), p);
    return made;
}

TEST(Lanes, renew_contacts_with_the_bits_of_one_at_a_time) {
    const FlushDenormals flush;
    Items items(4, 0.0f);
    std::vector<BodyStart> starts;
    for (uint i = 0; i < Items::k_bodies; ++i) {
        const float size = i % 8 == 7 ? 1e-4f : 6e-6f; // most have hardly moved
        const BodyPose before = items.poses[i];
        items.poses[i].position += items.vector(size);
        const vec3 turn = items.vector(size);
        const vec4 change(turn.x, turn.y, turn.z, 1.0f);
        items.poses[i].rotation = normalise_quaternion(multiply_quaternions(change, before.rotation));
        starts.push_back(start_at(before, items.poses[i]));
        items.velocities[i].linear = items.vector(60.0f * size);
        items.velocities[i].angular = items.vector(60.0f * size);
        const uint kind = i % 29 == 28 ? k_kind_absent : i % 3 == 0 ? k_kind_static : k_kind_rigid;
        items.shapes[i].type =
            (i % 17 == 16 ? k_shape_sphere : k_shape_box) | kind << 8 | (i % 23 == 22 ? k_sensor_bit : 0u);
        items.shapes[i].half_extents = vec3(0.3f) + items.vector(0.2f);
    }
    starts[11] = forget_turn(starts[11]);
    starts[12].position.x = std::numeric_limits<float>::quiet_NaN();

    constexpr uint k_pairs = 200;
    std::vector<Pair> pairs;
    std::vector<Manifold> old_manifolds;
    std::vector<ManifoldPoint> old_points;
    std::vector<Separations> old_separations;
    std::vector<NormalImpulses> old_impulses;
    std::vector<LastContact> contacts;
    for (uint i = 0; i < k_pairs; ++i) {
        pairs.push_back(make_pair(i % Items::k_bodies, (7 * i + 5) % Items::k_bodies));
        contacts.push_back({i, (i + 3) % k_pairs});
        const vec3 n = items.vector(1.0f), friction = items.vector(0.3f);
        const uint count = 1 + i % 4, colour = i % 19 == 0 ? k_inactive_colour : i % 20;
        old_manifolds.push_back({i, i + 1, count, colour, scale3(n, inverse_sqrt(dot3(n, n))),
                                 i % 5 == 0 ? 6 + i % 9 : i % 6, 0.5f, 0.1f, friction.x, friction.y, friction.z,
                                 items.number(1.0f), items.number(1.0f),
                                 make_demand(8 << i % 3, i % 5, i % 4, 1 + i % 5)});
        for (uint k = 0; k < 4; ++k) // those that are not there may be anything
            old_points.push_back({k < count ? items.vector(0.5f) : vec3(NAN), 10 * i + k});
        old_separations.push_back({items.vector4(i % 11 == 0 ? 0.02f : 0.003f),
                                   vec3(i % 16 == 15 ? 0.1f : 0.0f, 0.0f, 0.0f), i % 9 == 8 ? 3.6e-4f : 1e-4f});
        old_impulses.push_back({items.vector4(1.0f)});
    }
    CpuState state = items.state();
    state.parameters.speculative_distance = 0.012f;
    state.parameters.most_substeps = 16; // fewer than some ask for
    const float most = most_way(false, state.parameters);
    state.starts = {starts.data(), starts.size()};
    state.pairs = {pairs.data(), pairs.size()};
    state.old_manifolds = {old_manifolds.data(), old_manifolds.size()};
    state.old_manifold_points = {old_points.data(), old_points.size()};
    state.old_point_separations = {old_separations.data(), old_separations.size()};
    state.old_point_impulses = {old_impulses.data(), old_impulses.size()};
    const auto number_lasting =
        std::ranges::count_if(contacts, [&](const auto& c) { return renewed(state, c, most).lasts(); });
    ASSERT_GT(number_lasting, 60);
    ASSERT_LT(number_lasting, k_pairs - 60);
    const auto fails_by_it_alone = [&](bool Renewed::*condition) {
        return std::ranges::any_of(contacts, [&](const LastContact& contact) {
            Renewed one = renewed(state, contact, most);
            const bool fails = !(one.*condition);
            one.*condition = true;
            return fails && one.lasts();
        });
    };
    for (bool Renewed::*condition : {&Renewed::may_last, &Renewed::in_place, &Renewed::stays, &Renewed::within_reach})
        ASSERT_TRUE(fails_by_it_alone(condition));
    const auto is_of_edges = [&](const LastContact& contact) { return old_manifolds[contact.manifold].axis >= 6; };
    ASSERT_TRUE(std::ranges::any_of(contacts,
                                    [&](const auto& c) { return is_of_edges(c) && renewed(state, c, most).lasts(); }));
    ASSERT_TRUE(std::ranges::any_of(contacts, [&](const auto& c) {
        Renewed one = renewed(state, c, most);
        const bool turns_too_far = one.stays_at_a_face && !one.stays;
        one.stays = true;
        return turns_too_far && one.lasts();
    }));
    for (std::size_t sets = 1; sets <= runnable_sets(); ++sets) {
        usable_sets = sets;
        for (uint at_a_time = 1; at_a_time <= 64; at_a_time += 7) { // also such as fill no register
            const Manifold untouched{k_none, k_none, k_none, k_none, vec3(7.0f), 0, 0, 0, 0, 0, 0, 0, 0, 0};
            std::vector<Manifold> manifolds(k_pairs, untouched);
            const ManifoldPoint no_point{vec3(0.0f), 0};
            std::vector<ManifoldPoint> points(std::size_t{4} * k_pairs, no_point);
            std::vector<Separations> separations(k_pairs, Separations{vec4(7.0f), vec3(0.0f), 0.0f});
            std::vector<NormalImpulses> impulses(k_pairs, NormalImpulses{vec4(7.0f)});
            state.manifolds = {manifolds.data(), manifolds.size()};
            state.manifold_points = {points.data(), points.size()};
            state.point_separations = {separations.data(), separations.size()};
            state.point_impulses = {impulses.data(), impulses.size()};
            for (uint first = 0; first < k_pairs; first += at_a_time) {
                const uint count = min(at_a_time, k_pairs - first);
                const std::uint64_t lasting = renew_last_contacts(state, &contacts[first], count, most);
                for (uint i = 0; i < 64; ++i) {
                    const bool lasts = i < count && renewed(state, contacts[first + i], most).lasts();
                    EXPECT_EQ(lasting >> i & 1u, lasts ? 1u : 0u) << first + i;
                }
            }
            for (uint i = 0; i < k_pairs; ++i) {
                const Renewed one = renewed(state, contacts[i], most);
                const Manifold wanted = one.lasts() ? one.manifold : untouched;
                EXPECT_EQ(std::memcmp(&manifolds[i], &wanted, sizeof wanted), 0) << i;
                for (uint k = 0; k < 4; ++k) {
                    const ManifoldPoint point = one.lasts() ? one.points[k] : no_point;
                    EXPECT_EQ(std::memcmp(&points[std::size_t{4} * i + k], &point, sizeof point), 0) << i;
                }
                if (!one.lasts()) {
                    EXPECT_EQ(impulses[i].normal, vec4(7.0f)) << i;
                    EXPECT_EQ(separations[i].separation, vec4(7.0f)) << i;
                    continue;
                }
                EXPECT_EQ(std::memcmp(&separations[i], &one.separations, sizeof one.separations), 0) << i;
                EXPECT_EQ(impulses[i].normal, old_impulses[contacts[i].manifold].normal) << i;
            }
        }
    }
    usable_sets = std::numeric_limits<std::size_t>::max();
}

TEST(Lanes, move_bodies_with_the_bits_of_one_at_a_time) {
    const FlushDenormals flush;
    Items items(5, 0.0f);
    items.deltas[7].position.y = std::numeric_limits<float>::infinity();
    items.velocities[20].angular.z = std::numeric_limits<float>::quiet_NaN();
    items.velocities[21].linear = vec3(900.0f, 0.0f, 0.0f); // faster than is allowed
    items.velocities[22] = {vec3(900.0f, 0.0f, 0.0f), 0.0f, vec3(0.0f), 0};
    const std::vector<BodyPose> poses = items.poses;
    const std::vector<BodyVelocity> velocities = items.velocities;
    std::vector<MovingBody> moving;
    for (uint i = 0; i < Items::k_bodies; ++i)
        moving.push_back({(5 * i + 3) % Items::k_bodies, (poses[i].flags & ~k_body_frozen) | k_body_placed | i << 16});
    const BodyStart no_start{vec3(0.0f), 7};
    for (std::size_t sets = 1; sets <= runnable_sets(); ++sets) {
        usable_sets = sets;
        for (uint at_a_time = 1; at_a_time <= 64; at_a_time += 7) { // also such as fill no register
            items.poses = poses;
            items.velocities = velocities;
            std::vector<BodyStart> starts(Items::k_bodies, no_start);
            CpuState state = items.state();
            state.starts = {starts.data(), starts.size()};
            std::vector<bool> left(Items::k_bodies, false);
            for (uint first = 0; first < moving.size(); first += at_a_time) {
                const uint count = min(at_a_time, static_cast<uint>(moving.size()) - first);
                const std::uint64_t bits = move_bodies(state, &moving[first], count);
                for (uint i = 0; i < count; ++i)
                    left[moving[first + i].body] = (bits >> i & 1u) != 0;
            }
            EXPECT_EQ(std::ranges::count(left, true), 2);
            for (const auto& [body, flags] : moving) {
                BodyPose pose = poses[body];
                pose.flags = flags;
                const BodyPose moved = apply_delta(pose, items.deltas[body]);
                const bool is_finite = is_finite_motion(moved, velocities[body]);
                EXPECT_EQ(left[body], !is_finite) << body;
                const BodyPose wanted = is_finite ? moved : poses[body];
                const BodyStart start = is_finite ? start_at(pose, moved) : no_start;
                const BodyVelocity limited =
                    is_finite ? limit_speeds(velocities[body], state.parameters) : velocities[body];
                EXPECT_EQ(std::memcmp(&items.poses[body], &wanted, sizeof wanted), 0) << body;
                EXPECT_EQ(std::memcmp(&starts[body], &start, sizeof start), 0) << body;
                EXPECT_EQ(std::memcmp(&items.velocities[body], &limited, sizeof limited), 0) << body;
            }
        }
    }
    usable_sets = std::numeric_limits<std::size_t>::max();
}

} // namespace
} // namespace talus::engine
