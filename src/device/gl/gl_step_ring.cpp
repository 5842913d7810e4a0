// SPDX-License-Identifier: MIT
// See gl_step_ring.h. Times are differences of GL_TIMESTAMP: GL_TIME_ELAPSED is broken on llvmpipe, and cannot nest.
#include "device/gl/gl_step_ring.h"

#include <algorithm>
#include <bit>

#include <talus/types.h>

namespace talus::engine {
namespace {

constexpr GLbitfield k_read_mapped = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
constexpr std::size_t k_counter_bytes = k_counter_words * sizeof(uint);

void copy_into(GlBuffer& target, StepRing::Source source, const char* label) {
    if (source.bytes > target.size()) target = GlBuffer(label, std::bit_ceil(source.bytes), k_read_mapped);
    if (source.bytes != 0)
        glCopyNamedBufferSubData(source.buffer, target.name(), 0, 0, static_cast<GLsizeiptr>(source.bytes));
}

} // namespace

StepRing::StepRing(bool profile)
    : profile_(profile), counters_("StepRing counters", k_counter_bytes * k_ring_size, k_read_mapped) {}

StepRing::~StepRing() {
    for (const Slot& slot : slots_)
        glDeleteQueries(static_cast<GLsizei>(slot.queries.size()), slot.queries.data());
}

void StepRing::begin_stage(Stage stage) {
    if (!profile_) return;
    Slot& slot = open_slot();
    mark_time(slot, slot.stages.size());
    slot.stages.push_back(stage);
}

Ticket StepRing::end_step(GLuint counters, Source poses, Source reports) {
    Slot& slot = open_slot();
    if (!slot.stages.empty()) mark_time(slot, slot.stages.size());
    slot.collected = false;

    glCopyNamedBufferSubData(counters, counters_.name(), 0,
                             static_cast<GLintptr>(next_ % k_ring_size * k_counter_bytes), k_counter_bytes);
    copy_into(slot.poses, poses, "StepRing poses");
    slot.pose_count = poses.bytes / sizeof(BodyPose);
    copy_into(slot.reports, reports, "StepRing reports");
    slot.report_room = reports.bytes / sizeof(ContactReport);
    slot.fence = GlFence::place();
    glFlush();
    open_ = false;
    return next_++;
}

bool StepRing::finished(Ticket ticket) {
    if (ticket >= next_) return false;
    if (next_ - ticket > k_ring_size) return true;
    return slot(ticket).fence.passed();
}

void StepRing::wait(Ticket ticket) {
    if (ticket < next_ && next_ - ticket <= k_ring_size) slot(ticket).fence.wait();
}

std::span<const uint> StepRing::counters(Ticket ticket) {
    finished_slot(ticket);
    const std::byte* words = counters_.mapped() + ticket % k_ring_size * k_counter_bytes;
    return {reinterpret_cast<const uint*>(words), k_counter_words};
}

std::span<const BodyPose> StepRing::poses(Ticket ticket) {
    const Slot& found = finished_slot(ticket);
    return {reinterpret_cast<const BodyPose*>(found.poses.mapped()), found.pose_count};
}

std::span<const ContactReport> StepRing::reports(Ticket ticket) {
    const std::size_t made = counters(ticket)[k_counter_report_count];
    const Slot& found = slot(ticket);
    return {reinterpret_cast<const ContactReport*>(found.reports.mapped()), std::min(made, found.report_room)};
}

std::span<const double> StepRing::stage_ms(Ticket ticket) {
    Slot& found = finished_slot(ticket);
    collect_times(found);
    return found.stage_ms;
}

std::size_t StepRing::memory_bytes() const noexcept {
    std::size_t bytes = counters_.size();
    for (const Slot& slot : slots_)
        bytes += slot.poses.size() + slot.reports.size();
    return bytes;
}

StepRing::Slot& StepRing::open_slot() {
    Slot& slot = slots_[next_ % k_ring_size];
    if (!open_) {
        slot.fence.wait();
        collect_times(slot);
        slot.stages.clear();
        open_ = true;
    }
    return slot;
}

StepRing::Slot& StepRing::slot(Ticket ticket) {
    return slots_[ticket % k_ring_size];
}

StepRing::Slot& StepRing::finished_slot(Ticket ticket) {
    if (ticket >= next_ || next_ - ticket > k_ring_size)
        throw Error("step ticket " + std::to_string(ticket) + " is not one of the last " + std::to_string(k_ring_size) +
                    " (" + std::to_string(next_) + " steps were made)");
    wait(ticket);
    return slot(ticket);
}

void StepRing::mark_time(Slot& slot, std::size_t index) {
    if (index == slot.queries.size()) {
        GLuint query = 0;
        glGenQueries(1, &query);
        slot.queries.push_back(query);
    }
    glQueryCounter(slot.queries[index], GL_TIMESTAMP);
}

void StepRing::collect_times(Slot& slot) {
    if (slot.collected) return;
    slot.collected = true;
    slot.stage_ms.assign(profile_ ? k_stage_count : 0, 0.0);
    if (slot.stages.empty()) return;
    GLuint64 start = 0;
    glGetQueryObjectui64v(slot.queries[0], GL_QUERY_RESULT, &start);
    for (std::size_t i = 0; i < slot.stages.size(); ++i) {
        GLuint64 end = 0;
        glGetQueryObjectui64v(slot.queries[i + 1], GL_QUERY_RESULT, &end);
        slot.stage_ms[static_cast<std::size_t>(slot.stages[i])] += static_cast<double>(end - start) * 1e-6;
        start = end;
    }
}

} // namespace talus::engine
