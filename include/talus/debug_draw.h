// SPDX-License-Identifier: MIT
// A world drawn in lines, points and text, by whatever the program draws with.
#pragma once

#include <string_view>

#include <talus/export.h>
#include <talus/types.h>
#include <talus/world.h>

namespace talus {

/// Linear, 0 to 1.
struct Colour {
    float red = 1.0f;   ///< 0 to 1
    float green = 1.0f; ///< 0 to 1
    float blue = 1.0f;  ///< 0 to 1
    float alpha = 1.0f; ///< 0 transparent, 1 opaque
};

/// Implemented by whoever can draw. All positions are in world space (m).
class TALUS_API DebugDraw {
public:
    virtual ~DebugDraw();
    /// A straight line between two points.
    virtual void line(Vec3 from, Vec3 to, const Colour& colour) = 0;
    /// A point, `size` pixels wide.
    virtual void point(Vec3 position, float size, const Colour& colour) = 0;
    /// A line of UTF-8 that begins at a position.
    virtual void text(Vec3 position, std::string_view text, const Colour& colour) = 0;
};

/// What draw_debug draws.
struct DebugDrawOptions {
    bool shapes = true;          ///< edges of boxes, three circles of spheres; the colour tells the body's kind
    bool aabbs = false;          ///< the world bounding boxes, without the margin that the broad phase adds
    bool pairs = false;          ///< red lines between the centres of bodies that the broad phase found
    bool contacts = true;        ///< contact points, and their normals as lines of `normal_length`
    bool impulses = false;       ///< normal impulses as lines of `impulse_scale` metres a newton second
    bool velocities = false;     ///< linear velocities as lines of `velocity_scale` metres a metre a second
    bool indices = false;        ///< each body's index as text at its centre
    float normal_length = 0.2f;  ///< m
    float impulse_scale = 0.01f; ///< m/(N·s)
    float velocity_scale = 0.1f; ///< s
};

/// Draws the world as it is after the last step; waits for it, and reads its results back.
TALUS_API void draw_debug(const World&, DebugDraw&, const DebugDrawOptions& options = {});

} // namespace talus
