// SPDX-License-Identifier: MIT
// Marks what a shared library of Talus shows; everything else in it is hidden.
#pragma once

#if defined(__GNUC__)
#define TALUS_API __attribute__((visibility("default")))
#else
#define TALUS_API
#endif
