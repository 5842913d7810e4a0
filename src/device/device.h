// SPDX-License-Identifier: MIT
// A device owns the state's buffers and runs kernels on them. Kernels run in the order in which they are given, each
// seeing all that the ones before it wrote. The step knows nothing else of a device.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <talus/world.h>

#include "state/buffers.h"
#include "state/stages.h"

namespace talus::engine {

enum class Role { State, Result, Scratch };

enum class BufferId : uint {
#define X(block, field, element, layout, role) block,
    TALUS_BUFFERS(X)
#undef X
        count
};

struct BufferInfo {
    const char* block;  ///< name of the GLSL block
    const char* field;  ///< name in CpuState
    const char* layout; ///< a letter a word: f float, u uint
    std::size_t stride; ///< bytes of an element
    Role role;
};

inline constexpr std::array<BufferInfo, static_cast<std::size_t>(BufferId::count)> k_buffers{{
#define X(block, field, element, layout, role) {#block, #field, layout, sizeof(element), Role::role},
    TALUS_BUFFERS(X)
#undef X
}};

/// The buffer that a GLSL block is named as; nothing where there is none.
std::optional<BufferId> buffer_of_block(std::string_view block);

/// What the narrow phase finds, and behind it the same of the last step, in the same order.
inline constexpr std::array k_contact_buffers{BufferId::Manifolds, BufferId::ManifoldPoints, BufferId::PointSeparations,
                                              BufferId::PointImpulses};
inline constexpr std::array k_old_contact_buffers{BufferId::OldManifolds, BufferId::OldManifoldPoints,
                                                  BufferId::OldPointSeparations, BufferId::OldPointImpulses};

/// What a step makes one after the other before it has constraints, so that it may all lie at one place: boxes in the
/// order of a search, or a list and what sorts need besides.
inline constexpr std::array k_by_turns{BufferId::TreeNodes, BufferId::SortedAabbs, BufferId::Uncoloured,
                                       BufferId::SwapKeys, BufferId::SwapValues};

/// Of one of the contacts' buffers.
constexpr std::size_t bytes_a_pair(BufferId id) {
    const bool has_points = id == BufferId::ManifoldPoints || id == BufferId::OldManifoldPoints;
    return (has_points ? 4 : 1) * k_buffers[static_cast<std::size_t>(id)].stride;
}

/// Room that contacts are to have; see Device::reserve_contacts.
struct ContactDemand {
    uint pairs = 0;
    uint manifolds = 0;
    uint table_size = 0;    ///< words of PairTable
    uint boxes = 0;         ///< records of TreeNodes, or of SortedAabbs
    uint sorted = 0;        ///< words of SwapKeys, and of SwapValues
    uint fast_words = 0;    ///< words of FastBodies
    uint partners = 0;      ///< the first words of PairTable, which a search has beside its boxes
    bool keeps_old = false; ///< Constraints never lie over the old contacts, as the end of a step reads them
};

/// Where constraints are to lie in the room of contacts.
enum class ConstraintPlace : std::uint8_t { OverOldContacts, OverNewContacts, BesideContacts };

/// A kernel's block and the buffer that it stands for in this launch. Without a binding it stands for the buffer of its
/// name; blocks of primitives have names that are no buffer's, and so always one.
struct Binding {
    const char* block;
    BufferId buffer;
};

struct Launch;
struct CpuState;

/// A compute shader, and the function that does the same work on the CPU.
struct Kernel {
    const char* path; ///< below src/, without .comp.glsl: "broad_phase/update_aabbs"
    void (*twin)(CpuState&, const Launch&);
    uint items_a_group = k_group_size; ///< items that one group treats, for launches that count items
};

/// How often a kernel runs.
struct Launch {
    const Kernel& kernel;
    /// Items, known on the host; or, where `slot` is not k_none, the entry of Dispatches to take the groups from.
    uint items = 0;
    uint slot = k_none;
    /// The uniform `args` of the kernel.
    std::array<uint, 4> args{};
    std::initializer_list<Binding> bindings{};
    /// The next launch touches nothing that this one writes, and may run beside it.
    bool overlaps_next = false;

    BufferId bound(const char* block) const; ///< for twins: the buffer behind a block that may be bound to others
};

/// One step on its way. Tickets count up from 0 for each device.
using Ticket = std::uint64_t;

/// Most steps that may be on their way at once.
inline constexpr std::size_t k_ring_size = 8;

struct ReadRequest {
    BufferId buffer;
    std::size_t bytes;
    void* destination;
};

class Device {
public:
    virtual ~Device() = default;

    virtual DeviceInfo info() const = 0;
    /// Whether a kernel's loops may be long. Mesa's renderers in software end an invocation's loops after 65,535 rounds
    /// in all, without a word.
    virtual bool loops_freely() const { return true; }

    /// How many groups of a kernel run side by side, so that they may wait for each other; 0 where that is not known.
    /// The kernel counts them itself if it includes primitives/grid_barrier.glsl and its args.x is 1.
    virtual uint resident_groups(const Kernel&) { return 0; }

    /// Gives a buffer room for at least `bytes`; the old content stays at its start, the rest is zero.
    virtual void grow(BufferId, std::size_t bytes) = 0;
    virtual std::size_t size(BufferId) const = 0;
    virtual std::uint64_t memory_bytes() const = 0;
    /// After the kernels that were given so far.
    virtual void write(BufferId, std::size_t offset, std::span<const std::byte>) = 0;
    /// Waits for all kernels that were given so far, once for all requests; reads from each buffer's start.
    virtual void read(std::span<const ReadRequest>) = 0;
    virtual void swap(BufferId, BufferId) = 0;

    /// Gives the buffers of contacts, Constraints, FastBodies, PairTable, and those of k_by_turns at least that room,
    /// where a device has one room for all of them; elsewhere FastBodies and those of k_by_turns but Uncoloured wait
    /// for grow(). From then on they grow and are swapped together, and Constraints, with FastBodies behind, may lie
    /// over contacts that nobody wants any more: over the old ones from place_constraints on, and so over the new ones
    /// from swap_contacts on, until kernels write these. PairTable and those of k_by_turns may lie over Constraints, so
    /// that each is there until kernels write the other, and TreeNodes and SortedAabbs over the others of k_by_turns
    /// and over PairTable behind its partners.
    /// Constraints and contacts that they do not lie over keep their content. Old contacts are kept for good once they
    /// are. Not while a step is on its way that may be done again.
    virtual void reserve_contacts(const ContactDemand&);
    /// Kernels that are given from here on write Constraints. Where these lie over the old contacts, those that read
    /// them need keeps_old. Beside contacts there is room for constraints_beside() of them at most.
    virtual void place_constraints(ConstraintPlace) {}
    /// As many constraints as lie over no contacts.
    virtual uint constraints_beside() const { return k_none; }
    /// Whether nothing may have been written over the old contacts.
    virtual bool has_old_contacts() const { return true; }
    /// The new contacts become the old ones, and these make place for new ones.
    virtual void swap_contacts();

    virtual void set_parameters(const Parameters&) = 0;

    /// Makes kernels that will be launched soon ready, side by side where the device can. Waits for none of them.
    virtual void prepare(std::span<const Kernel* const>) {}
    /// Goes on with that, until all are ready or so much time has passed; what is compiled already becomes ready, if
    /// only one of them. Returns whether all are. Throws Error for a faulty one.
    virtual bool make_ready(std::span<const Kernel* const>, std::chrono::milliseconds) { return true; }
    /// Whether the kernel can be launched without waiting until it is ready. Where not, it is on its way, or faulty.
    /// For kernels that a step can do without.
    virtual bool is_ready(const Kernel&) { return true; }
    virtual void run(const Launch&) = 0;
    /// How many launches it has been given, but for those without items.
    std::uint64_t launch_count() const { return launches; }

    /// Marks the start of a stage for profilers and debuggers; the one before it ends.
    virtual void begin_stage(Stage) = 0;
    /// Ends a step: its counters, the poses if asked for, and at most `report_room` of its contact reports leave for
    /// the host. Waits only if k_ring_size steps are on their way already.
    virtual Ticket end_step(bool with_poses, uint report_room = 0) = 0;
    virtual bool finished(Ticket) const = 0;
    virtual void wait(Ticket) = 0;
    /// Of a finished ticket that is among the last k_ring_size.
    virtual std::span<const uint> counters(Ticket) const = 0;
    virtual std::span<const BodyPose> poses(Ticket) const = 0;
    virtual std::span<const ContactReport> reports(Ticket) const = 0;
    /// Milliseconds of each stage of a finished step; empty where profiling is off.
    virtual std::span<const double> stage_ms(Ticket) const = 0;

    /// Gives the caller's OpenGL context back as it was, after launches that no read and no end of a step follows.
    virtual void leave() {}

    /// A buffer's memory where the host may use it directly; null on a GPU.
    virtual std::byte* host_data(BufferId) { return nullptr; }
    /// For drawing without a copy; empty on a device without OpenGL.
    virtual GlRange gl_range(BufferId) const { return {}; }
    virtual void make_current() {}

protected:
    std::uint64_t launches = 0;
};

/// Both throw talus::Error.
std::unique_ptr<Device> make_cpu_device(std::uint32_t threads, bool profile);
std::unique_ptr<Device> make_gl_device(GlContext, bool profile, bool debug = false, bool program_cache = true);

/// The GPUs that there are: first the one that make_gl_device(GlContext::Own) would take, last those that cannot be
/// used, with an empty name and the reason in `why`.
std::vector<DeviceInfo> probe_gl();

} // namespace talus::engine
