// SPDX-License-Identifier: MIT
// What the graphs show: figures of the last steps.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <vector>

#include <talus/world.h>

namespace talus::viewer {

/// The last values of a figure, oldest first.
class Curve {
public:
    static constexpr std::size_t k_length = 240;

    void add(float value);
    const std::vector<float>& values() const noexcept { return kept; }
    float newest() const noexcept { return kept.empty() ? 0.0f : kept.back(); }
    float largest() const noexcept;
    /// Of the last values, a quarter of a second's.
    float mean() const noexcept;

private:
    std::vector<float> kept;
};

/// J: of motion with rotation, and of height over y = 0 under the world's gravity; bodies that can be pushed.
struct Energy {
    double kinetic = 0.0, potential = 0.0;
};
Energy energy_of(const World&);

class Measurements {
public:
    /// Takes the figures of the last step, where it is a new one. Energy reads all bodies back, and is taken less
    /// often.
    void update(const World&);

    Curve step_ms, pairs, contacts, colours, substeps, kinetic, total;
    std::vector<Curve> stage_ms; ///< in the order of stage_names()
    MemoryUse memory;

private:
    std::uint64_t step = 0;
    std::chrono::steady_clock::time_point next_energy;
};

} // namespace talus::viewer
