// SPDX-License-Identifier: MIT
// Which Talus this is.
#pragma once

#include <talus/export.h>

namespace talus {

/// The version of the library that the program runs with: "major.minor.patch".
TALUS_API const char* version() noexcept;

} // namespace talus
