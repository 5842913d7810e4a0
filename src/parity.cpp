// SPDX-License-Identifier: MIT
#include "parity.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "body_table.h"
#include "checks.h"
#include "parameters.h"
#include "resolution/resolution.h"
#include "simulation.h"
#include "state/formulas.h"

namespace talus::engine {
namespace {

using Bytes = std::vector<std::byte>;
using Content = std::array<Bytes, k_buffers.size()>;

/// Every buffer, as far as it has room.
Content content_of(Device& device) {
    Content content;
    std::vector<ReadRequest> requests;
    for (std::size_t i = 0; i < k_buffers.size(); ++i) {
        content[i].resize(device.size(BufferId{static_cast<uint>(i)}));
        if (!content[i].empty())
            requests.push_back({BufferId{static_cast<uint>(i)}, content[i].size(), content[i].data()});
    }
    device.read(requests);
    return content;
}

void give_content(Device& device, const Content& content) {
    for (std::size_t i = 0; i < k_buffers.size(); ++i) {
        const BufferId buffer{static_cast<uint>(i)};
        if (content[i].empty()) continue;
        device.grow(buffer, content[i].size());
        device.write(buffer, 0, content[i]);
    }
}

uint word_at(const Bytes& bytes, std::size_t word) {
    uint value;
    std::memcpy(&value, bytes.data() + word * sizeof(uint), sizeof(uint));
    return value;
}

/// Over what both have room for: a device may have made a buffer larger than the other.
bool differ(const Bytes& a, const Bytes& b) {
    const std::size_t bytes = std::min(a.size(), b.size());
    return bytes > 0 && std::memcmp(a.data(), b.data(), bytes) != 0; // an empty buffer has no address
}

BufferParity compare(Stage stage, std::size_t buffer, const Bytes& a, const Bytes& b) {
    const BufferInfo& info = k_buffers[buffer];
    const std::size_t letters = std::strlen(info.layout);
    BufferParity row{k_stage_names[static_cast<std::size_t>(stage)], info.block};
    row.words = std::min(a.size(), b.size()) / sizeof(uint);
    for (std::size_t i = 0; i < row.words; ++i) {
        const uint word_a = word_at(a, i), word_b = word_at(b, i);
        if (word_a == word_b) continue;
        if (info.layout[i % letters] == 'u') {
            ++row.integers_differ;
            continue;
        }
        const double x = uintBitsToFloat(word_a), y = uintBitsToFloat(word_b);
        if (x == y) continue; // the two zeros
        ++row.floats_differ;
        const double error = std::abs(x - y) / std::max({1.0, std::abs(x), std::abs(y)});
        row.largest_error = std::isfinite(error) ? std::max(row.largest_error, error) : HUGE_VAL;
    }
    return row;
}

} // namespace

bool ParityReport::integers_agree() const {
    return std::ranges::all_of(rows, [](const BufferParity& row) { return row.integers_differ == 0; });
}

double ParityReport::largest_error() const {
    double largest = 0.0;
    for (const BufferParity& row : rows)
        largest = std::max(largest, row.largest_error);
    return largest;
}

ParityReport compare_devices(const std::vector<BodyDefinition>& definitions, const Settings& settings,
                             std::uint32_t steps) {
    check_settings(settings);
    WorldOptions options;
    options.device = DeviceKind::Cpu;
    Simulation simulation(options);
    simulation.set_settings(settings);
    simulation.watch_contacts(ContactWatch::All); // so that its kernels are compared too
    BodyTable table;
    table.reserve(definitions.size());
    for (std::size_t i = 0; i < definitions.size(); ++i) {
        check_definition(definitions[i], {"body {1} of the scene", "", i});
        table.add(definitions[i]);
    }

    const uint body_count = table.slot_count();
    simulation.reserve_bodies(body_count);
    simulation.write(BufferId::Poses, 0, std::span<const BodyPose>(table.poses));
    simulation.write(BufferId::Velocities, 0, std::span<const BodyVelocity>(table.velocities));
    simulation.write(BufferId::Shapes, 0, std::span<const BodyShape>(table.shapes));
    simulation.write(BufferId::Properties, 0, std::span<const BodyProperties>(table.properties));
    simulation.write(BufferId::Counters, k_counter_body_count, std::span<const uint>(&body_count, 1));
    const Population population = table.population();
    for (std::uint32_t i = 0; i < steps; ++i)
        simulation.step(population, false);
    simulation.settle();
    simulation.reserve_pairs(2 * simulation.plan_step(population).pair_capacity); // the next step fits

    const std::unique_ptr<Device> gpu = make_gl_device(GlContext::Own, false);
    StepPlan plan = simulation.plan_step(population);
    if (!plan.small) plan.colouring_groups = std::max(gpu->resident_groups(assign_colours), 1u);
    plan.in_groups = plan.in_groups && gpu->loops_freely();
    plan.persistent_groups = plan.may_be_persistent() ? gpu->resident_groups(persistent_solver(plan)) : 0;
    plan.colour_capacity = k_first_hub_colour;
    plan.overflow = true;
    plan.substep_capacity = plan.most_substeps;
    Device& cpu = simulation.state_device();
    const Parameters parameters = make_parameters(settings, plan);
    cpu.set_parameters(parameters);
    gpu->set_parameters(parameters);

    StepPlan with_two_joins = plan; // of the same result
    with_two_joins.joined_twice = 0;

    simulation.search_anew();
    ParityReport report;
    Content before = content_of(cpu);
    give_content(*gpu, before);
    for (const Stage stage : k_stages) {
        run_stage(cpu, stage, plan);
        run_stage(*gpu, stage, with_two_joins);
        Content on_cpu = content_of(cpu);
        const Content on_gpu = content_of(*gpu);
        for (std::size_t i = 0; i < k_buffers.size(); ++i) {
            const bool written = differ(on_cpu[i], before[i]) || differ(on_gpu[i], before[i]);
            if (written && k_buffers[i].role != Role::Scratch)
                report.rows.push_back(compare(stage, i, on_cpu[i], on_gpu[i]));
        }
        give_content(*gpu, on_cpu);
        before = std::move(on_cpu);
    }
    return report;
}

} // namespace talus::engine
