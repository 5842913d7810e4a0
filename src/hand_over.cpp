// SPDX-License-Identifier: MIT
// One of the two devices keeps its buffers in host memory, so each copy is one transfer of the other one.
#include "hand_over.h"

#include <algorithm>

#include "step.h"

namespace talus::engine {
namespace {

void lend(Device& from, Device& to, BufferId buffer, std::size_t count) {
    const std::size_t stride = k_buffers[static_cast<std::size_t>(buffer)].stride;
    to.write(buffer, 0, {from.host_data(buffer), count * stride});
}

ReadRequest take(Device& to, BufferId buffer, std::size_t count) {
    const std::size_t stride = k_buffers[static_cast<std::size_t>(buffer)].stride;
    return {buffer, count * stride, to.host_data(buffer)};
}

/// Either way.
void copy(Device& from, Device& to, std::size_t count, std::initializer_list<BufferId> buffers) {
    if (count == 0) return;
    for (const BufferId buffer : buffers) {
        if (from.host_data(buffer) != nullptr)
            lend(from, to, buffer, count);
        else
            from.read(std::array{take(to, buffer, count)});
    }
}

/// Of a buffer that has room only where it is in use.
void copy_what_there_is(Device& from, Device& to, std::size_t count, BufferId buffer) {
    const std::size_t stride = k_buffers[static_cast<std::size_t>(buffer)].stride;
    copy(from, to, std::min({count, from.size(buffer) / stride, to.size(buffer) / stride}), {buffer});
}

void copy_old_contacts(Device& from, Device& to, uint pairs) {
    copy(from, to, pairs, {BufferId::OldManifolds, BufferId::OldPointImpulses, BufferId::OldPointSeparations});
    copy(from, to, std::size_t{4} * pairs, {BufferId::OldManifoldPoints});
}

uint counter(Device& device, uint word) {
    return reinterpret_cast<const uint*>(device.host_data(BufferId::Counters))[word];
}

} // namespace

void hand_over_counters(Device& from, Device& to) {
    lend(from, to, BufferId::Counters, k_counter_words);
}

void hand_over_bodies(Device& from, Device& to, const StepPlan& plan) {
    lend(from, to, BufferId::Poses, plan.body_count);
    lend(from, to, BufferId::Velocities, plan.body_count);
    lend(from, to, BufferId::Starts, plan.body_count);
}

void hand_over_manifolds(Device& from, Device& to) {
    const std::array control{take(to, BufferId::Counters, k_counter_words),
                             take(to, BufferId::Dispatches, k_dispatch_count)};
    from.read(control);
    const uint pair_count = counter(to, k_counter_pair_count);
    const std::array manifolds{take(to, BufferId::Manifolds, pair_count), take(to, BufferId::PointImpulses, pair_count),
                               take(to, BufferId::PointSeparations, pair_count),
                               take(to, BufferId::ManifoldPoints, std::size_t{4} * pair_count)};
    from.read(manifolds);
}

void hand_over_impulses(Device& from, Device& to) {
    if (counter(from, k_counter_did_not_fit) != 0) return; // the old ones are still wanted
    copy_old_contacts(from, to, counter(from, k_counter_old_pair_count));
}

void hand_over_places(Device& from, Device& to, uint slots) {
    lend(from, to, BufferId::Poses, slots);
    lend(from, to, BufferId::Starts, slots);
}

void hand_over_drawn(Device& from, Device& to, StateCounts counts) {
    copy(from, to, k_counter_words, {BufferId::Counters});
    copy(from, to, counts.slots, {BufferId::Poses, BufferId::Starts, BufferId::Shapes, BufferId::Aabbs});
    copy(from, to, counts.pairs, {BufferId::Pairs});
    copy_old_contacts(from, to, counts.pairs);
}

void hand_over_state(Device& from, Device& to, StateCounts counts) {
    static_assert(std::ranges::count(k_buffers, Role::State, &BufferInfo::role) == 15,
                  "another buffer survives the step");
    hand_over_drawn(from, to, counts);
    copy(from, to, counts.slots,
         {BufferId::Velocities, BufferId::Properties, BufferId::OrientedBoxes, BufferId::SortValues});
    copy_what_there_is(from, to, counts.slots, BufferId::Loads);
    copy_what_there_is(from, to, counts.slots, BufferId::Rests);
    copy_what_there_is(from, to, counts.pairs, BufferId::OldContactStates);
}

} // namespace talus::engine
