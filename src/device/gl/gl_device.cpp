// SPDX-License-Identifier: MIT
// See gl_device.h. OpenGL runs commands in order, but lets the writes of shaders be seen late; the barriers here are
// those that the contract of device.h needs, and no others.
#include "device/gl/gl_device.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "device/gl/callers_context.h"
#include "device/gl/kernel_source.h"
#include "device/gl/record_blocks.h"
#include "log.h"

namespace talus::engine {
namespace {

constexpr uint k_max_groups = 65535; // of one dimension, on every driver

/// `bytes` and what is missing to a whole number of parts.
std::size_t whole(std::size_t part, std::size_t bytes) {
    return (bytes + part - 1) / part * part;
}

const BufferInfo& buffer_info(BufferId id) {
    return k_buffers[static_cast<std::size_t>(id)];
}

void dispatch_groups(uint groups) {
    const uint rows = (groups + k_max_groups - 1) / k_max_groups;
    glDispatchCompute((groups + rows - 1) / rows, rows, 1);
}

/// While the compiler works.
void nap() {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

// More than any GPU runs at a time of a kernel that needs all registers.
constexpr uint k_trial_groups = 4096;

/// TALUS_RESIDENT_GROUPS=n says how many groups may wait for each other at most, and 0 that nothing may but at
/// barriers.
std::optional<uint> resident_groups_of_environment() {
    const char* value = std::getenv("TALUS_RESIDENT_GROUPS");
    if (value == nullptr) return std::nullopt;
    uint groups = 0;
    const char* const end = value + std::strlen(value);
    const auto [rest, error] = std::from_chars(value, end, groups);
    if (error != std::errc() || rest != end || groups > k_trial_groups)
        throw Error("TALUS_RESIDENT_GROUPS is '" + std::string(value) + "'; it has to be a number from 0 to " +
                    std::to_string(k_trial_groups));
    return groups;
}

/// Of a kernel that solves islands, with k_waits_freely: what it keeps of a body, and some more.
constexpr int k_shared_bytes_to_wait = 44 * 1024;
static_assert(k_shared_bytes_to_wait >= k_shared_places * 28 + (k_island_bodies + 1) * 4 + 2048 &&
              k_shared_places > k_island_bodies && k_most_single <= k_island_bodies);

} // namespace

KernelTarget find_kernel_target(const OpenGlContext& context) {
    GLint shared_bytes = 0;
    glGetIntegerv(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE, &shared_bytes);
    KernelTarget target;
    target.waits_freely =
        !context.is_software() && resident_groups_of_environment() != 0u && shared_bytes >= k_shared_bytes_to_wait;
    // All GPUs of this vendor have this number. Drivers of others may compile a kernel for more than they tell.
    if (context.info().driver.find("NVIDIA") != std::string::npos) target.in_step = 32;
    return target;
}

GlDevice::Objects::Objects(bool profile, bool program_cache)
    : parameters("Parameters", sizeof(Parameters)), no_groups("NoGroups", sizeof(Dispatch)), cache(program_cache),
      steps(profile) {
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        // Never empty, so that every buffer can be bound.
        const std::size_t bytes = whole(k_cell_bytes, element_bytes(static_cast<BufferId>(i)));
        buffers[i] = GlBuffer(k_buffers[i].block, bytes);
        uploads.zero(buffers[i]);
    }
    uploads.zero(parameters);
    uploads.zero(no_groups);
}

GlDevice::GlDevice(std::unique_ptr<OpenGlContext> context, bool profile, bool program_cache)
    : context_(std::move(context)), most_resident_groups_(resident_groups_of_environment()) {
    context_->make_current();
    GLint64 bytes = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &bytes);
    max_block_bytes_ = static_cast<std::size_t>(bytes);
    kernel_target_ = find_kernel_target(*context_);
    if (context_->is_own()) compile_side_by_side(); // of the caller's context it is a setting
    objects_ = std::make_unique<Objects>(profile, program_cache);
}

GlDevice::~GlDevice() {
    const CallersContext callers(context_->is_own());
    try {
        context_->make_current();
        leave();
        keep_programs();
        objects_.reset();
    } catch (const Error&) {
        // The caller's context is gone or elsewhere: freeing names now could hit another context's objects, and its own
        // went with it.
        static_cast<void>(objects_.release());
    }
}

uint GlDevice::resident_groups(const Kernel& kernel) {
    if (!loops_freely() || most_resident_groups_ == 0u) return 0;
    const auto found = resident_groups_.find(&kernel);
    if (found != resident_groups_.end()) return found->second;
    std::array<uint, k_arrival_words> arrivals{};
    grow(BufferId::Arrivals, sizeof arrivals); // a device by itself has no room yet
    write(BufferId::Arrivals, 0, std::as_bytes(std::span(arrivals)));
    run({.kernel = kernel, .items = k_trial_groups * kernel.items_a_group, .args = {1}});
    read(std::array{ReadRequest{BufferId::Arrivals, sizeof arrivals, arrivals.data()}});
    return resident_groups_[&kernel] = std::min(arrivals[1], most_resident_groups_.value_or(k_trial_groups));
}

void GlDevice::grow(BufferId id, std::size_t bytes) {
    if (bytes <= size(id)) return;
    TALUS_ASSERT(!is_in_room(id), "a buffer of contacts was to grow without the others");
    GlBuffer& old = buffer(id);
    const std::size_t wanted = whole(lies_in_blocks(id) ? element_bytes(id) : k_cell_bytes, bytes);
    check_block_size(id, wanted);
    make_current();
    order_after_kernels();
    GlBuffer grown(buffer_info(id).block, wanted);
    glCopyNamedBufferSubData(old.name(), grown.name(), 0, 0, static_cast<GLsizeiptr>(old.size()));
    objects_->uploads.zero(grown, old.size());
    old = std::move(grown);
    bindings_.forget();
}

void GlDevice::check_block_size(BufferId id, std::size_t bytes) const {
    if (bytes > max_block_bytes_)
        throw Error(std::string("buffer ") + buffer_info(id).block + ": " + std::to_string(bytes) +
                    " bytes are needed, and " + context_->renderer() + " allows a buffer of " +
                    std::to_string(max_block_bytes_) + " bytes at most");
}

void GlDevice::reserve_contacts(const ContactDemand& demand) {
    std::optional<ContactRoom>& room = objects_->room;
    const ContactRoom wanted = room ? room->grown(demand) : ContactRoom(demand);
    for (const BufferId id : k_room_buffers)
        check_block_size(id, wanted.place(id).bytes);
    if (room && wanted.has_places_of(*room)) {
        room = wanted; // there may be more room for constraints over the same arrays
        return;
    }
    make_current();
    order_after_kernels();
    GlBuffer grown("Contacts", wanted.bytes());
    objects_->uploads.zero(grown);
    for (const BufferId id : k_room_buffers) {
        if (wanted.is_covered(id) || (room && room->is_covered(id))) continue;
        const GlRange from = gl_range(id);
        const ContactRoom::Place to = wanted.place(id);
        glCopyNamedBufferSubData(from.buffer, grown.name(), static_cast<GLintptr>(from.offset),
                                 static_cast<GLintptr>(to.offset),
                                 static_cast<GLsizeiptr>(std::min<std::size_t>(from.size, to.bytes)));
    }
    for (const BufferId id : k_room_buffers)
        objects_->buffers[static_cast<std::size_t>(id)] = GlBuffer();
    objects_->contacts = std::move(grown);
    room = wanted;
    bindings_.forget();
}

void GlDevice::place_constraints(ConstraintPlace where) {
    if (objects_->room) objects_->room->place_constraints(where);
}

uint GlDevice::constraints_beside() const {
    return objects_->room ? objects_->room->constraints_beside() : k_none;
}

bool GlDevice::has_old_contacts() const {
    return !objects_->room || !objects_->room->is_covered(BufferId::OldManifolds);
}

void GlDevice::swap_contacts() {
    if (!objects_->room) return Device::swap_contacts();
    objects_->room->swap();
}

std::size_t GlDevice::size(BufferId id) const {
    return gl_range(id).size;
}

std::uint64_t GlDevice::memory_bytes() const {
    std::uint64_t bytes = objects_->parameters.size() + objects_->no_groups.size() + objects_->uploads.memory_bytes() +
                          objects_->read_back.memory_bytes() + objects_->steps.memory_bytes() +
                          objects_->contacts.size();
    for (const GlBuffer& each : objects_->buffers)
        bytes += each.size();
    return bytes;
}

void GlDevice::write(BufferId id, std::size_t offset, std::span<const std::byte> bytes) {
    check_range(id, offset + bytes.size(), "written");
    make_current();
    order_after_kernels();
    const GlRange range = gl_range(id);
    if (!lies_in_blocks(id)) return objects_->uploads.copy(range.buffer, range.offset + offset, bytes);
    TALUS_ASSERT(offset == 0, "records in blocks were to be written from their middle on");
    objects_->uploads.copy(range.buffer, range.offset, in_blocks(bytes, buffer_info(id).stride));
}

void GlDevice::read(std::span<const ReadRequest> requests) {
    std::vector<ReadBack::Request> sources;
    sources.reserve(requests.size());
    std::vector<std::vector<std::byte>> blocks(requests.size());
    for (std::size_t i = 0; i < requests.size(); ++i) {
        const ReadRequest& request = requests[i];
        check_range(request.buffer, request.bytes, "read");
        const GlRange range = gl_range(request.buffer);
        sources.push_back({range.buffer, range.offset, request.bytes, request.destination});
        if (!lies_in_blocks(request.buffer)) continue;
        blocks[i].resize(whole(element_bytes(request.buffer), request.bytes));
        sources.back().bytes = blocks[i].size();
        sources.back().destination = blocks[i].data();
    }
    make_current();
    leave();
    order_after_kernels();
    objects_->read_back.read(sources);
    for (std::size_t i = 0; i < requests.size(); ++i) {
        if (blocks[i].empty()) continue;
        const std::span records(static_cast<std::byte*>(requests[i].destination), requests[i].bytes);
        out_of_blocks(blocks[i], buffer_info(requests[i].buffer).stride, records);
    }
}

void GlDevice::swap(BufferId a, BufferId b) {
    TALUS_ASSERT(!is_in_room(a) && !is_in_room(b), "contacts were to be swapped without the others");
    std::swap(buffer(a), buffer(b));
    if (context_->is_debug()) {
        make_current();
        buffer(a).label(buffer_info(a).block);
        buffer(b).label(buffer_info(b).block);
    }
}

void GlDevice::set_parameters(const Parameters& parameters) {
    if (parameters_ && std::memcmp(&*parameters_, &parameters, sizeof(Parameters)) == 0) return;
    make_current();
    objects_->uploads.copy(objects_->parameters.name(), 0, std::as_bytes(std::span(&parameters, 1)));
    parameters_ = parameters;
}

void GlDevice::prepare(std::span<const Kernel* const> kernels) {
    make_current();
    for (const Kernel* kernel : kernels)
        begun_program(*kernel);
}

bool GlDevice::make_ready(std::span<const Kernel* const> kernels, std::chrono::milliseconds patience) {
    const auto end = std::chrono::steady_clock::now() + patience;
    const auto is_finished = [this](const Kernel* kernel) { return begun_program(*kernel).finished(); };
    const auto may_finish = [&](const Kernel* kernel) {
        return !is_finished(kernel) && begun_program(*kernel).is_compiled();
    };
    make_current();
    while (!std::ranges::all_of(kernels, is_finished)) {
        // The last first: those that take longest are given first.
        const auto next = std::find_if(kernels.rbegin(), kernels.rend(), may_finish);
        if (next != kernels.rend()) {
            GlProgram& program = begun_program(**next);
            program.finish(objects_->cache);
            launch_nothing(program);
        }
        if (std::chrono::steady_clock::now() >= end) return std::ranges::all_of(kernels, is_finished);
        if (next == kernels.rend()) nap();
    }
    return true;
}

void GlDevice::launch_nothing(const GlProgram& kernel) {
    bindings_.begin(!context_->is_own());
    bindings_.use_program(kernel.name());
    bindings_.bind_dispatches(objects_->no_groups.name());
    glDispatchComputeIndirect(0);
    leave();
}

bool GlDevice::is_ready(const Kernel& kernel) {
    if (faulty_.contains(&kernel)) return false;
    make_current();
    GlProgram& begun = begun_program(kernel);
    try {
        if (!begun.finished() && begun.is_compiled()) begun.finish(objects_->cache);
    } catch (const Error& error) {
        log(LogLevel::Warning, std::string("steps do without a kernel: ") + error.what());
        faulty_.insert(&kernel);
    }
    return begun.finished();
}

void GlDevice::run(const Launch& launch) {
    try {
        run_kernel(launch);
    } catch (const Error&) {
        leave();
        throw;
    }
}

void GlDevice::run_kernel(const Launch& launch) {
    const uint groups =
        launch.items / launch.kernel.items_a_group + (launch.items % launch.kernel.items_a_group != 0 ? 1 : 0);
    if (launch.slot == k_none && groups == 0) return;
    make_current();
    GlProgram& kernel = program(launch.kernel);

    bindings_.begin(!context_->is_own());
    bindings_.use_program(kernel.name());
    GLbitfield barriers = GL_SHADER_STORAGE_BARRIER_BIT;
    for (GLuint binding = 0; binding < kernel.blocks().size(); ++binding) {
        const StorageBlock& block = kernel.blocks()[binding];
        const BufferId id = kernel.buffer(block, launch);
        bindings_.bind_storage(binding, gl_range(id));
        if (id == BufferId::Dispatches && block.written)
            barriers |= GL_COMMAND_BARRIER_BIT; // nearly doubles the cost of a dispatch on some GPUs
    }
    if (kernel.uses_parameters()) bindings_.bind_parameters(objects_->parameters.name());
    kernel.set_args(launch.args);

    if (launch.slot == k_none) {
        dispatch_groups(groups);
    } else {
        bindings_.bind_dispatches(buffer(BufferId::Dispatches).name());
        glDispatchComputeIndirect(static_cast<GLintptr>(launch.slot * sizeof(Dispatch)));
    }
    if (!launch.overlaps_next) glMemoryBarrier(barriers);
    kernels_pending_ = true;
    ++launches;
}

void GlDevice::begin_stage(Stage stage) {
    make_current();
    end_stage();
    context_->activity = k_stage_names[static_cast<std::size_t>(stage)];
    glPushDebugGroup(GL_DEBUG_SOURCE_APPLICATION, 0, -1, context_->activity);
    in_stage_ = true;
    // The driver collects launches. What detects contacts begins while the rest of the step is being enqueued.
    if (stage == Stage::ConstraintGraph) glFlush();
    objects_->steps.begin_stage(stage);
}

Ticket GlDevice::end_step(bool with_poses, uint report_room) {
    make_current();
    leave();
    // All bits, once a step: the copies below and the caller's drawing, whatever it does with the buffers, see the
    // step.
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    kernels_pending_ = false;
    const GlBuffer& poses = buffer(BufferId::Poses);
    const std::size_t body_count = parameters_ ? parameters_->body_count : 0;
    const std::size_t pose_bytes = with_poses ? std::min(body_count * sizeof(BodyPose), poses.size()) : 0;
    const GlBuffer& reports = buffer(BufferId::ContactReports);
    const std::size_t report_bytes = std::min(report_room * sizeof(ContactReport), reports.size());
    return objects_->steps.end_step(buffer(BufferId::Counters).name(), {poses.name(), pose_bytes},
                                    {reports.name(), report_bytes});
}

bool GlDevice::finished(Ticket ticket) const {
    context_->make_current();
    return objects_->steps.finished(ticket);
}

void GlDevice::wait(Ticket ticket) {
    make_current();
    objects_->steps.wait(ticket);
}

std::span<const uint> GlDevice::counters(Ticket ticket) const {
    context_->make_current();
    return objects_->steps.counters(ticket);
}

std::span<const BodyPose> GlDevice::poses(Ticket ticket) const {
    context_->make_current();
    return objects_->steps.poses(ticket);
}

std::span<const ContactReport> GlDevice::reports(Ticket ticket) const {
    context_->make_current();
    return objects_->steps.reports(ticket);
}

std::span<const double> GlDevice::stage_ms(Ticket ticket) const {
    context_->make_current();
    return objects_->steps.stage_ms(ticket);
}

GlRange GlDevice::gl_range(BufferId id) const {
    if (!is_in_room(id)) return {buffer(id).name(), 0, buffer(id).size()};
    const ContactRoom::Place place = objects_->room->place(id);
    return {objects_->contacts.name(), place.offset, place.bytes};
}

void GlDevice::make_current() {
    context_->make_current();
}

bool GlDevice::is_in_room(BufferId id) const {
    static constexpr auto lies_in_room = [] {
        std::array<bool, k_buffers.size()> lies{};
        for (const BufferId buffer : k_room_buffers)
            lies[static_cast<std::size_t>(buffer)] = true;
        return lies;
    }();
    return objects_->room && lies_in_room[static_cast<std::size_t>(id)];
}

GlBuffer& GlDevice::buffer(BufferId id) const {
    return objects_->buffers[static_cast<std::size_t>(id)];
}

void GlDevice::keep_programs() {
    if (!objects_->cache.keeps()) return;
    for (auto& [path, program] : objects_->programs)
        finish_unneeded(program);
}

bool GlDevice::finish_unneeded(GlProgram& program) {
    try {
        program.finish(objects_->cache);
        return true;
    } catch (const Error&) { // told to those who need it
        return false;
    }
}

GlProgram& GlDevice::begun_program(const Kernel& kernel) {
    const std::string path = kernel.path;
    return objects_->programs.try_emplace(path, path, kernel_target_, objects_->cache).first->second;
}

GlProgram& GlDevice::program(const Kernel& kernel) {
    GlProgram& begun = begun_program(kernel);
    if (begun.finished()) return begun;
    while (!begun.is_compiled())
        finish_another();
    begun.finish(objects_->cache);
    return begun;
}

void GlDevice::finish_another() {
    for (auto& [path, program] : objects_->programs) {
        if (!program.finished() && program.is_compiled() && finish_unneeded(program)) return;
    }
    nap();
}

void GlDevice::check_range(BufferId id, std::size_t end, const char* what) const {
    if (end > size(id))
        throw Error(std::string("buffer ") + buffer_info(id).block + ": " + std::to_string(end) + " bytes were to be " +
                    what + ", but it has " + std::to_string(size(id)));
}

void GlDevice::order_after_kernels() {
    if (kernels_pending_) glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    kernels_pending_ = false;
}

void GlDevice::end_stage() {
    if (in_stage_) glPopDebugGroup();
    in_stage_ = false;
    context_->activity = "between stages";
}

void GlDevice::leave() {
    end_stage();
    bindings_.end();
}

std::unique_ptr<Device> make_gl_device(GlContext context, bool profile, bool debug, bool program_cache) {
    check_kernel_folder();
    return std::make_unique<GlDevice>(context == GlContext::Own ? OpenGlContext::own(debug) : OpenGlContext::current(),
                                      profile, program_cache);
}

} // namespace talus::engine
