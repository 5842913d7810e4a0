// SPDX-License-Identifier: MIT
// The handler only sets a flag: hardly anything else is allowed in one.
#include "cli/interrupt.h"

#include <csignal>

namespace talus::cli {
namespace {

volatile std::sig_atomic_t interrupted = 0;

void remember(int signal) {
    interrupted = 1;
    std::signal(signal, SIG_DFL);
}

} // namespace

void catch_interrupts() {
    std::signal(SIGINT, remember);
    std::signal(SIGTERM, remember);
}

void check_interrupt() {
    if (interrupted != 0) throw Interrupted();
}

} // namespace talus::cli
