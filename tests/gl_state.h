// SPDX-License-Identifier: MIT
// OpenGL's state as a caller may have set it: something is bound to every kind of binding point and every switch is
// unlike its default, and all of it can be compared.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <epoxy/gl.h>

namespace talus::tests {

inline constexpr GLuint k_indexed_points = 16;

/// The objects stay until the context is destroyed.
inline void set_unusual_gl_state() {
    const auto buffer = [](GLenum target) {
        GLuint name = 0;
        glGenBuffers(1, &name);
        glBindBuffer(target, name);
        glBufferData(target, 4096, nullptr, GL_STATIC_DRAW);
        return name;
    };
    GLuint name = 0;
    glGenVertexArrays(1, &name);
    glBindVertexArray(name);
    for (const GLenum target : {GL_ARRAY_BUFFER, GL_ELEMENT_ARRAY_BUFFER, GL_PIXEL_PACK_BUFFER, GL_PIXEL_UNPACK_BUFFER,
                                GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, GL_DRAW_INDIRECT_BUFFER, GL_TEXTURE_BUFFER,
                                GL_DISPATCH_INDIRECT_BUFFER, GL_QUERY_BUFFER})
        buffer(target);
    for (const GLenum target : {GL_SHADER_STORAGE_BUFFER, GL_UNIFORM_BUFFER}) {
        for (GLuint i = 0; i < k_indexed_points; ++i) {
            const GLuint each = buffer(target);
            if (i % 2 == 0)
                glBindBufferRange(target, i, each, 256 * (i % 4), 512);
            else
                glBindBufferBase(target, i, each);
        }
        buffer(target); // to the general point, unlike any indexed one
    }
    glBindBufferBase(GL_ATOMIC_COUNTER_BUFFER, 0, buffer(GL_ATOMIC_COUNTER_BUFFER));

    glGenFramebuffers(1, &name);
    glBindFramebuffer(GL_FRAMEBUFFER, name);
    glGenRenderbuffers(1, &name);
    glBindRenderbuffer(GL_RENDERBUFFER, name);
    glActiveTexture(GL_TEXTURE3);
    glGenTextures(1, &name);
    glBindTexture(GL_TEXTURE_2D, name);
    glGenSamplers(1, &name);
    glBindSampler(3, name);
    glGenTransformFeedbacks(1, &name);
    glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, name);

    const char* text = "#version 450 core\nlayout(local_size_x = 1) in; void main() {}";
    const GLuint shader = glCreateShader(GL_COMPUTE_SHADER), program = glCreateProgram();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
    glLinkProgram(program);
    glUseProgram(program);

    for (const GLenum flag : {GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_SCISSOR_TEST, GL_STENCIL_TEST,
                              GL_RASTERIZER_DISCARD, GL_PRIMITIVE_RESTART, GL_FRAMEBUFFER_SRGB})
        glEnable(flag);
    glViewport(1, 2, 3, 4);
    glScissor(5, 6, 7, 8);
    glClearColor(0.1f, 0.2f, 0.3f, 0.4f);
    glDepthMask(GL_FALSE);
    glColorMask(GL_TRUE, GL_FALSE, GL_TRUE, GL_FALSE);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 77);
}

/// Each item's values, by name.
using GlState = std::map<std::string, std::vector<std::int64_t>>;

inline GlState gl_state() {
    GlState state;
#define TALUS_ITEM(item, count)                                                                                        \
    {                                                                                                                  \
        std::array<GLint64, 4> values{};                                                                               \
        glGetInteger64v(item, values.data());                                                                          \
        state[#item].assign(values.begin(), values.begin() + (count));                                                 \
    }
    TALUS_ITEM(GL_VERTEX_ARRAY_BINDING, 1)
    TALUS_ITEM(GL_ARRAY_BUFFER_BINDING, 1)
    TALUS_ITEM(GL_ELEMENT_ARRAY_BUFFER_BINDING, 1)
    TALUS_ITEM(GL_PIXEL_PACK_BUFFER_BINDING, 1)
    TALUS_ITEM(GL_PIXEL_UNPACK_BUFFER_BINDING, 1)
    TALUS_ITEM(GL_COPY_READ_BUFFER_BINDING, 1)
    TALUS_ITEM(GL_COPY_WRITE_BUFFER_BINDING, 1)
    TALUS_ITEM(GL_DRAW_INDIRECT_BUFFER_BINDING, 1)
    TALUS_ITEM(GL_TEXTURE_BUFFER_BINDING, 1)
    TALUS_ITEM(GL_DISPATCH_INDIRECT_BUFFER_BINDING, 1)
    TALUS_ITEM(GL_QUERY_BUFFER_BINDING, 1)
    TALUS_ITEM(GL_SHADER_STORAGE_BUFFER_BINDING, 1)
    TALUS_ITEM(GL_UNIFORM_BUFFER_BINDING, 1)
    TALUS_ITEM(GL_ATOMIC_COUNTER_BUFFER_BINDING, 1)
    TALUS_ITEM(GL_DRAW_FRAMEBUFFER_BINDING, 1)
    TALUS_ITEM(GL_READ_FRAMEBUFFER_BINDING, 1)
    TALUS_ITEM(GL_RENDERBUFFER_BINDING, 1)
    TALUS_ITEM(GL_ACTIVE_TEXTURE, 1)
    TALUS_ITEM(GL_TEXTURE_BINDING_2D, 1)
    TALUS_ITEM(GL_SAMPLER_BINDING, 1)
    TALUS_ITEM(GL_TRANSFORM_FEEDBACK_BINDING, 1)
    TALUS_ITEM(GL_CURRENT_PROGRAM, 1)
    TALUS_ITEM(GL_PROGRAM_PIPELINE_BINDING, 1)
    TALUS_ITEM(GL_BLEND, 1)
    TALUS_ITEM(GL_CULL_FACE, 1)
    TALUS_ITEM(GL_DEPTH_TEST, 1)
    TALUS_ITEM(GL_SCISSOR_TEST, 1)
    TALUS_ITEM(GL_STENCIL_TEST, 1)
    TALUS_ITEM(GL_RASTERIZER_DISCARD, 1)
    TALUS_ITEM(GL_PRIMITIVE_RESTART, 1)
    TALUS_ITEM(GL_FRAMEBUFFER_SRGB, 1)
    TALUS_ITEM(GL_DEBUG_OUTPUT, 1)
    TALUS_ITEM(GL_DEBUG_OUTPUT_SYNCHRONOUS, 1)
    TALUS_ITEM(GL_DEBUG_GROUP_STACK_DEPTH, 1)
    TALUS_ITEM(GL_VIEWPORT, 4)
    TALUS_ITEM(GL_SCISSOR_BOX, 4)
    TALUS_ITEM(GL_COLOR_CLEAR_VALUE, 4)
    TALUS_ITEM(GL_DEPTH_WRITEMASK, 1)
    TALUS_ITEM(GL_COLOR_WRITEMASK, 4)
    TALUS_ITEM(GL_PACK_ALIGNMENT, 1)
    TALUS_ITEM(GL_UNPACK_ROW_LENGTH, 1)
#undef TALUS_ITEM
    struct Indexed {
        const char* name;
        std::array<GLenum, 3> items; // the buffer, where its range starts, and its size
    };
    constexpr std::array indexed{
        Indexed{"storage buffer ",
                {GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START, GL_SHADER_STORAGE_BUFFER_SIZE}},
        Indexed{"uniform buffer ", {GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE}},
    };
    for (const Indexed& point : indexed)
        for (GLuint i = 0; i < k_indexed_points; ++i)
            for (const GLenum item : point.items) {
                GLint64 value = 0;
                glGetInteger64i_v(item, i, &value);
                state[point.name + std::to_string(i)].push_back(value);
            }
    return state;
}

} // namespace talus::tests
