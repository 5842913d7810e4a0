// SPDX-License-Identifier: MIT
// One table for each choice.
#include "cli/words.h"

#include <array>

namespace talus::cli {
namespace {

template <typename T> using Word = std::pair<std::string_view, T>;

constexpr std::array<Word<DeviceKind>, 4> k_devices{
    {{"auto", DeviceKind::Auto}, {"gpu", DeviceKind::Gpu}, {"cpu", DeviceKind::Cpu}, {"hybrid", DeviceKind::Hybrid}}};
constexpr std::array<Word<BroadPhase>, 4> k_broad_phases{{{"auto", BroadPhase::Auto},
                                                          {"sap", BroadPhase::SweepAndPrune},
                                                          {"bvh", BroadPhase::Bvh},
                                                          {"brute", BroadPhase::Brute}}};
constexpr std::array<Word<SolveOrder>, 2> k_solve_orders{
    {{"coloured", SolveOrder::Coloured}, {"sequential", SolveOrder::Sequential}}};
constexpr std::array<Word<Stabilisation>, 2> k_stabilisations{
    {{"soft", Stabilisation::Soft}, {"baumgarte", Stabilisation::Baumgarte}}};
constexpr std::array<Word<BodyKind>, 3> k_body_kinds{
    {{"static", BodyKind::Static}, {"dynamic", BodyKind::Rigid}, {"kinematic", BodyKind::Kinematic}}};

} // namespace

Words<DeviceKind> device_words() {
    return k_devices;
}
Words<BroadPhase> broad_phase_words() {
    return k_broad_phases;
}
Words<SolveOrder> solve_order_words() {
    return k_solve_orders;
}
Words<Stabilisation> stabilisation_words() {
    return k_stabilisations;
}
Words<BodyKind> body_kind_words() {
    return k_body_kinds;
}

} // namespace talus::cli
