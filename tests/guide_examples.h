// SPDX-License-Identifier: MIT
// The pieces of C++ in docs/guide, as functions. tests/guide_test.cmake makes the file that defines them.
#pragma once

#include <span>

namespace talus::tests {

struct GuideExample {
    const char* page;
    void (*run)(); ///< null where it is compiled only
    void (*compiled_only)();
};

/// In the order of the pages' names, and on a page in that of the text.
std::span<const GuideExample> guide_examples();

} // namespace talus::tests
