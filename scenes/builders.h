// SPDX-License-Identifier: MIT
// The built-in scenes, one function each. scene.cpp lists them with their parameters.
#pragma once

#include "scenes/parameters.h"
#include "scenes/scene.h"

namespace talus::scenes {

// stacks.cpp: regular arrangements that stand from the start
Scene make_stack(const Parameters&);
Scene make_pyramid(const Parameters&);
Scene make_wall(const Parameters&);
Scene make_columns(const Parameters&);
Scene make_grid(const Parameters&);

// extreme_stack.cpp
Scene make_extreme_stack(const Parameters&);

// pours.cpp: boxes that fall into a basin
Scene make_pool(const Parameters&);
Scene make_pile(const Parameters&);

} // namespace talus::scenes
