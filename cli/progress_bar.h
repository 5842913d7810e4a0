// SPDX-License-Identifier: MIT
// How far a run has come, on one line of a terminal.
#pragma once

#include <chrono>
#include <cstdint>

namespace talus::cli {

/// Draws on standard error, and only where that is a terminal; the line is cleared at the end.
class ProgressBar {
public:
    ProgressBar(std::uint32_t total, bool wanted);
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    void show(std::uint32_t done);

private:
    using Clock = std::chrono::steady_clock;
    std::uint32_t total;
    bool active;
    Clock::time_point start = Clock::now();
    Clock::time_point last_drawn;
};

} // namespace talus::cli
