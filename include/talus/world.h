// SPDX-License-Identifier: MIT
// The world: bodies go in, time moves on, poses come out.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <talus/settings.h>
#include <talus/types.h>

namespace talus {

/// Counts and times of one finished step.
struct StepReport {
    std::uint64_t step = 0; ///< how many steps the world had made with this one
    std::uint32_t pairs = 0;
    std::uint32_t manifolds = 0;
    std::uint32_t contacts = 0;           ///< contact points
    std::uint32_t colours = 0;            ///< batches of the constraint graph
    std::uint32_t substeps = 0;           ///< most that an island had
    std::uint32_t overflow_manifolds = 0; ///< without a colour, solved one at a time
    std::uint32_t hubs = 0;          ///< bodies with so many contacts that each is solved with a share of their mass
    std::uint32_t frozen_bodies = 0; ///< bodies whose velocity became non-finite, in all steps so far
    std::uint32_t growths = 0;       ///< steps done again with larger buffers or more launches, so far
    std::uint32_t dispatches = 0;    ///< launches of kernels that the host gave
    double step_ms = 0.0;            ///< time on the device; 0 where it was not measured (see WorldOptions::profile)
    std::vector<double> stage_ms;    ///< one a stage, in the order of stage_names(); empty unless profiled
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
    std::uint64_t device = 0;
    std::uint64_t host = 0;
};

/// What has gone between host and device for the bodies' records, in all so far. Adding, removing and changing bodies
/// costs bytes for what changes; reading a pose or a velocity after a step reads those of all bodies.
struct Transfers {
    std::uint64_t to_device = 0; ///< bytes
    std::uint64_t to_host = 0;   ///< bytes; without the poses that keep_poses_coming() asks for
    std::uint64_t waits = 0;     ///< calls that had to wait for steps on their way
};

/// OpenGL names of the buffers to draw from, without a copy. Valid until the next call that changes the world.
/// Poses: 32 bytes a body: vec3 position, uint flags, vec4 rotation (x, y, z, w).
/// Shapes: 16 bytes a body: vec3 half extents, uint word with the shape in bits 0–7 (0 box, 1 sphere) and the body's
/// kind in bits 8–15 (0 static, 1 rigid, 2 kinematic, 255 no body here).
/// Pairs: 8 bytes a pair: uint body a, uint body b; their number is the word `pair_count_word` of Counters.
/// Manifolds: see src/state/records.shared.glsl.
struct GlBuffers {
    std::uint32_t poses = 0;
    std::uint32_t shapes = 0;
    std::uint32_t aabbs = 0; ///< 32 bytes a body: vec3 lower, float, vec3 upper, float
    std::uint32_t pairs = 0;
    std::uint32_t manifolds = 0;
    std::uint32_t contact_points = 0;
    std::uint32_t counters = 0;
    std::uint32_t body_capacity = 0; ///< instances to draw; unused ones have the kind 255
    std::uint32_t pair_capacity = 0;
};

/// A world of bodies. Calls may come from several threads, one at a time: whoever lets two of them overlap has to lock.
/// (A world in the caller's own OpenGL context stays with the thread that has the context.)
///
/// `step` on a GPU returns before the GPU has finished; several steps may be on their way. Adding and removing bodies
/// and changing a material, a gravity scale or a force waits for none of them. Calls that read results wait first, and
/// so do those that change a pose or a velocity, which start from what it is.
class World {
public:
    /// Throws Error where the device cannot be had; the message lists what was tried.
    explicit World(const Settings& settings = {}, const WorldOptions& options = {});
    ~World();
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;

    // ---- bodies ----

    /// Throws Error for a non-finite number, a size, mass or inertia that is not positive, or a bad material.
    BodyId add(const BodyDefinition&);
    /// All or none: an error leaves the world as it was and names the position in the list.
    std::vector<BodyId> add(std::span<const BodyDefinition>);
    void remove(BodyId);
    bool contains(BodyId) const noexcept;
    std::size_t body_count() const noexcept;
    /// The bodies that are there, in the order of their index.
    std::vector<BodyId> bodies() const;
    BodyKind kind(BodyId) const;
    Shape shape(BodyId) const;
    float mass(BodyId) const;   ///< kg; infinity for static and kinematic bodies
    Vec3 inertia(BodyId) const; ///< principal moments, kg·m²

    Pose pose(BodyId) const;
    void set_pose(BodyId, const Pose&);
    Velocity velocity(BodyId) const;
    void set_velocity(BodyId, const Velocity&);
    /// In the order of `bodies()`.
    std::vector<Pose> poses() const;
    std::vector<Velocity> velocities() const;

    /// N, at the centre of mass or at a point in world space; acts during the next step, adds up until then.
    void add_force(BodyId, Vec3 force);
    void add_force(BodyId, Vec3 force, Vec3 point);
    void add_torque(BodyId, Vec3 torque); ///< N·m
    /// N·s; changes the velocity at once.
    void add_impulse(BodyId, Vec3 impulse);
    void add_impulse(BodyId, Vec3 impulse, Vec3 point);
    void add_angular_impulse(BodyId, Vec3 impulse); ///< N·m·s

    float gravity_scale(BodyId) const;
    void set_gravity_scale(BodyId, float);
    Material material(BodyId) const;
    void set_material(BodyId, const Material&);

    // ---- time ----

    void step(std::uint32_t count = 1);
    /// Waits until every step that was asked for is done.
    void wait() const;
    std::uint64_t step_count() const noexcept;

    // ---- results of the last step (they wait for it) ----

    std::vector<CollisionPair> collision_pairs() const; ///< sorted by index
    std::vector<Contact> contacts() const;              ///< sorted by index
    StepReport report() const;
    /// 64-bit hash of all poses and velocities in the order of `bodies()`: equal where the bits are equal.
    std::uint64_t state_hash() const;

    // ---- results without waiting ----

    /// The newest finished step's poses as they left through the ring of mapped buffers, and the number of that step;
    /// empty before the first one arrives, and again while a step is done anew with larger buffers.
    /// `keep_poses_coming(true)` turns the ring on.
    struct PoseFrame {
        std::uint64_t step = 0;
        std::vector<BodyId> bodies; ///< those that were there in that step and still are
        std::vector<Pose> poses;    ///< one each
    };
    void keep_poses_coming(bool);
    PoseFrame newest_poses() const;

    // ---- the rest ----

    const Settings& settings() const noexcept;
    void set_settings(const Settings&);
    const DeviceInfo& device() const noexcept;
    MemoryUse memory() const noexcept;
    Transfers transfers() const noexcept;
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
std::span<const char* const> stage_names() noexcept;

/// Every device that a world could run on here, and those that cannot be used with the reason in `why`.
std::vector<DeviceInfo> list_devices();

} // namespace talus
