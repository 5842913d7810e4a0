// SPDX-License-Identifier: MIT
#include "viewer/frame_times.h"

#include <fmt/format.h>

#include "cli/timed_run.h"

namespace talus::viewer {

namespace {

double milliseconds(std::chrono::steady_clock::duration time) {
    return std::chrono::duration<double, std::milli>(time).count();
}

} // namespace

void FrameTimes::begin() {
    const Clock::time_point now = Clock::now();
    if (work_ms.empty())
        first = now;
    else
        whole_ms.push_back(milliseconds(now - last));
    last = now;
}

void FrameTimes::end_work() {
    work_ms.push_back(milliseconds(Clock::now() - last));
}

std::string FrameTimes::summary(double simulated) const {
    const double seconds = 1.0e-3 * milliseconds(Clock::now() - first);
    const cli::Statistics whole = cli::statistics_of(whole_ms), work = cli::statistics_of(work_ms);
    return fmt::format("{} frames in {:.1f} s: {:.1f} frames/s, {:.2f} ms of work a frame, {:.2f} × real time\n"
                       "ms from frame to frame: median {:.2f}, 95 % within {:.2f}, longest {:.2f}\n",
                       work_ms.size(), seconds, static_cast<double>(work_ms.size()) / seconds, work.mean,
                       simulated / seconds, whole.median, whole.p95, whole.max);
}

} // namespace talus::viewer
