// SPDX-License-Identifier: MIT
// Messages for people, and conditions that must hold (include/talus/log.h).
#pragma once

#include <string>

#include <talus/log.h>

namespace talus::engine {

void log(LogLevel, const std::string& message);

/// Tells the hook, and does not return unless the hook throws.
[[noreturn]] void assertion_failed(const char* condition, const char* file, int line, const std::string& message);

} // namespace talus::engine

/// For what only a fault of Talus can break. It is checked in every build, so it must cost little.
#define TALUS_ASSERT(condition, message)                                                                               \
    ((condition) ? static_cast<void>(0) : ::talus::engine::assertion_failed(#condition, __FILE__, __LINE__, (message)))
