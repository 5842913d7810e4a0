// SPDX-License-Identifier: MIT
// Draws bodies from buffers. It neither knows a world nor cares who filled the buffers.
#pragma once

#include <cstdint>

#include "render/gl_names.h"
#include "render/view.h"

namespace talus::render {

/// OpenGL names and counts of what to draw.
struct Drawing {
    GLuint poses = 0;    ///< BodyPose a body slot
    GLuint shapes = 0;   ///< BodyShape a body slot
    GLuint slots = 0;    ///< uint: the body slots to draw, first boxes, then spheres
    GLuint tints = 0;    ///< uint a body slot: a colour (overlay_lines.h), or 0 for its own; 0: all have their own
    GLuint contacts = 0; ///< vec4: xyz a contact point, world (m)
    GLuint lines = 0;    ///< Line (overlay_lines.h)
    std::uint32_t box_count = 0, sphere_count = 0, contact_count = 0, line_count = 0;
    bool aabbs = false; ///< draw bounding boxes
    bool wireframe = false, transparent_static = false;
    float pixel_scale = 1.0f; ///< pixels for one of a usual screen
};

class Painter {
public:
    Painter();
    /// Into the framebuffer and viewport that are bound. Leaves other OpenGL state as it happens to be.
    void paint(const View&, const Drawing&);

private:
    void size_shadow_map(GLint picture_height);
    void fit_shadow(std::uint32_t body_count);
    void paint_shadow(const Drawing&);
    void paint_over(GLuint program, std::uint32_t count);
    void draw_boxes(GLuint program, const Drawing&);
    void draw_spheres(GLuint program, const Drawing&);

    GLint shadow_size = 0; ///< texels a side
    GLint largest_shadow_size = 0;
    Program fit, box_shadow, sphere_shadow, box, sphere, background, aabb, contact, line;
    // Every shader makes its vertices from their number; only boxes, which share corners within a face, have indices.
    VertexArray no_vertices;
    Buffer box_indices, view_block, shadow_bounds, no_tints;
    Texture shadow_map;
    Framebuffer shadow_target;
};

} // namespace talus::render
