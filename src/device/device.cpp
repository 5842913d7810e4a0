// SPDX-License-Identifier: MIT
// What all devices share.
#include "device/device.h"

#include <cstring>

namespace talus::engine {

std::optional<BufferId> buffer_of_block(std::string_view block) {
    for (std::size_t i = 0; i < k_buffers.size(); ++i)
        if (block == k_buffers[i].block) return static_cast<BufferId>(i);
    return std::nullopt;
}

BufferId Launch::bound(const char* block) const {
    for (const Binding& binding : bindings)
        if (std::strcmp(binding.block, block) == 0) return binding.buffer;
    if (const std::optional<BufferId> named = buffer_of_block(block)) return *named;

    std::string known;
    for (const Binding& binding : bindings)
        known += (known.empty() ? "" : ", ") + std::string(binding.block);
    throw Error("kernel " + std::string(kernel.path) + " was launched without a buffer for its block " + block +
                "; the launch binds " + (known.empty() ? "no block" : known));
}

// A device may do with less memory: here each buffer is one of its own.
void Device::reserve_contacts(const ContactDemand& demand) {
    for (const auto& buffers : {k_contact_buffers, k_old_contact_buffers})
        for (const BufferId buffer : buffers)
            grow(buffer, demand.pairs * bytes_a_pair(buffer));
    grow(BufferId::Constraints, demand.manifolds * sizeof(ContactConstraint));
    grow(BufferId::PairTable, demand.table_size * sizeof(uint));
    grow(BufferId::Uncoloured, demand.pairs * sizeof(uint));
}

void Device::swap_contacts() {
    for (std::size_t i = 0; i < k_contact_buffers.size(); ++i)
        swap(k_contact_buffers[i], k_old_contact_buffers[i]);
}

} // namespace talus::engine

namespace talus {

std::vector<DeviceInfo> list_devices() {
    std::vector<DeviceInfo> devices = engine::probe_gl();
    devices.push_back(engine::make_cpu_device(0, false)->info());
    return devices;
}

} // namespace talus
