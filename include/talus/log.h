// SPDX-License-Identifier: MIT
// What Talus has to say, and what it does where it finds itself in the wrong: both can be taken over. What a caller did
// wrong is not said here, but thrown as an Error.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

#include <talus/export.h>

namespace talus {

/// How grave a message is.
enum class LogLevel : std::uint32_t {
    Debug,   ///< of use to those who work on Talus
    Info,    ///< which device was taken, which buffers have grown
    Warning, ///< a body was frozen; OpenGL warns
    Error,   ///< OpenGL reports an error; an assertion failed
};

/// Gets each message, one line without its end. May be called from any thread that calls Talus, one call at a time;
/// must not call Talus, and must not throw.
using LogHook = std::function<void(LogLevel, std::string_view message)>;

/// From now on messages go to `hook`, those of all worlds. An empty one brings back the default, which prints warnings
/// and errors to stderr and keeps quiet about the rest.
TALUS_API void set_log_hook(LogHook hook);

/// A condition that had to hold and did not: a fault of Talus, never of its caller.
struct FailedAssertion {
    const char* condition = ""; ///< as it stands in the source
    const char* file = "";      ///< of the source
    int line = 0;               ///< in that file
    std::string_view message;   ///< what does not hold, in words; valid during the call
};

/// Is called where an assertion fails. If it returns, the program is aborted; it may throw instead, and the world that
/// the call was for is then good for nothing but its destructor.
using AssertionHook = std::function<void(const FailedAssertion&)>;

/// An empty hook brings back the default: an error in the log, and the end of the program.
TALUS_API void set_assertion_hook(AssertionHook hook);

} // namespace talus
