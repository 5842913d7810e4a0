// SPDX-License-Identifier: MIT
// A device that only notes what it is given to run: with it the step itself tells which kernels it needs.
#pragma once

#include <vector>

#include "device/device.h"

namespace talus::engine {

class KernelList final : public Device {
public:
    /// In the place of `device`, whose buffers it leaves as they are. The device must outlive it.
    explicit KernelList(const Device& device) : replaced(device) {}

    /// In the order of their first launch.
    std::vector<const Kernel*> kernels;

    void run(const Launch& launch) override { kernels.push_back(&launch.kernel); }

    DeviceInfo info() const override { return {}; }
    void grow(BufferId, std::size_t) override {}
    std::size_t size(BufferId buffer) const override { return replaced.size(buffer); }
    std::uint64_t memory_bytes() const override { return 0; }
    void write(BufferId, std::size_t, std::span<const std::byte>) override {}
    void read(std::span<const ReadRequest>) override {}
    void swap(BufferId, BufferId) override {}
    void set_parameters(const Parameters&) override {}
    void begin_stage(Stage) override {}
    Ticket end_step(bool, uint) override { return 0; }
    bool finished(Ticket) const override { return true; }
    void wait(Ticket) override {}
    std::span<const uint> counters(Ticket) const override { return {}; }
    std::span<const BodyPose> poses(Ticket) const override { return {}; }
    std::span<const ContactReport> reports(Ticket) const override { return {}; }
    std::span<const double> stage_ms(Ticket) const override { return {}; }

private:
    const Device& replaced;
};

} // namespace talus::engine
