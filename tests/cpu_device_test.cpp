// SPDX-License-Identifier: MIT
// The CPU device itself: memory, launches, threads, floating-point mode, and what it refuses.
#include <algorithm>
#include <atomic>
#include <limits>

#include <gtest/gtest.h>

#include "device/cpu/cpu_state.h"
#include "device/device.h"

namespace talus::engine {
namespace {

constexpr BufferId k_words = BufferId::SortKeys;

std::vector<uint> read_words(Device& device, BufferId buffer) {
    std::vector<uint> words(device.size(buffer) / sizeof(uint));
    const ReadRequest request{buffer, device.size(buffer), words.data()};
    device.read({&request, 1});
    return words;
}

void write_words(Device& device, BufferId buffer, std::size_t first, std::vector<uint> words) {
    device.write(buffer, first * sizeof(uint), std::as_bytes(std::span(words)));
}

std::string error_of(const auto& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "no error";
}

/// Half of the smallest normalised number, made anew at run time.
bool denormal_is_zero() {
    volatile float smallest = std::numeric_limits<float>::min();
    return smallest * 0.5f == 0.0f;
}

const Kernel k_count_runs{"tests/count_runs",
                          [](CpuState& state, const Launch& launch) { ++state.words(launch.bound("Words"))[0]; }};

const Kernel k_visit{"tests/visit", [](CpuState& state, const Launch& launch) {
                         state.parallel(
                             launch.items, [&](uint i) { state.sort_keys[i] += denormal_is_zero() ? 1 : 1000; }, 16);
                     }};

TEST(CpuDevice, growing_keeps_the_content_and_zeroes_the_rest) {
    const auto device = make_cpu_device(1, false);
    device->grow(k_words, 8);
    write_words(*device, k_words, 0, {1, 2});
    device->grow(k_words, 16);
    device->grow(k_words, 4);
    EXPECT_EQ(read_words(*device, k_words), (std::vector<uint>{1, 2, 0, 0}));
    EXPECT_EQ(device->memory_bytes(), 16u);
}

TEST(CpuDevice, swapped_buffers_change_places_for_kernels_too) {
    const auto device = make_cpu_device(1, false);
    device->grow(k_words, 4);
    device->grow(BufferId::SortValues, 8);
    write_words(*device, BufferId::SortValues, 0, {5, 6});
    device->swap(k_words, BufferId::SortValues);
    device->run({.kernel = k_count_runs, .items = 1, .bindings = {{"Words", k_words}}});
    EXPECT_EQ(read_words(*device, k_words), (std::vector<uint>{6, 6}));
}

TEST(CpuDevice, launches_without_items_do_not_run) {
    const auto device = make_cpu_device(1, false);
    device->grow(k_words, 4);
    device->grow(BufferId::Dispatches, k_dispatch_count * sizeof(Dispatch));
    const auto run = [&](uint items, uint slot) {
        device->run({.kernel = k_count_runs, .items = items, .slot = slot, .bindings = {{"Words", k_words}}});
        return read_words(*device, k_words)[0];
    };
    EXPECT_EQ(run(0, k_none), 0u);
    EXPECT_EQ(run(1, k_dispatch_bodies), 0u);
    EXPECT_EQ(run(1, k_none), 1u);
    const Dispatch dispatch{1, 1, 1, 1};
    device->write(BufferId::Dispatches, k_dispatch_bodies * sizeof dispatch, std::as_bytes(std::span(&dispatch, 1)));
    EXPECT_EQ(run(0, k_dispatch_bodies), 2u);
}

TEST(CpuDevice, loops_visit_every_item_once_with_denormals_flushed) {
    for (const uint threads : {0u, 1u, 2u, 5u}) {
        const auto device = make_cpu_device(threads, false);
        for (const uint count : {1u, 16u, 17u, 1'000u, 100'000u}) {
            device->grow(k_words, count * sizeof(uint));
            write_words(*device, k_words, 0, std::vector<uint>(count, 0));
            device->run({.kernel = k_visit, .items = count});
            const std::vector<uint> visits = read_words(*device, k_words);
            EXPECT_EQ(std::count(visits.begin(), visits.begin() + count, 1u), count) << threads << " threads";
        }
    }
    EXPECT_FALSE(denormal_is_zero()) << "the caller's mode must come back";
}

TEST(CpuDevice, results_of_steps_stay_for_a_while) {
    const auto device = make_cpu_device(1, true);
    device->grow(BufferId::Counters, k_counter_words * sizeof(uint));
    device->grow(BufferId::Poses, 3 * sizeof(BodyPose));
    Parameters parameters{};
    parameters.body_count = 2;
    device->set_parameters(parameters);
    for (uint step = 0; step <= k_ring_size; ++step) {
        write_words(*device, BufferId::Counters, k_counter_pair_count, {step});
        device->begin_stage(Stage::Solve);
        EXPECT_EQ(device->end_step(step % 2 == 1), step);
    }
    EXPECT_EQ(device->counters(1)[k_counter_pair_count], 1u);
    EXPECT_EQ(device->counters(k_ring_size)[k_counter_pair_count], k_ring_size);
    EXPECT_EQ(device->poses(1).size(), 2u);
    EXPECT_EQ(device->poses(2).size(), 0u);
    EXPECT_EQ(device->stage_ms(2).size(), k_stage_count);
    EXPECT_FALSE(device->finished(k_ring_size + 1));
    EXPECT_EQ(error_of([&] { device->counters(0); }),
              "results of step ticket 0 were asked for; the device keeps those of "
              "the last 8 steps before ticket 9");
}

TEST(CpuDevice, refusals_say_what_is_allowed) {
    EXPECT_EQ(error_of([] { make_cpu_device(1025, false); }),
              "the CPU device was asked for 1025 threads; allowed are 1 to 1024, or 0 for as many as the machine has");
    const auto device = make_cpu_device(2, false);
    EXPECT_EQ(device->info().threads, 2u);
    EXPECT_FALSE(device->info().name.empty());
    device->grow(k_words, 8);
    EXPECT_EQ(error_of([&] {
                  write_words(*device, k_words, 1, {1, 2});
              }),
              "bytes 4 to 12 of the buffer SortKeys were asked for, which has 8");
    EXPECT_EQ(error_of([&] {
                  device->run({.kernel = k_count_runs, .items = 1, .bindings = {{"Values", k_words}}});
              }),
              "kernel tests/count_runs was launched without a buffer for its block Words; the launch binds Values");
}

} // namespace
} // namespace talus::engine
