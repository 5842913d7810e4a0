// SPDX-License-Identifier: MIT
// What a caller can choose about a world.
#pragma once

#include <cstdint>
#include <string>

#include <talus/types.h>

namespace talus {

/// Where the step runs.
enum class DeviceKind : std::uint32_t {
    Auto,   ///< the GPU where there is a real one, otherwise the CPU
    Gpu,    ///< the whole step in OpenGL compute shaders
    Cpu,    ///< the whole step on the CPU's threads
    Hybrid, ///< broad and narrow phase on the GPU, resolution on the CPU
};

/// Which OpenGL context the GPU device uses.
enum class GlContext : std::uint32_t {
    /// One of its own, headless through EGL; no window system needed. After each call the thread has current what EGL
    /// had current on it before, so a renderer's context is safe, and another thread may make the next call. A context
    /// of GLX must not be current: EGL cannot put it back.
    Own,
    Current, ///< the caller's, current on the calling thread now and in every later call on the world
};

/// How the broad phase finds pairs.
enum class BroadPhase : std::uint32_t {
    Auto,          ///< what is fastest: sweep and prune up to 1,024 body slots, the tree above
    SweepAndPrune, ///< sort along the axis of largest spread, then sweep (thesis, section 3.2)
    Bvh,           ///< sort along a Hilbert curve, then search a tree of bounding boxes over that order
    Brute,         ///< every pair (thesis, algorithm 1): the oracle
};

/// How overlap is undone.
enum class Stabilisation : std::uint32_t {
    Soft,      ///< sub-steps with soft contacts and a relax pass
    Baumgarte, ///< one step, many iterations, velocity bias β/Δt · d (thesis, equation 3.17)
};

/// In what order a pass of the solver goes through the contacts.
enum class SolveOrder : std::uint32_t {
    Coloured,   ///< batches of manifolds that share no body, each solved side by side
    Sequential, ///< one manifold after the other, as their pairs were found (thesis, section 3.4): for comparison; slow
};

/// What may change while a world runs.
struct Settings {
    Vec3 gravity{0.0f, -9.81f, 0.0f};                  ///< m/s²
    float dt = 1.0f / 60.0f;                           ///< s, the length of one step
    Stabilisation stabilisation = Stabilisation::Soft; ///< how overlap is undone
    /// Soft: sub-steps a step, at least; but contacts of a heap of more than 65,535 bodies that may not sleep have half
    /// of an even number if they need no more (docs/solver.md, Large islands). Not used by Baumgarte.
    std::uint32_t substeps = 8;
    std::uint32_t max_substeps = 128;   ///< soft: the most that an island gets whose bodies carry heavy loads
    std::uint32_t iterations = 1;       ///< solver passes: a sub-step (soft) or a step (Baumgarte; set about 10 there)
    float contact_hertz = 1000.0f;      ///< soft: stiffness of a contact, Hz; capped at an eighth of the sub-step rate
    float contact_damping_ratio = 5.0f; ///< soft: damping of a contact
    float contact_push_speed = 3.0f;    ///< m/s; the fastest that two bodies that overlap are pushed apart
    float baumgarte = 0.2f;             ///< β of equation 3.17, 0 to 1
    float restitution_threshold = 1.0f; ///< m/s; slower impacts do not bounce
    float max_linear_speed = 500.0f;    ///< m/s; forces and contacts make no body faster
    float max_angular_speed = 200.0f;   ///< rad/s
    BroadPhase broad_phase = BroadPhase::Auto;     ///< how pairs are found
    SolveOrder solve_order = SolveOrder::Coloured; ///< in what order contacts are solved
    std::uint32_t hub_contacts = 0; ///< a body with more is solved by shares of its mass: fast, and softer; 0: more
                                    ///< than 1,000 in a world of up to 1,024 body slots, more than 32 in a larger one
    float sleep_speed = 0.01f;      ///< m/s; a body rests where it gets nowhere faster on average, though it may jitter
    float sleep_time = 0.5f;        ///< s; an island sleeps once all its bodies have rested for so long; of one of more
                                    ///< than 1,024 a body, once it has and nothing restless has touched it for as long
    bool sleeping = false; ///< whether islands at rest, and parts of very large ones, sleep until something touches
                           ///< them: they cost next to nothing

    /// Whether every setting is the same.
    bool operator==(const Settings&) const = default;
};

/// How many of each thing the first buffers have room for; 0 leaves it to Talus. They grow as needed, so this only
/// saves the growing.
struct Capacities {
    std::uint32_t bodies = 0;  ///< at most 16,777,216
    std::uint32_t pairs = 0;   ///< at most 268,435,456
    std::uint32_t colours = 0; ///< at most 64; two of them are for hubs and are always there
};

/// Which contact events a world collects.
enum class ContactWatch : std::uint32_t {
    None,    ///< none, which costs nothing
    Changes, ///< begins and ends
    All,     ///< also, in each step, every contact that persists
};

/// What is fixed when a world is made.
struct WorldOptions {
    DeviceKind device = DeviceKind::Auto;  ///< where the step runs
    GlContext gl_context = GlContext::Own; ///< which context the GPU is used through
    std::uint32_t threads = 0; ///< of the CPU, for its parts of steps and for many new bodies; 0: all it has
    bool profile = false;      ///< measure every stage (see StepReport::stage_ms); costs a little time
    /// A debug context where it is Talus's own: the driver's messages go to the log, with the stage that they come
    /// from. The environment variable TALUS_GL_DEBUG=1 asks for it too. In the caller's context they go where the
    /// caller sends them; the stages are debug groups there.
    bool gl_debug = false;
    /// Keep the kernels' compiled programs in the user's cache folder ($XDG_CACHE_HOME or ~/.cache, talus/), so that
    /// later worlds start at once. The environment variable TALUS_PROGRAM_CACHE=0 turns it off too.
    bool program_cache = true;
    /// Wait for all kernels before the first step, ten seconds or more on some drivers where no programs are kept. Else
    /// the CPU makes the first steps, unless there are very many bodies for its threads, and the GPU goes on with what
    /// is compiled sooner, a launch for each colour and pass: the same bits, and slower (StepReport::device,
    /// StepReport::dispatches). For measuring, and for a GPU whose bits are not the CPU's (`talus parity`).
    bool wait_for_kernels = false;
    Capacities capacities; ///< how large buffers are at first
};

} // namespace talus
