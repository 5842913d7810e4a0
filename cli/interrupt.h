// SPDX-License-Identifier: MIT
// Ctrl+C ends a run between two steps, so that unfinished files are removed.
#pragma once

#include <stdexcept>

namespace talus::cli {

class Interrupted : public std::runtime_error {
public:
    Interrupted() : std::runtime_error("interrupted; no file was written") {}
};

/// From now on SIGINT and SIGTERM make `check_interrupt` throw; a third one ends the program at once.
void catch_interrupts();
void check_interrupt();

} // namespace talus::cli
