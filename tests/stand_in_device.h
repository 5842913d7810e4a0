// SPDX-License-Identifier: MIT
// A device that stands in for another one and passes on all that it is asked for, so that a test may do otherwise with
// some of it.
#pragma once

#include <chrono>
#include <memory>
#include <span>
#include <utility>

#include "device/device.h"

namespace talus::tests {

class StandInDevice : public engine::Device {
public:
    explicit StandInDevice(std::unique_ptr<engine::Device> replaced) : device(std::move(replaced)) {}

    void run(const engine::Launch& launch) override {
        device->run(launch);
        launches = device->launch_count();
    }
    engine::uint resident_groups(const engine::Kernel& kernel) override { return device->resident_groups(kernel); }
    bool is_ready(const engine::Kernel& kernel) override { return device->is_ready(kernel); }
    DeviceInfo info() const override { return device->info(); }
    bool loops_freely() const override { return device->loops_freely(); }
    void grow(engine::BufferId buffer, std::size_t bytes) override { device->grow(buffer, bytes); }
    std::size_t size(engine::BufferId buffer) const override { return device->size(buffer); }
    std::uint64_t memory_bytes() const override { return device->memory_bytes(); }
    void write(engine::BufferId buffer, std::size_t offset, std::span<const std::byte> bytes) override {
        device->write(buffer, offset, bytes);
    }
    void read(std::span<const engine::ReadRequest> requests) override { device->read(requests); }
    void swap(engine::BufferId a, engine::BufferId b) override { device->swap(a, b); }
    void reserve_contacts(const engine::ContactDemand& demand) override { device->reserve_contacts(demand); }
    void place_constraints(engine::ConstraintPlace where) override { device->place_constraints(where); }
    engine::uint constraints_beside() const override { return device->constraints_beside(); }
    bool has_old_contacts() const override { return device->has_old_contacts(); }
    void swap_contacts() override { device->swap_contacts(); }
    void set_parameters(const engine::Parameters& parameters) override { device->set_parameters(parameters); }
    void prepare(std::span<const engine::Kernel* const> kernels) override { device->prepare(kernels); }
    bool make_ready(std::span<const engine::Kernel* const> kernels, std::chrono::milliseconds patience) override {
        return device->make_ready(kernels, patience);
    }
    void begin_stage(engine::Stage stage) override { device->begin_stage(stage); }
    engine::Ticket end_step(bool with_poses, engine::uint report_room) override {
        return device->end_step(with_poses, report_room);
    }
    bool finished(engine::Ticket ticket) const override { return device->finished(ticket); }
    void wait(engine::Ticket ticket) override { device->wait(ticket); }
    std::span<const engine::uint> counters(engine::Ticket ticket) const override { return device->counters(ticket); }
    std::span<const engine::BodyPose> poses(engine::Ticket ticket) const override { return device->poses(ticket); }
    std::span<const engine::ContactReport> reports(engine::Ticket ticket) const override {
        return device->reports(ticket);
    }
    std::span<const double> stage_ms(engine::Ticket ticket) const override { return device->stage_ms(ticket); }
    void leave() override { device->leave(); }
    std::byte* host_data(engine::BufferId buffer) override { return device->host_data(buffer); }
    GlRange gl_range(engine::BufferId buffer) const override { return device->gl_range(buffer); }
    void make_current() override { device->make_current(); }

protected:
    std::unique_ptr<engine::Device> device;
};

} // namespace talus::tests
