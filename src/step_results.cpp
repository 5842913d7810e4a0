// SPDX-License-Identifier: MIT
#include "step_results.h"

#include <algorithm>
#include <array>
#include <utility>

#include "state/formulas.h"

namespace talus::engine {

template <typename T> static ReadRequest read_into(BufferId buffer, std::vector<T>& records) {
    return {buffer, records.size() * sizeof(T), records.data()};
}

std::vector<Pair> read_pairs(Simulation& simulation) {
    simulation.settle();
    std::vector<Pair> pairs(simulation.report().pairs);
    simulation.detection_device().read(std::array{read_into(BufferId::Pairs, pairs)});
    std::ranges::sort(pairs, {}, [](const Pair& pair) { return std::pair(pair.body_a, pair.body_b); });
    return pairs;
}

ContactRecords read_contacts(Simulation& simulation) {
    simulation.settle();
    Device& device = simulation.state_device();
    const std::size_t pair_count = simulation.report().pairs;
    ContactRecords contacts{std::vector<Manifold>(pair_count),
                            std::vector<ManifoldPoint>(4 * pair_count),
                            std::vector<Separations>(pair_count),
                            std::vector<NormalImpulses>(pair_count),
                            std::vector<float>(4 * pair_count),
                            std::vector<BodyStart>(device.size(BufferId::Starts) / sizeof(BodyStart))};
    std::vector<ContactConstraint> constraints(simulation.kept_constraints());
    // The step's end has made its manifolds the old ones. Their impulses are what the next step starts from; those of
    // this one are still with the constraints, but for what sleeps.
    device.read(std::array{
        read_into(BufferId::OldManifolds, contacts.manifolds), read_into(BufferId::OldManifoldPoints, contacts.points),
        read_into(BufferId::OldPointSeparations, contacts.separations),
        read_into(BufferId::OldPointImpulses, contacts.next_impulses), read_into(BufferId::Constraints, constraints),
        read_into(BufferId::Starts, contacts.starts)});
    for (std::size_t i = 0; i < contacts.points.size(); ++i)
        contacts.impulses[i] = contacts.next_impulses[i / 4].normal[static_cast<int>(i % 4)];
    for (const ContactConstraint& c : constraints) {
        for (int i = 0; i < 4; ++i)
            contacts.impulses[std::size_t{4} * c.manifold + static_cast<std::size_t>(i)] = c.total_impulse[i];
    }
    return contacts;
}

} // namespace talus::engine
