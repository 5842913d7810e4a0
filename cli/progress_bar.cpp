// SPDX-License-Identifier: MIT
// Redrawn ten times a second at most, so that it costs nothing beside short steps.
#include "cli/progress_bar.h"

#include <cstdio>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

namespace talus::cli {
namespace {

constexpr int k_width = 40;
constexpr std::chrono::milliseconds k_interval{100};

} // namespace

ProgressBar::ProgressBar(std::uint32_t total_steps, bool wanted)
    : total(total_steps), active(wanted && total_steps > 0 && isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
    if (active) fmt::print(stderr, "\r\033[K");
}

void ProgressBar::show(std::uint32_t done) {
    if (!active) return;
    const Clock::time_point now = Clock::now();
    if (now - last_drawn < k_interval) return;
    last_drawn = now;
    const double fraction = static_cast<double>(done) / total;
    const std::string bar(static_cast<std::size_t>(fraction * k_width), '#');
    const double seconds = std::chrono::duration<double>(now - start).count();
    fmt::print(stderr, "\r[{:.<{}}] step {} of {}, {:.0f} s left\033[K", bar, k_width, done, total,
               done > 0 ? seconds / done * (total - done) : 0.0);
    std::fflush(stderr);
}

} // namespace talus::cli
