// SPDX-License-Identifier: MIT
// Every shared formula, for C++.
#pragma once

#include "narrow_phase/polygon.h"
#include "state/buffers.h"

// Formulas that run on several items side by side (device/cpu/lanes.h) choose by these instead of by ?: and if. For one
// item they are the same; choose_active() stands where one item is known to fulfil the condition, holds_here() where it
// need not even be asked, which GLSL is told.
#define choose(condition, yes, no) ((condition) ? (yes) : (no))
#define choose_active(condition, yes, no) (yes)
#define holds_here(condition) (condition)
#define all_lanes(condition) (condition)
#define any_lane(condition) (condition)

namespace talus::engine {

#include "state/math.shared.glsl"

#include "state/dispatch.shared.glsl"

#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"
#include "broad_phase/strays.shared.glsl"
#include "broad_phase/sweep_axis.shared.glsl"
#include "resolution/sleep.shared.glsl"

#include "broad_phase/curve.shared.glsl"
#include "broad_phase/tree.shared.glsl"

#include "resolution/contact_counts.shared.glsl"
#include "resolution/contact_frame.shared.glsl"
#include "resolution/load.shared.glsl"
#include "resolution/softness.shared.glsl"
#include "resolution/stamp.shared.glsl"

#include "resolution/multirate.shared.glsl"

#include "narrow_phase/contact_geometry.shared.glsl"

#include "narrow_phase/box_axes.shared.glsl"
#include "narrow_phase/collide_boxes.shared.glsl"
#include "narrow_phase/collide_spheres.shared.glsl"

#include "narrow_phase/carried_impulses.shared.glsl"
#include "narrow_phase/collide_shapes.shared.glsl"
#include "narrow_phase/manifold.shared.glsl"
#include "narrow_phase/pair_table.shared.glsl"

#include "narrow_phase/look_ahead.shared.glsl"

#include "finish/body_start.shared.glsl"
#include "narrow_phase/lasting_contact.shared.glsl"

#include "resolution/body.shared.glsl"
#include "resolution/colouring.shared.glsl"
#include "resolution/hub_load.shared.glsl"
#include "resolution/manifold_rows.shared.glsl"

#include "resolution/contact.shared.glsl"
#include "resolution/hub.shared.glsl"

#include "resolution/island.shared.glsl"

#include "resolution/balance.shared.glsl"
#include "resolution/contact_constraint.shared.glsl"
#include "resolution/hit.shared.glsl"

#include "finish/contact_report.shared.glsl"

} // namespace talus::engine

#undef choose
#undef choose_active
#undef holds_here
#undef all_lanes
#undef any_lane
