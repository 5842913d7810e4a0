// SPDX-License-Identifier: MIT
// LanePasses for one set of instructions: src/CMakeLists.txt compiles this once for each.
#include "device/cpu/instruction_set.h"
#include "device/cpu/lane_records.h"
#include "resolution/lane_passes.h"

namespace talus::engine::TALUS_LANES_NAME {

// ---- before the passes ----

/// What the points of a manifold change.
TALUS_LANE ContactConstraint choose(Mask m, const ContactConstraint& yes, const ContactConstraint& no) {
    ContactConstraint c = no;
    c.centre_a = choose(m, yes.centre_a, no.centre_a);
    c.centre_b = choose(m, yes.centre_b, no.centre_b);
    c.x = choose(m, yes.x, no.x);
    c.y = choose(m, yes.y, no.y);
    c.lever = choose(m, yes.lever, no.lever);
    c.base_separation = choose(m, yes.base_separation, no.base_separation);
    c.normal_mass = choose(m, yes.normal_mass, no.normal_mass);
    c.normal_impulse = choose(m, yes.normal_impulse, no.normal_impulse);
    c.load_speed = choose(m, yes.load_speed, no.load_speed);
    return c;
}

/// As prepare_contacts.comp.glsl.
inline void prepare_contacts(const CpuState& state, const ContactToPrepare* contacts, std::uint32_t count) {
    std::uint32_t places[k_lanes], manifolds[k_lanes], body_a[k_lanes], body_b[k_lanes], points[4][k_lanes];
    FloatVector hub_shares{};
    UintVector colours{}, orders{}, manifold_indices{};
    for (int lane = 0; lane < k_lanes; ++lane) {
        const ContactToPrepare& contact = contacts[static_cast<std::uint32_t>(lane) < count ? lane : 0];
        const engine::Manifold& manifold = state.manifolds.data[contact.manifold];
        places[lane] = contact.index;
        manifolds[lane] = manifold_indices[lane] = contact.manifold;
        body_a[lane] = manifold.body_a;
        body_b[lane] = manifold.body_b;
        hub_shares[lane] = contact.hub_share;
        colours[lane] = contact.colour;
        orders[lane] = contact.order;
        for (std::uint32_t i = 0; i < 4; ++i)
            points[i][lane] = 4 * contact.manifold + i;
    }
    const std::uint32_t lanes = (1u << count) - 1u;
    const Manifold manifold = manifolds_at(state.manifolds.data, manifolds);
    const BodyInertia inertia_a = inertias_at(state, body_a), inertia_b = inertias_at(state, body_b);
    const Lanes inverse_mass_a = gather(state.velocities.data, body_a, 0).w;
    const Lanes inverse_mass_b = gather(state.velocities.data, body_b, 0).w;

    ContactConstraint c =
        begin_constraint(manifold, ULanes(manifold_indices), ULanes(colours), ULanes(orders), Lanes(hub_shares),
                         inverse_mass_a, inverse_mass_b, inertia_a, inertia_b, state.parameters);
    const auto has_point = [&](std::uint32_t i) __attribute__((always_inline)) {
        return ULanes(i) < point_count_of(c.counts);
    };
    const vec3 position_a = three_of(gather(state.poses.data, body_a, 0));
    const vec3 position_b = three_of(gather(state.poses.data, body_b, 0));
    Separations separations = separations_at(state.point_separations.data, manifolds);
    const vec3 offset = offset_at_meeting(position_a, position_b, separations.shift);
    for (std::uint32_t i = 0; i < 4; ++i)
        c = choose(has_point(i), add_to_centre(c, points_at(state.manifold_points.data, points[i]).anchor, offset), c);
    c = end_centre(c, position_a, position_b);

    const Standing standing = find_standing(c.normal, c.centre_a, c.centre_b, c.gap, state.parameters);
    const LoadBelow load = load_below(manifold, standing, inverse_mass_a, inverse_mass_b);
    const ULanes height = height_of(manifold.demand);
    for (std::uint32_t tells = lanes & bits_of(load.mass != 0u); tells != 0; tells &= tells - 1) {
        const int lane = __builtin_ctz(tells);
        tell_load(state, {load.body.v[lane], load.mass.v[lane]}, height.v[lane]);
    }
    const ToldFoot foot = told_foot(manifold, standing);
    for (std::uint32_t tells = lanes & bits_of(foot.rate != 0u); tells != 0; tells &= tells - 1) {
        const int lane = __builtin_ctz(tells);
        tell_foot(state, {foot.body.v[lane], foot.rate.v[lane]});
    }

    const Meeting meeting = make_meeting(c, inertia_a, inertia_b);
    c.friction_mass = friction_masses(meeting);
    const NormalResponse response = respond_to_normals(meeting);
    vec4 impulses = all_of(gather(state.point_impulses.data, manifolds, 0));
    for (std::uint32_t i = 0; i < 4; ++i)
        c = choose(has_point(i),
                   add_point(c, static_cast<int>(i), points_at(state.manifold_points.data, points[i]).anchor,
                             separations.separation[static_cast<int>(i)], impulses[static_cast<int>(i)], meeting,
                             response),
                   c);
    const Lanes force = force_of(manifold.lasting_weights, inverse_mass_a, inverse_mass_b, state.parameters);
    c.base_separation = lifted_separation(c.base_separation, c.normal_mass, force, substeps_of_contact(c.counts),
                                          c.traits, state.parameters);
    put_constraints(state, places, lanes, c);
}

// ---- the passes ----

/// In which ticks some of a batch may have a sub-step.
struct Ticks {
    std::uint32_t end;      ///< from here on none has
    std::uint32_t slowness; ///< of the fastest
};

inline Ticks no_ticks() {
    return {0, engine::k_most_doublings};
}

inline Ticks join_ticks(Ticks ticks, std::uint32_t substeps, std::uint32_t traits) {
    const std::uint32_t end = engine::ticks_of(substeps, traits), slowness = engine::slowness(traits);
    return {end > ticks.end ? end : ticks.end, slowness < ticks.slowness ? slowness : ticks.slowness};
}

inline bool has_any(Ticks ticks, std::uint32_t tick, std::uint32_t end) {
    return tick < end && (tick & ((1u << ticks.slowness) - 1u)) == 0;
}

struct Places {
    BodyOffsets body_a, body_b;
    std::uint32_t constraint[k_lanes];
    std::uint32_t hub_change[k_lanes]; ///< of constraints of hubs
};

/// What the passes of a step need of some constraints, one a lane.
struct ConstraintBatch {
    Places places;
    std::uint32_t lanes; ///< a bit for each that has one
    std::uint32_t stale; ///< a bit for each whose impulses are the record's, as it was left alone
    Ticks ticks;
    bool in_parts; ///< some body has more sub-steps than its constraint
    ULanes body_a, body_b, traits, substeps;
    Lanes hub_share, load_speed, part_a, part_b;
    Substep substep;
    Lanes half_h; ///< s, see touch_of_pass
    vec3 gap;
    vec4 base_separation;
    ManifoldRows rows;
    ManifoldImpulses impulses; ///< the records have them after the last pass of a step
};

TALUS_LANE ManifoldImpulses impulses_at(const CpuState& state, const std::uint32_t* places) {
    const auto cell = [&](std::size_t i) __attribute__((always_inline)) {
        return gather(state.constraints.data, places, i);
    };
    const auto friction = cell(11), slip = cell(12), normal = cell(13), total = cell(14);
    return {all_of(normal), all_of(total), three_of(friction), three_of(slip)};
}

TALUS_LANE void put_impulses(const CpuState& state, const std::uint32_t* places, std::uint32_t lanes,
                             const ManifoldImpulses& is, const ConstraintBatch& batch) {
    const auto put = [&](std::size_t cell, Lanes x, Lanes y, Lanes z, Lanes w) __attribute__((always_inline)) {
        scatter(state.constraints.data, places, cell, lanes, {x, y, z, w});
    };
    put(11, is.friction.x, is.friction.y, is.friction.z, batch.hub_share);
    put(12, is.slip.x, is.slip.y, is.slip.z, batch.load_speed);
    put(13, is.normal.x, is.normal.y, is.normal.z, is.normal.w);
    put(14, is.total.x, is.total.y, is.total.z, is.total.w);
}

TALUS_LANE ManifoldImpulses choose(Mask m, const ManifoldImpulses& yes, const ManifoldImpulses& no) {
    return {choose(m, yes.normal, no.normal), choose(m, yes.total, no.total), choose(m, yes.friction, no.friction),
            choose(m, yes.slip, no.slip)};
}

/// As target_of_pass in contact_passes.h.
TALUS_LANE PassTarget target_of_pass(ContactPass pass, const ConstraintBatch& c, const ManifoldRows& rows,
                                     const ManifoldImpulses& impulses, const Slip& slip, const BodyDelta& delta_a,
                                     const BodyDelta& delta_b, const Parameters& p) {
    const bool relax = pass == ContactPass::Relax;
    PassTarget target;
    const Lanes load_speed = load_speed_so_far(c.load_speed, rows, impulses);
    const bool is_heavier = any_lane(heaviness(load_speed) > heaviness(c.load_speed));
    const Substep substep =
        is_heavier ? make_substep(c.substeps, is_against_static(c.traits), load_speed, p) : c.substep;
    target.friction = make_friction_target(rows, impulses.normal);
    target.old_share = pass == ContactPass::Solve ? 0.0f : 1.0f;
    target.touch = touch_of_pass(slip, rows.meeting, impulses, relax ? Lanes(0.0f) : c.half_h, relax);
    target.normal = make_normal_target(current_separations(rows, c.base_separation, c.traits, delta_a, delta_b), rows,
                                       impulses.normal, !relax, substep, p);
    if (relax) target.normal.lower = least_relaxed(rows, c.base_separation, impulses, substep);
    return target;
}

/// As in contact_passes.h.
TALUS_LANE void put_velocity(const CpuState& state, const Places& places, const BodyOffsets& bodies,
                             std::uint32_t lanes, ULanes body, ULanes its_traits, Lanes hub_share, std::uint32_t tick,
                             const BodyVelocity& before, const BodyVelocity& after) {
    const std::uint32_t of_hubs = bits_of((its_traits & k_trait_hub) != 0u);
    lanes &= ~bits_of((its_traits & k_trait_asleep) != 0u);
    put_velocities(state, bodies, lanes & ~of_hubs, after);
    const std::uint32_t shares = lanes & of_hubs & bits_of(after.inverse_mass != 0.0f);
    if (shares == 0) return;
    const HubChange change = change_of_hub(body, before, after, hub_share, tick);
    scatter(state.hub_changes.data, places.hub_change, 0, shares,
            {change.linear.x, change.linear.y, change.linear.z, uintBitsToFloat(change.body)});
    scatter(state.hub_changes.data, places.hub_change, 1, shares,
            {change.angular.x, change.angular.y, change.angular.z, uintBitsToFloat(change.tick)});
}

/// Of constraints that are prepared; see LanePasses.
inline void take_constraints(const CpuState& state, const std::uint32_t* indices, std::uint32_t count, void* memory) {
    ConstraintBatch& batch = *static_cast<ConstraintBatch*>(memory);
    Places& places = batch.places;
    batch.lanes = (1u << count) - 1u;
    batch.stale = k_lane_mask; // lanes without one compute with the first one's, too
    batch.ticks = no_ticks();
    for (std::uint32_t lane = 0; lane < k_lanes; ++lane) {
        const std::uint32_t index = indices[lane < count ? lane : 0];
        const engine::ContactConstraint& c = state.constraints.data[index];
        places.constraint[lane] = index;
        places.body_a.bytes[lane] = sizeof(engine::BodyVelocity) * c.body_a;
        places.body_b.bytes[lane] = sizeof(engine::BodyVelocity) * c.body_b;
        batch.ticks = join_ticks(batch.ticks, engine::substeps_of_contact(c.counts), c.traits);
        if ((c.traits & (k_trait_hub | k_trait_hub << engine::k_traits_of_b)) != 0)
            places.hub_change[lane] = index - state.colour_offsets[k_first_hub_colour];
    }
    const ContactConstraint c = constraints_at(state, places.constraint);
    batch.body_a = c.body_a;
    batch.body_b = c.body_b;
    batch.traits = c.traits;
    batch.substeps = substeps_of_contact(c.counts);
    batch.hub_share = c.hub_share;
    batch.load_speed = c.load_speed;
    const Mask against_static = is_against_static(c.traits);
    batch.substep = make_substep(batch.substeps, against_static, c.load_speed, state.parameters);
    batch.half_h = choose(against_static, 0.5f * substep_length(batch.substeps, state.parameters), 0.0f);
    batch.gap = c.gap;
    batch.base_separation = c.base_separation;
    const BodyInertia inertia_a = inertias_at(state, places.body_a), inertia_b = inertias_at(state, places.body_b);
    batch.rows = make_rows(c, inertia_a, inertia_b);
    batch.part_a = part_of_change(c.traits, inertia_a.traits);
    batch.part_b = part_of_change(c.traits, inertia_b.traits);
    batch.in_parts = any_lane(batch.part_a < 1.0f || batch.part_b < 1.0f);
}

/// As pass_over_constraint in contact_passes.h.
inline std::uint32_t pass_over_batch(const CpuState& state, ContactPass pass, std::uint32_t tick, void* memory) {
    ConstraintBatch& batch = *static_cast<ConstraintBatch*>(memory);
    if (!has_any(batch.ticks, tick, batch.ticks.end)) return 0;
    const Places& places = batch.places;
    if (batch.stale != 0)
        batch.impulses = choose(mask_of(batch.stale), impulses_at(state, places.constraint), batch.impulses);
    batch.stale = 0;
    const ULanes substep = substep_at(tick, batch.traits);
    const Mask takes_part = substep < batch.substeps;
    std::uint32_t active = batch.lanes & bits_of(takes_part);
    const ManifoldRows& rows = batch.rows;
    const ManifoldState before{
        {velocities_at(state, places.body_a), velocities_at(state, places.body_b)}, batch.impulses, false};
    ManifoldState s = before;
    if (pass == ContactPass::WarmStart) {
        s.velocities = warm_start_manifold(s.velocities, rows, s.impulses);
    } else {
        const BodyDelta delta_a = deltas_at(state, places.body_a), delta_b = deltas_at(state, places.body_b);
        const Slip slip = measure_slip(rows.meeting, batch.gap, batch.traits, delta_a, delta_b);
        const PassTarget target =
            target_of_pass(pass, batch, rows, s.impulses, slip, delta_a, delta_b, state.parameters);
        s = solve_manifold(s, rows, target);
        s.impulses.slip = slip.apart;
        batch.stale = active & bits_of(s.is_hit || !is_finite_pair(s.velocities));
        if (batch.stale != 0) put_impulses(state, places.constraint, batch.stale, before.impulses, batch);
        active &= ~batch.stale;
        batch.impulses = active == k_lane_mask ? s.impulses : choose(mask_of(active), s.impulses, before.impulses);
        const bool is_last = pass == ContactPass::Relax;
        const std::uint32_t ending = active & bits_of(Mask(is_last) || batch.substeps <= substep + 1u);
        if (ending != 0) put_impulses(state, places.constraint, ending, s.impulses, batch);
    }
    if (batch.in_parts && pass != ContactPass::Relax) {
        s.velocities.a = change_in_part(before.velocities.a, s.velocities.a, batch.part_a);
        s.velocities.b = change_in_part(before.velocities.b, s.velocities.b, batch.part_b);
    }
    const ULanes traits_of_b = batch.traits >> k_traits_of_b;
    put_velocity(state, places, places.body_a, active, batch.body_a, batch.traits, batch.hub_share, tick,
                 before.velocities.a, s.velocities.a);
    put_velocity(state, places, places.body_b, active, batch.body_b, traits_of_b, batch.hub_share, tick,
                 before.velocities.b, s.velocities.b);
    return batch.stale;
}

/// What the sub-steps of a step need of some bodies, one a lane.
struct BodyBatch {
    BodyOffsets offsets;
    std::uint32_t indices[k_lanes];
    std::uint32_t lanes; ///< a bit for each that moves
    Ticks ticks;
    Mask rigid;
    ULanes substeps;
    Lanes h; ///< s
    vec4 rotation;
    BodyInertia inertia;
    BodyProperties properties;
    BodyLoad load;
    BodyDelta delta; ///< the records have it, too
};

/// See LanePasses.
inline void take_bodies(const CpuState& state, const std::uint32_t* indices, std::uint32_t count, void* memory) {
    BodyBatch& batch = *static_cast<BodyBatch*>(memory);
    batch.lanes = 0;
    batch.ticks = no_ticks();
    std::uint32_t rigid = 0; // bits
    for (std::uint32_t lane = 0; lane < k_lanes; ++lane) {
        const std::uint32_t body = indices[lane < count ? lane : 0], bit = 1u << lane;
        batch.indices[lane] = body;
        batch.offsets.bytes[lane] = sizeof(engine::BodyVelocity) * body;
        const engine::BodyInertia& inertia = state.inertias.data[body];
        if (lane >= count || (inertia.traits & k_trait_moves) == 0 || inertia.substeps == 0 ||
            (state.poses.data[body].flags & k_body_frozen) != 0)
            continue;
        batch.lanes |= bit;
        batch.ticks = join_ticks(batch.ticks, inertia.substeps, inertia.traits);
        if ((inertia.traits & k_trait_movable) != 0) rigid |= bit;
    }
    batch.rigid = mask_of(rigid);
    batch.inertia = inertias_at(state, batch.offsets);
    batch.substeps = batch.inertia.substeps;
    batch.h = substep_length(batch.substeps, state.parameters);
    batch.rotation = all_of(gather(state.poses.data, batch.offsets, 1));
    batch.properties = properties_at(state, batch.indices);
    const bool has_load = any_lane((batch.inertia.traits & k_trait_loaded) != 0u); // see load_of_body
    batch.load = has_load ? loads_at(state, batch.indices) : no_load();
    batch.delta = deltas_at(state, batch.offsets);
}

/// As integrate_body in body_passes.h.
inline std::uint32_t integrate_batch(const CpuState& state, std::uint32_t tick, void* memory) {
    BodyBatch& batch = *static_cast<BodyBatch*>(memory);
    if (batch.lanes == 0 || !has_any(batch.ticks, tick, batch.ticks.end + 1)) return 0;
    const ULanes substep = substep_at(tick, batch.inertia.traits);
    const std::uint32_t active = batch.lanes & bits_of(substep <= batch.substeps);
    const std::uint32_t going_on = active & bits_of(substep < batch.substeps);
    BodyVelocity velocity = velocities_at(state, batch.offsets);
    BodyWarmStart warm = warm_starts_at(state, batch.indices);
    BodyDelta delta = batch.delta;
    if (tick > 0) {
        const BodyVelocity limited = limit_speeds(velocity, state.parameters);
        warm = leave_out(warm, velocity, limited);
        velocity = limited;
        const vec3 falling = falling_acceleration(velocity, warm, batch.properties, batch.inertia, batch.load, batch.h,
                                                  state.parameters);
        vec3 shift(glm::vec3(0.0f));
        if (state.some_bounce) shift = three_of(gather(hits_in(state), batch.indices, 0));
        delta = integrate_position(delta, shift, velocity, falling, batch.h);
    }
    std::uint32_t unusual = 0;
    if (going_on != 0) {
        const vec4 rotation = multiply_quaternions(delta.rotation, batch.rotation);
        warm = gather_impulses(warm, velocity);
        velocity = integrate_velocity(velocity, warm, rotation, batch.properties, batch.inertia, batch.load,
                                      batch.rigid, batch.h, state.parameters);
        unusual = going_on & ~bits_of(is_finite3(velocity.linear) && is_finite3(velocity.angular));
        if (state.some_bounce) {
            const BodyHits hits = no_hits(warm);
            scatter(hits_in(state), batch.indices, 0, going_on & ~unusual,
                    {hits.shift.x, hits.shift.y, hits.shift.z, hits.reserved_1});
            scatter(hits_in(state), batch.indices, 1, going_on & ~unusual,
                    {hits.load.x, hits.load.y, hits.load.z, hits.reserved_2});
        }
        put_warm_starts(state, batch.indices, going_on & ~unusual, kept_warm_start(warm, velocity));
        scatter(state.velocities.data, batch.offsets, 0, going_on & ~unusual,
                {velocity.linear.x, velocity.linear.y, velocity.linear.z, velocity.inverse_mass});
        scatter(state.velocities.data, batch.offsets, 1, going_on & ~unusual,
                {velocity.angular.x, velocity.angular.y, velocity.angular.z, uintBitsToFloat(velocity.stamp)});
    }
    if (tick > 0) {
        put_deltas(state, batch.offsets, active & ~unusual, delta);
        batch.delta = choose(mask_of(active), delta, batch.delta);
    }
    batch.lanes &= ~unusual; // they are frozen
    return unusual;
}

} // namespace talus::engine::TALUS_LANES_NAME

namespace talus::engine {

extern const LanePasses TALUS_OF_SET(lane_passes);
const LanePasses TALUS_OF_SET(lane_passes){TALUS_LANES,
                                           TALUS_LANES_NAME::prepare_contacts,
                                           sizeof(TALUS_LANES_NAME::ConstraintBatch),
                                           TALUS_LANES_NAME::take_constraints,
                                           TALUS_LANES_NAME::pass_over_batch,
                                           sizeof(TALUS_LANES_NAME::BodyBatch),
                                           TALUS_LANES_NAME::take_bodies,
                                           TALUS_LANES_NAME::integrate_batch};

} // namespace talus::engine
