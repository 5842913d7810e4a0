// SPDX-License-Identifier: MIT
// Shared formulas of the narrow phase, of the solver and of the end of a step, on several items at once: the same
// files, with lanes for numbers. What a formula decides item by item it has to say by choose(), all_lanes() and
// any_lane(); one that does not can be compiled, but not be linked.
#pragma once

#include "device/cpu/lanes.h"
#include "state/formulas.h"

namespace talus::engine::TALUS_LANES_NAME {

/// A vector of the step's constants.
TALUS_LANE vec3 operator*(glm::vec3 a, Lanes b) {
    return vec3(a) * b;
}

#pragma GCC diagnostic push
#if defined(__clang__)
#pragma GCC diagnostic ignored "-Wkeyword-macro" // what is to be done here
#endif
#define choose_active choose
#define holds_here(condition) (condition)
#define float Lanes
#define uint ULanes
#define bool Mask
#define inline [[gnu::always_inline]] inline

#define Parameters ParametersOfLanes
#include "state/records.shared.glsl"
#undef Parameters
using engine::Parameters; // the same for all lanes

#include "state/math.shared.glsl"

#include "broad_phase/aabb.shared.glsl"
#include "broad_phase/oriented_box.shared.glsl"

#include "resolution/contact_counts.shared.glsl"
#include "resolution/contact_frame.shared.glsl"
#include "resolution/load.shared.glsl"
#include "resolution/softness.shared.glsl"

#include "resolution/multirate.shared.glsl"

#include "resolution/body.shared.glsl"
#include "resolution/hub.shared.glsl"
#include "resolution/manifold_rows.shared.glsl"

inline Axes choose(bool m, const Axes& yes, const Axes& no) {
    return {choose(m, yes.x, no.x), choose(m, yes.y, no.y), choose(m, yes.z, no.z)};
}
inline BoxPair choose(bool m, const BoxPair& yes, const BoxPair& no) {
    return {choose(m, yes.a, no.a), choose(m, yes.b, no.b), choose(m, yes.half_a, no.half_a),
            choose(m, yes.half_b, no.half_b), choose(m, yes.offset, no.offset)};
}

#include "narrow_phase/contact_geometry.shared.glsl"
inline Carriers choose(bool m, const Carriers& yes, const Carriers& no) {
    Carriers chosen;
    chosen.axis = choose(m, yes.axis, no.axis);
    chosen.features[0] = choose(m, yes.features[0], no.features[0]);
    chosen.features[1] = choose(m, yes.features[1], no.features[1]);
    chosen.features[2] = choose(m, yes.features[2], no.features[2]);
    chosen.features[3] = choose(m, yes.features[3], no.features[3]);
    return chosen;
}
inline ContactGeometry choose(bool m, const ContactGeometry& yes, const ContactGeometry& no) {
    ContactGeometry chosen;
    chosen.normal = choose(m, yes.normal, no.normal);
    chosen.axis = choose(m, yes.axis, no.axis);
    chosen.shift = choose(m, yes.shift, no.shift);
    chosen.separation = choose(m, yes.separation, no.separation);
    chosen.count = choose(m, yes.count, no.count);
    const auto choose_point = [&](int i) __attribute__((always_inline)) {
        chosen.points[i] = choose(m, yes.points[i], no.points[i]);
        chosen.separations[i] = choose(m, yes.separations[i], no.separations[i]);
        chosen.features[i] = choose(m, yes.features[i], no.features[i]);
    };
    choose_point(0);
    choose_point(1);
    choose_point(2);
    choose_point(3);
    return chosen;
}

struct AxisQuery;
inline AxisQuery choose(bool, const AxisQuery&, const AxisQuery&);
#include "narrow_phase/box_axes.shared.glsl"
inline AxisQuery choose(bool m, const AxisQuery& yes, const AxisQuery& no) {
    return {choose(m, yes.separation, no.separation), choose(m, yes.score, no.score), choose(m, yes.axis, no.axis)};
}

#include "narrow_phase/lane_polygon.h"

#include "narrow_phase/collide_boxes.shared.glsl"

#include "narrow_phase/manifold.shared.glsl"

#include "finish/body_start.shared.glsl"
#include "narrow_phase/lasting_contact.shared.glsl"

struct NormalSweep;
inline NormalSweep choose(bool, const NormalSweep&, const NormalSweep&);
#include "resolution/contact.shared.glsl"
inline NormalSweep choose(bool m, const NormalSweep& yes, const NormalSweep& no) {
    return {choose(m, yes.velocity, no.velocity), choose(m, yes.impulse, no.impulse)};
}
#include "resolution/island.shared.glsl"

#include "resolution/contact_constraint.shared.glsl"

#undef choose_active
#undef holds_here
#undef float
#undef uint
#undef bool
#undef inline
#pragma GCC diagnostic pop

} // namespace talus::engine::TALUS_LANES_NAME
