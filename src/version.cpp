// SPDX-License-Identifier: MIT
#include <talus/version.h>

namespace talus {

const char* version() noexcept {
    return TALUS_VERSION; // version.txt
}

} // namespace talus
