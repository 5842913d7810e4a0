// SPDX-License-Identifier: MIT
// The environment that a test runs in.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

namespace talus::tests {

/// An environment variable as the test wants it, and afterwards as it was.
class Variable {
public:
    Variable(const char* variable, const std::string& value) : name(variable) {
        if (const char* set = std::getenv(name)) before = set;
        setenv(name, value.c_str(), 1);
    }
    ~Variable() {
        if (before)
            setenv(name, before->c_str(), 1);
        else
            unsetenv(name);
    }
    Variable(const Variable&) = delete;
    Variable& operator=(const Variable&) = delete;

private:
    const char* name;
    std::optional<std::string> before;
};

} // namespace talus::tests
