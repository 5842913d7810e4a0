// SPDX-License-Identifier: MIT
// The passes of a picture: fit the shadow map to what is in sight, fill it, draw the bodies, the background behind
// them, the overlays on top. Boxes are one instanced call, spheres another.
#include "render/painter.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "device/gl/gl_context.h"
#include "render/program.h"

namespace talus::render {

namespace {

// Bindings, as the shaders' layout qualifiers have them.
constexpr GLuint k_view = 0;
constexpr GLuint k_poses = 0, k_shapes = 1, k_slots = 2, k_tints = 3, k_shadow_bounds = 4, k_contacts = 5, k_lines = 6;

constexpr GLsizei k_box_indices = 36;

void set(GLuint program, const char* uniform, GLuint value) {
    glProgramUniform1ui(program, glGetUniformLocation(program, uniform), value);
}

void set(GLuint program, const char* uniform, GLint value) {
    glProgramUniform1i(program, glGetUniformLocation(program, uniform), value);
}

void set(GLuint program, const char* uniform, float value) {
    glProgramUniform1f(program, glGetUniformLocation(program, uniform), value);
}

void enable(GLenum capability, bool on) {
    on ? glEnable(capability) : glDisable(capability);
}

} // namespace

Painter::Painter() {
    // A software renderer pays for every texel that is filled and looked up.
    largest_shadow_size = engine::OpenGlContext::current()->is_software() ? 2048 : 4096;

    const auto drawn = {static_cast<GLenum>(GL_VERTEX_SHADER), static_cast<GLenum>(GL_FRAGMENT_SHADER)};
    fit = make_program("fit_shadow", {GL_COMPUTE_SHADER});
    box_shadow = make_program("box_shadow", drawn);
    sphere_shadow = make_program("sphere_shadow", drawn);
    box = make_program("box", drawn);
    sphere = make_program("sphere", drawn);
    background = make_program("background", drawn);
    aabb = make_program("aabb", drawn);
    contact = make_program("contact", drawn);
    line = make_program("line", drawn);

    std::array<std::uint16_t, k_box_indices> indices{};
    for (std::size_t i = 0; i < indices.size(); ++i) {
        constexpr std::array<std::uint16_t, 6> k_face{0, 1, 2, 2, 1, 3};
        indices[i] = static_cast<std::uint16_t>(4 * (i / 6) + k_face[i % 6]);
    }
    box_indices = make_buffer();
    glNamedBufferStorage(box_indices, sizeof indices, indices.data(), 0);
    no_vertices = make_vertex_array();
    glVertexArrayElementBuffer(no_vertices, box_indices);

    view_block = make_buffer();
    glNamedBufferStorage(view_block, sizeof(View), nullptr, GL_DYNAMIC_STORAGE_BIT);
    shadow_bounds = make_buffer();
    glNamedBufferStorage(shadow_bounds, 32, nullptr, GL_DYNAMIC_STORAGE_BIT);
    no_tints = make_buffer();
    glNamedBufferStorage(no_tints, 4, nullptr, 0);

    shadow_target = make_framebuffer();
    glNamedFramebufferDrawBuffer(shadow_target, GL_NONE);
}

// About twice as fine as the picture: finer is not seen, and costs as much as the bodies where a picture is small.
void Painter::size_shadow_map(GLint picture_height) {
    const GLint size = std::min(picture_height <= 1024 ? 2048 : 4096, largest_shadow_size);
    if (size == shadow_size) return;
    shadow_size = size;
    shadow_map = make_texture(GL_TEXTURE_2D);
    glTextureStorage2D(shadow_map, 1, GL_DEPTH_COMPONENT32F, size, size);
    glTextureParameteri(shadow_map, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(shadow_map, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTextureParameteri(shadow_map, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(shadow_map, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTextureParameteri(shadow_map, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTextureParameteri(shadow_map, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    glNamedFramebufferTexture(shadow_target, GL_DEPTH_ATTACHMENT, shadow_map, 0);
}

void Painter::paint(const View& camera, const Drawing& drawing) {
    GLint target = 0;
    std::array<GLint, 4> viewport{};
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
    glGetIntegerv(GL_VIEWPORT, viewport.data());

    size_shadow_map(viewport[3]);
    View view = camera;
    view.sizes.z = static_cast<float>(shadow_size);
    view.sizes.w = view.sizes.z / 1024.0f;
    glNamedBufferSubData(view_block, 0, sizeof(View), &view);
    glBindBufferBase(GL_UNIFORM_BUFFER, k_view, view_block);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, k_poses, drawing.poses);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, k_shapes, drawing.shapes);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, k_slots, drawing.slots);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, k_tints, drawing.tints != 0 ? drawing.tints : GLuint{no_tints});
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, k_shadow_bounds, shadow_bounds);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, k_contacts, drawing.contact_count > 0 ? drawing.contacts : 0);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, k_lines, drawing.line_count > 0 ? drawing.lines : 0);

    // What the caller may have left on.
    for (const GLenum capability :
         {GL_BLEND, GL_SCISSOR_TEST, GL_STENCIL_TEST, GL_RASTERIZER_DISCARD, GL_COLOR_LOGIC_OP})
        glDisable(capability);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_BACK);
    glFrontFace(GL_CCW);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);

    glBindVertexArray(no_vertices);
    fit_shadow(drawing.box_count + drawing.sphere_count);
    paint_shadow(drawing);

    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(target));
    glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
    constexpr float k_far = 1.0f;
    glClearBufferfv(GL_DEPTH, 0, &k_far);
    glBindTextureUnit(0, shadow_map);
    for (const GLuint program : {GLuint{box}, GLuint{sphere}}) {
        set(program, "tinted", drawing.tints != 0 ? 1 : 0);
        set(program, "wireframe", drawing.wireframe ? 1 : 0);
        set(program, "transparent_static", drawing.transparent_static ? 1 : 0);
    }
    enable(GL_CULL_FACE, !drawing.wireframe);
    glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE); // what is transparent needs no order then
    draw_boxes(box, drawing);
    glEnable(GL_CULL_FACE);
    draw_spheres(sphere, drawing);
    glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);

    glUseProgram(background);
    glDrawArrays(GL_TRIANGLES, 0, 3);

    if (drawing.aabbs) {
        glUseProgram(aabb);
        set(aabb, "first_instance", 0u);
        glEnable(GL_BLEND);
        glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
        glDrawArraysInstanced(GL_LINES, 0, 24, static_cast<GLsizei>(drawing.box_count + drawing.sphere_count));
    }
    if (drawing.line_count > 0) {
        set(line, "pixel_scale", drawing.pixel_scale);
        paint_over(line, drawing.line_count);
    }
    if (drawing.contact_count > 0) paint_over(contact, drawing.contact_count);
    glBindVertexArray(0);
    glUseProgram(0);
}

void Painter::fit_shadow(std::uint32_t body_count) {
    constexpr std::array<std::uint32_t, 8> k_empty{~0u, ~0u, ~0u, ~0u, 0, 0, 0, 0};
    glNamedBufferSubData(shadow_bounds, 0, sizeof k_empty, k_empty.data());
    if (body_count == 0) return;
    const GLuint groups = (body_count + 63) / 64;
    constexpr GLuint k_row = 32768; // OpenGL allows 65,535 groups a dimension
    glUseProgram(fit);
    set(fit, "first_instance", 0u);
    set(fit, "body_count", body_count);
    glDispatchCompute(groups < k_row ? groups : k_row, (groups + k_row - 1) / k_row, 1);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void Painter::paint_shadow(const Drawing& drawing) {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, shadow_target);
    glViewport(0, 0, shadow_size, shadow_size);
    constexpr float k_far = 1.0f;
    glClearBufferfv(GL_DEPTH, 0, &k_far);
    glEnable(GL_DEPTH_CLAMP);
    glEnable(GL_POLYGON_OFFSET_FILL);
    glPolygonOffset(1.5f, 2.0f);
    draw_boxes(box_shadow, drawing);
    draw_spheres(sphere_shadow, drawing);
    glDisable(GL_POLYGON_OFFSET_FILL);
    glDisable(GL_DEPTH_CLAMP);
}

void Painter::draw_boxes(GLuint program, const Drawing& drawing) {
    if (drawing.box_count == 0) return;
    glUseProgram(program);
    set(program, "first_instance", 0u);
    glDrawElementsInstanced(GL_TRIANGLES, k_box_indices, GL_UNSIGNED_SHORT, nullptr,
                            static_cast<GLsizei>(drawing.box_count));
}

void Painter::draw_spheres(GLuint program, const Drawing& drawing) {
    if (drawing.sphere_count == 0) return;
    glUseProgram(program);
    set(program, "first_instance", drawing.box_count);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(drawing.sphere_count));
}

void Painter::paint_over(GLuint program, std::uint32_t count) {
    glUseProgram(program);
    glEnable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glDepthMask(GL_FALSE);
    // First all of them, faintly; then those that nothing hides, in full.
    for (const bool hidden : {true, false}) {
        enable(GL_DEPTH_TEST, !hidden);
        set(program, "opacity", hidden ? 0.3f : 1.0f);
        glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(count));
    }
    glDepthMask(GL_TRUE);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
    glDisable(GL_BLEND);
}

} // namespace talus::render
