// SPDX-License-Identifier: MIT
// One hook of each kind for the whole process, as OpenGL's messages and failed assertions belong to no call on a world.
#include "log.h"

#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <utility>

#include <fmt/format.h>

namespace talus {
namespace {

struct Hooks {
    std::mutex log_mutex, assertion_mutex;
    LogHook log;
    AssertionHook assertion;
};

/// Never destroyed: worlds of static storage may have something to say after it would have been.
Hooks& hooks() {
    static Hooks& only = *new Hooks;
    return only;
}

void print(LogLevel level, std::string_view message) {
    if (level < LogLevel::Warning) return;
    std::fprintf(stderr, "talus: %.*s\n", static_cast<int>(message.size()), message.data());
}

} // namespace

void set_log_hook(LogHook hook) {
    const std::scoped_lock lock(hooks().log_mutex);
    hooks().log = std::move(hook);
}

void set_assertion_hook(AssertionHook hook) {
    const std::scoped_lock lock(hooks().assertion_mutex);
    hooks().assertion = std::move(hook);
}

namespace engine {

void log(LogLevel level, const std::string& message) {
    const std::scoped_lock lock(hooks().log_mutex);
    if (hooks().log)
        hooks().log(level, message);
    else
        print(level, message);
}

void assertion_failed(const char* condition, const char* file, int line, const std::string& message) {
    AssertionHook hook;
    {
        const std::scoped_lock lock(hooks().assertion_mutex);
        hook = hooks().assertion;
    }
    if (hook)
        hook({condition, file, line, message});
    else
        log(LogLevel::Error, fmt::format("{}:{}: {} ({} does not hold)", file, line, message, condition));
    std::abort();
}

} // namespace engine
} // namespace talus
