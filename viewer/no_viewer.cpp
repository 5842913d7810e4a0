// SPDX-License-Identifier: MIT
// Stands in for the window where its libraries were not found when Talus was built.
#include <talus/types.h>

#include "viewer/viewer.h"

namespace talus::viewer {

void run_viewer(const ViewOptions&) {
    throw Error("view: this program was built without a window, as " TALUS_VIEWER_MISSING
                ". Without a window, `talus run SCENE --video FILE.mp4` or `--image FILE.png` shows a scene.");
}

} // namespace talus::viewer
