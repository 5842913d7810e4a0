// SPDX-License-Identifier: MIT
// The CPU device: buffers in the host's memory, kernels through their twins. A launch is finished when `run` returns,
// so nothing is ever waited for.
#include <algorithm>
#include <chrono>
#include <cstring>
#include <fstream>
#include <new>

#include "broad_phase/lane_search.h"
#include "device/cpu/cpu_state.h"
#include "device/cpu/flush_denormals.h"
#include "fresh_memory.h"
#include "resolution/solve_islands.h"

namespace talus::engine {
namespace {

constexpr uint k_max_threads = 1024;

std::string cpu_name() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);) {
        if (!line.starts_with("model name")) continue;
        const std::size_t start = line.find_first_not_of(" \t", line.find(':') + 1);
        if (start != std::string::npos) return line.substr(start);
    }
    return "unnamed CPU"; // arm64 kernels give no name
}

std::string compiler_name() {
#if defined(__clang__)
    return __VERSION__; // says "Clang" itself
#elif defined(__GNUC__)
    return "GCC " __VERSION__;
#else
    return "unnamed compiler";
#endif
}

/// Zeroed memory that starts on a cache line.
class Storage {
public:
    Storage() = default;
    Storage(std::size_t size, uint threads)
        : memory(static_cast<std::byte*>(::operator new(size, k_alignment))), bytes(size) {
        touch_pages(memory.get(), bytes, threads);
        std::memset(memory.get(), 0, bytes);
    }
    std::byte* data() const { return memory.get(); }
    std::size_t size() const { return bytes; }

private:
    static constexpr std::align_val_t k_alignment{64};
    struct Free {
        void operator()(std::byte* pointer) const { ::operator delete(pointer, k_alignment); }
    };
    std::unique_ptr<std::byte, Free> memory;
    std::size_t bytes = 0;
};

/// What a step leaves for the host.
struct Frame {
    std::vector<uint> counters;
    std::vector<BodyPose> poses;
    std::vector<ContactReport> reports;
    std::vector<double> stage_times;
};

class CpuDevice final : public Device {
public:
    CpuDevice(uint thread_count, bool with_profile) : threads(thread_count), profile(with_profile) {
        state.threads = &threads;
        if (profile) stage_times.resize(k_stage_count);
    }

    DeviceInfo info() const override { return {DeviceKind::Cpu, cpu_name(), compiler_name(), "", threads.count()}; }

    void grow(BufferId buffer, std::size_t bytes) override {
        Storage& old = storage_of(buffer);
        if (bytes <= old.size()) return;
        try {
            Storage larger(bytes, threads.count());
            if (old.size() > 0) std::memcpy(larger.data(), old.data(), old.size());
            old = std::move(larger);
        } catch (const std::bad_alloc&) {
            throw Error("the host has no memory for " + std::to_string(bytes) + " bytes of the buffer " +
                        block_of(buffer) + "; the device holds " + std::to_string(memory_bytes()) + " bytes now");
        }
        update_arrays();
    }

    std::size_t size(BufferId buffer) const override { return storage_of(buffer).size(); }

    std::uint64_t memory_bytes() const override {
        std::uint64_t sum = 0;
        for (const Storage& storage : storages)
            sum += storage.size();
        if (state.search_memory != nullptr) sum += state.search_memory->memory_bytes();
        if (state.solver_batches != nullptr) sum += engine::memory_bytes(*state.solver_batches);
        if (state.island_memory != nullptr) sum += state.island_memory->memory_bytes();
        return sum;
    }

    void write(BufferId buffer, std::size_t offset, std::span<const std::byte> bytes) override {
        check_range(buffer, offset, bytes.size());
        if (!bytes.empty()) std::memcpy(storage_of(buffer).data() + offset, bytes.data(), bytes.size());
    }

    void read(std::span<const ReadRequest> requests) override {
        for (const ReadRequest& request : requests) {
            check_range(request.buffer, 0, request.bytes);
            if (request.bytes > 0) std::memcpy(request.destination, storage_of(request.buffer).data(), request.bytes);
        }
    }

    std::byte* host_data(BufferId buffer) override { return storage_of(buffer).data(); }

    void swap(BufferId a, BufferId b) override {
        std::swap(storage_of(a), storage_of(b));
        update_arrays();
    }

    void set_parameters(const Parameters& parameters) override { state.parameters = parameters; }

    void run(const Launch& launch) override {
        const uint items = launch.slot == k_none ? launch.items : state.dispatches[launch.slot].items;
        if (items == 0) return;
        ++launches;
        const FlushDenormals flush;
        launch.kernel.twin(state, launch);
    }

    void begin_stage(Stage stage) override {
        if (!profile) return;
        end_stage();
        running_stage = stage;
        stage_start = Clock::now();
    }

    Ticket end_step(bool with_poses, uint report_room) override {
        end_stage();
        Frame& frame = frames[next_ticket % k_ring_size];
        const std::size_t words = std::min<std::size_t>(state.counters.size, k_counter_words);
        frame.counters.assign(state.counters.data, state.counters.data + words);
        const std::size_t bodies =
            with_poses ? std::min<std::size_t>(state.poses.size, state.parameters.body_count) : 0;
        frame.poses.assign(state.poses.data, state.poses.data + bodies);
        const uint reports = words == 0 ? 0 : min(state.counters[k_counter_report_count], report_room);
        frame.reports.assign(state.contact_reports.data, state.contact_reports.data + reports);
        frame.stage_times = stage_times;
        std::fill(stage_times.begin(), stage_times.end(), 0.0);
        return next_ticket++;
    }

    bool finished(Ticket ticket) const override { return ticket < next_ticket; }
    void wait(Ticket) override {}
    std::span<const uint> counters(Ticket ticket) const override { return frame_of(ticket).counters; }
    std::span<const BodyPose> poses(Ticket ticket) const override { return frame_of(ticket).poses; }
    std::span<const ContactReport> reports(Ticket ticket) const override { return frame_of(ticket).reports; }
    std::span<const double> stage_ms(Ticket ticket) const override { return frame_of(ticket).stage_times; }

private:
    using Clock = std::chrono::steady_clock;

    static const char* block_of(BufferId buffer) { return k_buffers[static_cast<std::size_t>(buffer)].block; }
    Storage& storage_of(BufferId buffer) { return storages[static_cast<std::size_t>(buffer)]; }
    const Storage& storage_of(BufferId buffer) const { return storages[static_cast<std::size_t>(buffer)]; }

    void check_range(BufferId buffer, std::size_t offset, std::size_t bytes) const {
        const std::size_t held = size(buffer);
        if (offset <= held && bytes <= held - offset) return;
        throw Error("bytes " + std::to_string(offset) + " to " + std::to_string(offset + bytes) + " of the buffer " +
                    block_of(buffer) + " were asked for, which has " + std::to_string(held));
    }

    const Frame& frame_of(Ticket ticket) const {
        if (ticket < next_ticket && ticket + k_ring_size >= next_ticket) return frames[ticket % k_ring_size];
        throw Error("results of step ticket " + std::to_string(ticket) +
                    " were asked for; the device keeps those of the last " + std::to_string(k_ring_size) +
                    " steps before ticket " + std::to_string(next_ticket));
    }

    /// Buffers move when they grow or are swapped; the twins' arrays follow.
    void update_arrays() {
#define X(block, field, element, layout, role)                                                                         \
    state.field = {reinterpret_cast<element*>(storage_of(BufferId::block).data()),                                     \
                   storage_of(BufferId::block).size() / sizeof(element)};
        TALUS_BUFFERS(X)
#undef X
    }

    void end_stage() {
        if (running_stage == Stage::count) return;
        const std::chrono::duration<double, std::milli> passed = Clock::now() - stage_start;
        stage_times[static_cast<std::size_t>(running_stage)] += passed.count();
        running_stage = Stage::count;
    }

    std::array<Storage, k_buffers.size()> storages;
    CpuThreads threads;
    CpuState state;

    std::array<Frame, k_ring_size> frames;
    Ticket next_ticket = 0;

    bool profile;
    Stage running_stage = Stage::count; // count: none
    Clock::time_point stage_start;
    std::vector<double> stage_times; // of the step on its way; empty where nothing is measured
};

} // namespace

Array<uint> CpuState::words(BufferId buffer) const {
    switch (buffer) {
#define X(block, field, element, layout, role)                                                                         \
    case BufferId::block:                                                                                              \
        return {reinterpret_cast<uint*>(field.data), field.size * (sizeof(element) / sizeof(uint))};
        TALUS_BUFFERS(X)
#undef X
    case BufferId::count:
        break;
    }
    return {};
}

std::unique_ptr<Device> make_cpu_device(std::uint32_t threads, bool profile) {
    if (threads > k_max_threads)
        throw Error("the CPU device was asked for " + std::to_string(threads) + " threads; allowed are 1 to " +
                    std::to_string(k_max_threads) + ", or 0 for as many as the machine has");
    return std::make_unique<CpuDevice>(threads_asked_for(threads), profile);
}

} // namespace talus::engine
