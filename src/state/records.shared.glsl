// SPDX-License-Identifier: MIT
// The records that live in buffers, written once for C++ and GLSL. Every record is a row of 16-byte cells: a vec3 and a
// scalar, or four scalars; but for two of 8 bytes. The letters beside a record's buffer in buffers.h (f float, u uint) repeat
// its layout.

// ---- bodies: one record of each kind a body slot ----

// 32 bytes. The renderer draws from these.
struct BodyPose {
    vec3 position; // m, world, centre of mass
    uint flags;    // k_body_*, and from bit k_rest_shift on the steps that it has rested
    vec4 rotation; // body to world, x y z w
};

// 32 bytes. All of a body that the solver's inner loop reads but its inertia.
struct BodyVelocity {
    vec3 linear;        // m/s, world
    float inverse_mass; // 1/kg; 0 for static, kinematic and frozen bodies; a stamp where `stamp` is one
    vec3 angular;       // rad/s, world
    uint stamp;         // 0 but within a persistent launch: see resolution/solve_in_order.glsl
};

// 16 bytes
struct BodyShape {
    vec3 half_extents; // m, body axes; a sphere has its radius in all three
    uint type;         // bits 0-7 k_shape_*, bits 8-15 k_kind_*, bit 16 k_sensor_bit
};

// 48 bytes. What changes only when the caller says so.
struct BodyProperties {
    vec3 inverse_inertia; // 1/(kg m^2), principal, body axes
    float inverse_mass;   // 1/kg
    float gravity_scale;
    float linear_damping;  // 1/s
    float angular_damping; // 1/s
    float friction;
    float restitution;
    uint combine; // bits 0-7 friction, bits 8-15 restitution: k_combine_*
    uint reserved_1;
    uint reserved_2;
};

// 32 bytes. What the caller does to the body in the next step.
struct BodyLoad {
    vec3 force; // N, world
    uint disturbed; // 1 where the caller has changed the body, so that it and what it touches must wake
    vec3 torque; // N m, world
    float reserved_2;
};

// 16 bytes. Where the body was at the start of the step: the step's contact points are anchored there.
struct BodyStart {
    vec3 position; // m, world
    uint turn;     // by which the step has turned it: see pack_turn
};

// 32 bytes. Where the body was when its rest began. Kept while islands may sleep.
struct BodyRest {
    vec3 position; // m, world
    uint calm;     // steps since then without a touch of anything restless; up to as many as it has to rest. Of what sleeps as a
                   // part of a large island what is kept of that: see resolution/island.shared.glsl
    vec4 rotation;
};

// 32 bytes
struct Aabb {
    vec3 lower;   // m, world
    float margin; // m, how far beyond the shape the box reaches
    vec3 upper;
    uint movable; // 1 where contacts can push the body, and of a sensor
};

// 48 bytes. A body as the search for pairs saw it; of a sphere the cube around it, which does not turn.
struct OrientedBox {
    vec3 centre;  // m, world
    float margin; // m, how far beyond the shape contacts are looked for
    vec4 rotation;
    vec3 half_extents; // m
    uint type;         // BodyShape::type
};

// 32 bytes. How far a body has come since the start of the step.
struct BodyDelta {
    vec3 position; // m, world
    float reserved;
    vec4 rotation; // world, from the rotation at the start of the step to the present one
};

// 32 bytes. What contacts do to a body's velocity in one sub-step, so that the next sub-step can start from it.
struct BodyWarmStart {
    vec3 linear; // m/s: the sum of all accumulated impulses at the body over its mass; in the buffer less the velocity before the
                 // sub-step's contacts, so that to add the one behind them makes it the next sub-step's
    float reserved_1;
    vec3 angular; // rad/s
    float reserved_2;
};

// 32 bytes. What hits have to know of a body. Where something bounces these lie behind the warm starts of all bodies, in their buffer;
// and behind these, two in a record, how hard hits have been on each contact in the step.
struct BodyHits {
    vec3 shift; // m: what they add to the sub-step's movement
    float reserved_1;
    vec3 load; // m/s: what contacts have changed about the body in the last sub-step, but for hits
    float reserved_2;
};

// 32 bytes. World inverse inertia at the start of the step: a symmetric matrix.
struct BodyInertia {
    float xx; // 1/(kg m^2)
    float yy;
    float zz;
    float xy;
    float xz;
    float yz;
    uint traits;   // k_trait_*, and the rate: see resolution/multirate.shared.glsl
    uint substeps; // of its island, or of its own
};

// ---- contacts ----

// 8 bytes. body_a < body_b.
struct Pair {
    uint body_a;
    uint body_b;
};

// 64 bytes, one a pair. point_count is 0 where the two do not touch. Kept for one step, to warm start the next.
struct Manifold {
    uint body_a;
    uint body_b;
    uint point_count; // 0 to 4
    uint colour;      // batch of the constraint graph, k_no_colour before it has one; see k_whole_hub
    vec3 normal;      // unit, world, from A to B
    uint axis;        // the separating axis it stands on, see narrow_phase/box_axes.shared.glsl
    float friction;
    float restitution;
    float tangent_impulse_1; // N s, over the step; friction of all points together
    float tangent_impulse_2;
    float twist_impulse; // N m s, about the normal
    float weights;       // of the lighter body, that press the two together: a mean over some steps. Without points: m, how far apart
                         // they are at least, see lasting_contact.shared.glsl
    float lasting_weights; // those that last, see next_lasting_load
    uint demand;         // sub-steps that its load asks for, and how it came to that: see resolution/load.shared.glsl
};

// 16 bytes, four a pair: what the next step matches its points with. B's anchor and the point's place follow from it and
// from where the bodies were at the start of the step: see offset_at_meeting and point_position. Of a pair that sleeps it is kept.
struct ManifoldPoint {
    vec3 anchor; // m, from A's centre, world axes
    uint feature_id;
};

// 32 bytes, one a pair: the rest of what is known of its points. Of a pair without points nobody has written it.
struct Separations {
    vec4 separation; // m of each point, negative = overlap; 0 where there is none
    vec3 shift;      // m: B is this far on, as seen from A, where the bodies meet
    float way;       // m, by which the contact has moved at most since its bodies were collided: see lasting_contact.shared.glsl
};

// 16 bytes, one a pair: what its points start from in the next step. Not in the points, as the solver writes in an order of its
// own, and four words far apart cost as much as four records.
struct NormalImpulses {
    vec4 normal; // N s of each point, over the step; 0 where there is none
};

// 240 bytes, one a manifold, in the order of the solve: all that the solver reads of it. A vec4 holds a number for each
// point; see resolution/manifold_rows.shared.glsl.
struct ContactConstraint {
    uint body_a;
    uint body_b;
    uint manifold;
    uint counts; // points, sub-steps, contacts that come before it: see resolution/contact_counts.shared.glsl
    vec3 normal;
    float friction;
    vec3 centre_a; // m, the middle of the points from A's centre
    float restitution;
    vec3 centre_b; // m, from B's centre
    float inverse_mass_a; // 1/kg
    vec3 gap;             // m, from A's middle of the points to B's, at the start of the step
    uint traits;          // k_trait_* of A, and of B four bits higher; k_trait_whole_hub; the rate
    vec3 friction_mass;   // kg, kg, kg m^2: along the frame's x and y, and about the normal
    float inverse_mass_b;
    vec4 x; // m, from the middle of the points, in the contact's frame
    vec4 y;
    vec4 lever;           // m, the distance from the middle
    vec4 base_separation; // m: separation without what the middle itself contributes
    vec4 normal_mass;     // kg, effective mass along the normal (equation 3.15)
    // What the solver's passes change, from k_first_changing on.
    vec3 friction_impulse; // N s, N s, N m s, accumulated
    float hub_share;       // of a hub's mass, in the colours for hubs
    vec3 slip;             // m: Slip::apart as it was when these impulses acted last (contact.shared.glsl)
    float load_speed;      // m/s: what the normal impulses of the last step do to the relative velocity
    vec4 normal_impulse; // N s, accumulated
    vec4 total_impulse;  // N s, the sum over all sub-steps; once it is stored, with the step's hits
};

const uint k_first_changing = 11u; // its cell, and the passes change all from it on

// 32 bytes, one for each constraint in the colours for hubs: what it does to its hub in a pass.
struct HubChange {
    vec3 linear; // m/s
    uint body;
    vec3 angular; // rad/s
    uint tick;    // of the pass
};

// 16 bytes, one a pair.
struct ContactImpulse {
    vec4 normal_impulse; // N s of each point, the sum over the step, hits included
};

// 112 bytes: a contact event on its way to the host. A vec4 holds a number for each point.
struct ContactReport {
    uint body_a;
    uint body_b;
    uint phase; // k_phase_*
    uint point_count;
    vec3 normal; // unit, world, from A to B
    uint sensor; // 1 where one of the two is a sensor
    vec4 x; // m, world
    vec4 y;
    vec4 z;
    vec4 separation;     // m
    vec4 normal_impulse; // N s
};

// ---- control ----

// 16 bytes: the arguments of an indirect dispatch, and the number of items that they were made from.
struct Dispatch {
    uint groups_x;
    uint groups_y;
    uint groups_z;
    uint items;
};

// 48 bytes: sums over the bodies of one work group (broad phase, axis of largest spread).
struct SpreadSum {
    vec3 centre;
    float count;
    vec3 centre_squared;
    float reserved_1;
    vec3 extent;
    float reserved_2;
};

// 16 bytes: what the sort along one axis needs to know.
struct SweepAxis {
    uint axis;          // 0 x, 1 y, 2 z
    float large_extent; // m: a body longer than this along the axis is tested against all
    uint first_large;   // place in the sorted order from which on bodies are large
    uint end;           // place of the first empty body slot
};

// 32 bytes: what the order of the tree needs to know.
struct TreeGrid {
    vec3 lower;         // m, corner of the first cell
    float inverse_cell; // 1/m
    float small_extent; // m: longer bodies have parts of the order of their own
    uint end;           // place of the first empty body slot
    uint reserved_1;
    uint reserved_2;
};

// The step's constants, 128 bytes: a uniform block in GLSL.
struct Parameters {
    vec3 gravity; // m/s^2
    float inverse_weight; // s/m: 1 / (g dt); makes an impulse over a mass a number of weights
    float dt;     // s, the step
    float inv_dt; // 1/s
    float restitution_threshold; // m/s
    float contact_push_speed;    // m/s
    float contact_frequency; // rad/s, of soft contacts, at most
    float contact_damping_ratio;
    float baumgarte; // 0 for soft contacts
    float linear_slop; // m, overlap that is left alone
    float max_linear_speed;
    float max_angular_speed;
    float speculative_distance; // m
    uint body_count; // body slots in use, holes included
    uint least_substeps;    // of an island
    uint fewest_substeps;   // of a contact in a multirate island
    uint most_substeps;
    uint substep_capacity; // sub-steps that get launches
    uint iterations;
    uint relax; // 1 where a pass without bias ends the step
    uint pair_capacity;
    uint colour_capacity;
    uint table_size; // slots of the pair table, a power of two
    uint usable_colours; // 0 where manifolds are solved one after the other
    uint hub_contacts;   // a body with more manifolds is a hub
    uint hub_capacity;   // manifolds of hubs that there is room for; 0 where hubs have no launches
    uint rest_steps;     // after which a body may sleep; 0 where none ever does
    float rest_distance; // m, from where the rest began; what goes further does not rest
    float rest_way;      // m, in a step; nor does what moves more
    uint manifold_capacity; // of those that are solved
};
