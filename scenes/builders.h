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
Scene make_many_pyramids(const Parameters&);
Scene make_worlds(const Parameters&);

// extreme_stack.cpp
Scene make_extreme_stack(const Parameters&);

// card_house.cpp, dominoes.cpp, slope.cpp
Scene make_card_house(const Parameters&);
Scene make_dominoes(const Parameters&);
Scene make_slope(const Parameters&);

// loads.cpp: heavy bodies on light ones
Scene make_plate(const Parameters&);
Scene make_heavy_on_light(const Parameters&);

// bricks.cpp: large structures of bricks, hit by spheres
Scene make_brick_ring(const Parameters&);
Scene make_brick_gables(const Parameters&);

// pours.cpp: boxes that fall into a basin
Scene make_pool(const Parameters&);
Scene make_pile(const Parameters&);
Scene make_rubble(const Parameters&);

} // namespace talus::scenes
