// SPDX-License-Identifier: MIT
// The handler only counts: hardly anything else is allowed in one.
#include "cli/interrupt.h"

#include <csignal>

namespace talus::cli {
namespace {

// timeout(1) sends its signal to the program and to the program's group: two at once are one wish.
constexpr int k_patience = 2;

volatile std::sig_atomic_t interrupts = 0;

void remember(int signal) {
    interrupts = interrupts + 1;
    if (interrupts >= k_patience) std::signal(signal, SIG_DFL);
}

} // namespace

void catch_interrupts() {
    std::signal(SIGINT, remember);
    std::signal(SIGTERM, remember);
}

void check_interrupt() {
    if (interrupts > 0) throw Interrupted();
}

} // namespace talus::cli
