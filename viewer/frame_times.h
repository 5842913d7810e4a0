// SPDX-License-Identifier: MIT
// How many frames there were, and how long they took.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace talus::viewer {

class FrameTimes {
public:
    void begin();
    /// What comes until the next frame begins is waiting.
    void end_work();
    /// For people, of the frames until now. `simulated`: seconds that they played.
    std::string summary(double simulated) const;

private:
    using Clock = std::chrono::steady_clock;

    Clock::time_point first, last;         ///< beginnings of frames
    std::vector<double> work_ms, whole_ms; ///< of each frame; the newest has no whole yet
};

} // namespace talus::viewer
