// SPDX-License-Identifier: MIT
// The world: bodies go in, time moves on, poses come out.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <talus/export.h>
#include <talus/settings.h>
#include <talus/snapshot.h>
#include <talus/types.h>

namespace talus {

/// Counts and times of one finished step.
struct StepReport {
    std::uint64_t step = 0;               ///< how many steps the world had made with this one
    DeviceKind device = DeviceKind::Auto; ///< that made it: the Cpu also while a GPU's kernels are being compiled (see
                                          ///< WorldOptions::wait_for_kernels); Auto before the first step, and where
                                          ///< a snapshot comes from a file
    std::uint32_t pairs = 0;              ///< of bodies that may touch, as no face keeps them apart; with a skin of
                                          ///< up to 2.5 mm, when they were last searched
    std::uint32_t manifolds = 0;          ///< pairs that touch, or are about to; without those of sensors
    std::uint32_t contacts = 0;           ///< contact points
    std::uint32_t colours = 0;            ///< batches of the constraint graph, from the ground's on, which may be empty
    std::uint32_t substeps = 0;           ///< most that a contact asked for
    std::uint32_t overflow_manifolds = 0; ///< without a colour, solved one at a time
    std::uint32_t hubs = 0;            ///< bodies with so many contacts that most are solved with a share of their mass
    std::uint32_t frozen_bodies = 0;   ///< bodies whose velocity became non-finite, in all steps so far
    std::uint32_t sleeping_bodies = 0; ///< see Settings::sleeping
    /// Steps done again with larger buffers or more launches, so far; not for a search or a graph.
    std::uint32_t growths = 0;
    std::uint32_t dispatches = 0;              ///< launches of kernels that the host gave
    BroadPhase broad_phase = BroadPhase::Auto; ///< what searches for pairs; Auto before the first step
    double step_ms = 0.0;         ///< time on the device; 0 where it was not measured (see WorldOptions::profile)
    std::vector<double> stage_ms; ///< one a stage, in the order of stage_names(); empty unless profiled
};

/// What runs the step, in words for people.
struct DeviceInfo {
    DeviceKind kind = DeviceKind::Cpu; ///< never Auto
    std::string name;                  ///< the GPU's or the CPU's own name
    std::string driver;                ///< OpenGL version and driver; for the CPU the compiler
    std::string why;                   ///< why this device was taken
    std::uint32_t threads = 0;         ///< of the CPU device; 0 where it takes no part
    bool in_software = false;          ///< OpenGL without a GPU, as by llvmpipe: right, and slow
};

/// Bytes that the world holds now.
struct MemoryUse {
    std::uint64_t device = 0; ///< in the buffers of the device or devices
    std::uint64_t host = 0;   ///< in the table of bodies
};

/// What has gone between host and device for the bodies' records, in all so far. Adding, removing and changing bodies
/// costs bytes for what changes; reading a pose or a velocity after a step reads those of all bodies.
struct Transfers {
    std::uint64_t to_device = 0; ///< bytes
    std::uint64_t to_host = 0;   ///< bytes; without the poses that keep_poses_coming() asks for
    std::uint64_t waits = 0;     ///< calls that had to wait for steps on their way
};

/// A part of an OpenGL buffer, as glBindBufferRange takes it.
struct GlRange {
    std::uint32_t buffer = 0; ///< its name
    std::uint64_t offset = 0; ///< bytes, where a storage block may begin on every driver
    std::uint64_t size = 0;   ///< bytes that there is room for
    friend bool operator==(const GlRange&, const GlRange&) = default; ///< The same part of the same buffer.
};

/// OpenGL names of the buffers to draw from, without a copy. Valid until the next call that changes the world. Numbers
/// are little-endian words of 32 bits. What is of contacts lies in one buffer, one behind the other.
struct GlBuffers {
    /// 32 bytes a body: vec3 position (m), uint flags, of which bit 2 is set while the body sleeps, vec4 rotation (x,
    /// y, z, w).
    std::uint32_t poses = 0;
    /// 16 bytes a body: vec3 position (m), uint; where the body was at the start of the last step, and its turn in it.
    std::uint32_t starts = 0;
    /// 16 bytes a body: vec3 half extents (m), uint word with the shape in bits 0–7 (0 box, 1 sphere), the body's kind
    /// in bits 8–15 (0 static, 1 rigid, 2 kinematic, 255 no body here), and bit 16 set for a sensor.
    std::uint32_t shapes = 0;
    /// 32 bytes a body: vec3 lower (m), float, vec3 upper (m), float; of the last search for pairs, with its skin.
    std::uint32_t aabbs = 0;
    /// 8 bytes a pair: uint body a, uint body b; their number is the word `pair_count_word` of `counters`.
    std::uint32_t pairs = 0;
    GlRange manifolds; ///< 64 bytes a pair, see Manifold in src/state/records.shared.glsl
    /// Four of 16 bytes a pair, see ManifoldPoint in the same file: an anchor leads from body a's place in `starts` to
    /// the point.
    GlRange contact_points;
    GlRange point_separations;                          ///< 32 bytes a pair, see Separations in the same file
    GlRange point_impulses;                             ///< 16 bytes a pair, see NormalImpulses in the same file
    std::uint32_t counters = 0;                         ///< words, see k_counter_* in src/state/constants.shared.glsl
    std::uint32_t body_capacity = 0;                    ///< instances to draw; unused ones have the kind 255
    std::uint32_t pair_capacity = 0;                    ///< pairs of the last step
    static constexpr std::uint32_t pair_count_word = 2; ///< of `counters`
};

/// A world of bodies. Calls may come from several threads, one at a time: whoever lets two of them overlap has to lock.
/// (A world in the caller's own OpenGL context stays with the thread that has the context.)
///
/// `step` on a GPU returns before the GPU has finished; several steps may be on their way. Adding and removing bodies
/// and changing a material, a gravity scale or a force waits for none of them. (Adding does where contacts are
/// watched.) Calls that read results wait first, and so do those that change a pose or a velocity, which start from
/// what it is.
class TALUS_API World {
public:
    /// Throws Error where the device cannot be had; the message lists what was tried.
    explicit World(const Settings& settings = {}, const WorldOptions& options = {});
    /// Waits for the steps on their way, and where compiled kernels are kept (WorldOptions::program_cache) for those
    /// that the driver is still compiling.
    ~World();
    /// The world that was moved from is good for nothing but its destructor and being assigned to.
    World(World&&) noexcept;
    /// The world that was here before goes.
    World& operator=(World&&) noexcept;

    // ---- bodies ----

    /// Throws Error for a non-finite number, a size, mass or inertia that is not positive, or a bad material.
    BodyId add(const BodyDefinition&);
    /// All or none: an error leaves the world as it was and names the position in the list.
    std::vector<BodyId> add(std::span<const BodyDefinition>);
    /// The body's contacts end with the next step. Throws Error where there is no such body, as all calls below do that
    /// name one.
    void remove(BodyId);
    /// Whether there is such a body. Never throws.
    bool contains(BodyId) const noexcept;
    /// How many bodies there are.
    std::size_t body_count() const noexcept;
    /// The bodies that are there, in the order of their index.
    std::vector<BodyId> bodies() const;
    /// As the body's definition said.
    BodyKind kind(BodyId) const;
    /// As the body's definition said.
    Shape shape(BodyId) const;
    float mass(BodyId) const;   ///< kg; infinity for static and kinematic bodies
    Vec3 inertia(BodyId) const; ///< principal moments, kg·m²

    /// After the last step; waits for it.
    Pose pose(BodyId) const;
    /// Puts a body elsewhere, without a way between. Throws Error for a non-finite or too large coordinate, or a
    /// rotation that is no unit quaternion.
    void set_pose(BodyId, const Pose&);
    /// After the last step; waits for it.
    Velocity velocity(BodyId) const;
    /// Throws Error for a non-finite number, and for a static body.
    void set_velocity(BodyId, const Velocity&);
    /// In the order of `bodies()`; waits for the last step.
    std::vector<Pose> poses() const;
    /// In the order of `bodies()`; waits for the last step.
    std::vector<Velocity> velocities() const;

    /// N, at the centre of mass; acts during the next step, adds up until then. Throws Error for a body that is not
    /// rigid, as all of these do.
    void add_force(BodyId, Vec3 force);
    /// N, at a point in world space (m): turns the body too.
    void add_force(BodyId, Vec3 force, Vec3 point);
    void add_torque(BodyId, Vec3 torque); ///< N·m; acts during the next step, adds up until then
    /// N·s, at the centre of mass; changes the velocity at once.
    void add_impulse(BodyId, Vec3 impulse);
    /// N·s, at a point in world space (m): turns the body too.
    void add_impulse(BodyId, Vec3 impulse, Vec3 point);
    void add_angular_impulse(BodyId, Vec3 impulse); ///< N·m·s; changes the angular velocity at once

    /// Whether a body slept in the last step (see Settings::sleeping); waits for it. Only rigid bodies ever do.
    bool is_asleep(BodyId) const;
    /// Wakes a body and what touches it: with the next step they begin their rest anew, and so their island is awake,
    /// or what is near in one of more than 1,024 bodies. All calls that change a body do so. Without effect where all
    /// is awake.
    void wake(BodyId);

    /// Factor on the world's gravity.
    float gravity_scale(BodyId) const;
    /// Throws Error for a non-finite number.
    void set_gravity_scale(BodyId, float);
    /// As the definition or `set_material` said.
    Material material(BodyId) const;
    /// Acts from the next step on. Throws Error for a value that is not allowed.
    void set_material(BodyId, const Material&);
    /// As the definition or `set_sensor` said.
    bool is_sensor(BodyId) const;
    /// A sensor reports what it touches, and neither pushes nor is pushed by it. Sensors do not see each other, and two
    /// bodies of which neither moves report nothing. What crosses a sensor within a single step may pass unseen.
    void set_sensor(BodyId, bool);

    // ---- time ----

    /// Makes `count` steps of Settings::dt each. Returns before a GPU has finished them. Throws Error where there is no
    /// memory for the buffers that the steps need; the world is then as it was before the first that did not fit.
    void step(std::uint32_t count = 1);
    /// Waits until every step that was asked for is done.
    void wait() const;
    /// How many steps were asked for since the world was made.
    std::uint64_t step_count() const noexcept;

    /// The world as it is now, waiting for its last step. On a GPU it is copied to the host.
    Snapshot snapshot() const;
    /// Makes the world what it was in a snapshot, of this world or of another, on whatever device that ran. Steps from
    /// here on give the same bits as they did there. Bodies that were added since are gone; those that were removed
    /// are there again, under their old ids. With a snapshot of another world come that world's bodies and ids, in the
    /// place of all that were here. Contact events that were not taken yet are gone with their steps. What gl_buffers()
    /// names has the restored state, but for the AABBs, which the next step makes. Throws Error where there is no room
    /// for it.
    void restore(const Snapshot&);

    // ---- results of the last step (they wait for it) ----

    /// Those of StepReport::pairs, sorted by index.
    std::vector<CollisionPair> collision_pairs() const;
    std::vector<Contact> contacts() const; ///< sorted by index
    /// Counts and times.
    StepReport report() const;
    /// 64-bit hash of all poses and velocities in the order of `bodies()`: equal where the bits are equal.
    std::uint64_t state_hash() const;

    // ---- contact events ----

    /// Which events the steps from now on collect; None at first. The first step after None reports all contacts that
    /// it finds as begun. Waits for the steps on their way.
    void watch_contacts(ContactWatch);
    /// All events since the last call of either function, in the order of steps, and in each step of the bodies'
    /// indices. Waits for the last step. None is ever left out; until they are taken they stay in the host's memory.
    /// Only restore() drops what has not been taken: it belongs to steps that are undone.
    std::vector<ContactEvent> take_contact_events();
    /// The same without waiting: those of the steps that are finished by now.
    std::vector<ContactEvent> take_finished_contact_events();

    // ---- results without waiting ----

    /// A finished step's poses, as they left through the ring of mapped buffers.
    struct PoseFrame {
        std::uint64_t step = 0;     ///< which step's, as step_count() counts
        std::vector<BodyId> bodies; ///< those that were there in that step and still are
        std::vector<Pose> poses;    ///< one each
    };
    /// Whether the steps from now on send their poses; not at first.
    void keep_poses_coming(bool);
    /// Those of the newest finished step; empty before the first one arrives, and again while a step is done anew with
    /// larger buffers, or with a search for pairs or a constraint graph that it was not expected to need.
    PoseFrame newest_poses() const;

    // ---- the rest ----

    /// As they were given last.
    const Settings& settings() const noexcept;
    /// For the steps from now on. Throws Error for a value that is not allowed.
    void set_settings(const Settings&);
    /// What the world runs on.
    const DeviceInfo& device() const noexcept;
    /// Grows with the number of bodies and pairs.
    MemoryUse memory() const noexcept;
    /// What changes of bodies, and reading them, have cost so far.
    Transfers transfers() const noexcept;
    /// The names are good until the next call that changes the world or makes a step. Waits for the last step.
    /// Throws Error on the CPU device, which has none.
    GlBuffers gl_buffers() const;
    /// Makes the world's own OpenGL context current on this thread (GPU and hybrid), for drawing from its buffers. It
    /// stays current: calls on this thread save changing contexts, those on other threads are refused until something
    /// else, or nothing, is made current here.
    void make_gl_current() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The stages of a step in run order: the rows of StepReport::stage_ms.
TALUS_API std::span<const char* const> stage_names() noexcept;

/// Every device that a world could run on here, and those that cannot be used with the reason in `why`.
TALUS_API std::vector<DeviceInfo> list_devices();

} // namespace talus
