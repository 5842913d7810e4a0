// SPDX-License-Identifier: MIT
// The kernels of the scan, the sort and the scattering of records. Callers want primitives.h.
#pragma once

#include "device/device.h"

namespace talus::engine {

#include "primitives/primitives.shared.glsl"

extern const Kernel sum_tiles;
extern const Kernel scan_group;
extern const Kernel scan_tiles;
extern const Kernel count_digits;
extern const Kernel scatter_keys;
extern const Kernel sort_in_group;
extern const Kernel scatter_records;

/// Tiles that make a loop of a twin worth a second thread.
inline constexpr uint k_parallel_tiles = 16;

} // namespace talus::engine
