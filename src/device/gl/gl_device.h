// SPDX-License-Identifier: MIT
// The device that runs the kernels as OpenGL compute shaders. Everything stays on the GPU: nothing here waits for it
// but `read`, `wait`, and `end_step` where the host is k_ring_size steps ahead.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "device/device.h"
#include "device/gl/contact_room.h"
#include "device/gl/gl_bindings.h"
#include "device/gl/gl_context.h"
#include "device/gl/gl_program.h"
#include "device/gl/gl_step_ring.h"
#include "device/gl/gl_transfer.h"

namespace talus::engine {

/// Of the context, which has to be current. Throws Error where TALUS_RESIDENT_GROUPS is no number.
KernelTarget find_kernel_target(const OpenGlContext&);

class GlDevice final : public Device {
public:
    GlDevice(std::unique_ptr<OpenGlContext>, bool profile, bool program_cache);
    ~GlDevice() override;

    DeviceInfo info() const override { return context_->info(); }
    bool loops_freely() const override { return !context_->is_software(); }
    uint resident_groups(const Kernel&) override;
    void grow(BufferId, std::size_t bytes) override;
    std::size_t size(BufferId) const override;
    std::uint64_t memory_bytes() const override;
    void write(BufferId, std::size_t offset, std::span<const std::byte>) override;
    void read(std::span<const ReadRequest>) override;
    void swap(BufferId, BufferId) override;
    void reserve_contacts(const ContactDemand&) override;
    void place_constraints(ConstraintPlace) override;
    uint constraints_beside() const override;
    bool has_old_contacts() const override;
    void swap_contacts() override;
    void set_parameters(const Parameters&) override;
    void prepare(std::span<const Kernel* const>) override;
    bool make_ready(std::span<const Kernel* const>, std::chrono::milliseconds) override;
    /// A kernel that turns out to be faulty never is, and the log says so once.
    bool is_ready(const Kernel&) override;
    void run(const Launch&) override;
    void leave() override;
    void begin_stage(Stage) override;
    Ticket end_step(bool with_poses, uint report_room) override;
    bool finished(Ticket) const override;
    void wait(Ticket) override;
    std::span<const uint> counters(Ticket) const override;
    std::span<const BodyPose> poses(Ticket) const override;
    std::span<const ContactReport> reports(Ticket) const override;
    std::span<const double> stage_ms(Ticket) const override;
    GlRange gl_range(BufferId) const override;
    void make_current() override;

private:
    /// Everything that lives in the context.
    struct Objects {
        Objects(bool profile, bool program_cache);

        std::array<GlBuffer, k_buffers.size()> buffers; // those in the room have none of their own
        std::optional<ContactRoom> room;
        GlBuffer contacts; // the room's
        GlBuffer parameters;
        GlBuffer no_groups; // the arguments of an indirect launch that does nothing
        ProgramCache cache;
        std::unordered_map<std::string, GlProgram> programs;
        UploadRing uploads;
        ReadBack read_back;
        StepRing steps;
    };

    bool is_in_room(BufferId) const;
    /// One that is not in the room of contacts.
    GlBuffer& buffer(BufferId) const;
    /// Throws Error where the driver does not let a kernel see so many bytes of it.
    void check_block_size(BufferId, std::size_t bytes) const;
    /// The kernel's program, perhaps unfinished.
    GlProgram& begun_program(const Kernel&);
    GlProgram& program(const Kernel&);
    /// Some drivers make the machine's code of a program from the cache only when it is launched for the first time.
    void launch_nothing(const GlProgram&);
    /// While one is still compiled: some drivers make the machine's code only when the program is first asked for, on
    /// this thread. Naps where none is ready.
    void finish_another();
    /// Of a kernel that nobody waits for: false where it is faulty, which those who run it are told.
    bool finish_unneeded(GlProgram&);
    /// Those too that have never run: the next start begins with them again. Waits for the compiler.
    void keep_programs();
    void run_kernel(const Launch&);
    void check_range(BufferId, std::size_t end, const char* what) const;
    /// Lets copies see what kernels wrote.
    void order_after_kernels();
    void end_stage();

    std::unique_ptr<OpenGlContext> context_;
    std::unique_ptr<Objects> objects_;
    GlBindings bindings_;
    std::optional<Parameters> parameters_;
    std::optional<uint> most_resident_groups_;                // what the environment says
    std::unordered_map<const Kernel*, uint> resident_groups_; // of kernels that were asked for
    std::unordered_set<const Kernel*> faulty_;                // of those that steps can do without
    std::size_t max_block_bytes_ = 0;
    KernelTarget kernel_target_;
    bool kernels_pending_ = false; // ran since the last order_after_kernels
    bool in_stage_ = false;
};

} // namespace talus::engine
