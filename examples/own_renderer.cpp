// SPDX-License-Identifier: MIT
// A renderer that is not Talus's: it has a context of its own, hands it to Talus, and draws boxes with its own shader
// straight from the solver's buffers. Nothing is copied. Writes the last frame to own_renderer.ppm.
#include <cstdio>
#include <fstream>

#include <talus/talus.h>

#include "headless_context.h"

namespace {

constexpr int k_width = 640, k_height = 360;

// One instance is a body slot, and 36 vertices are a cube. GlBuffers in talus/world.h says what the buffers hold.
constexpr const char* k_vertex_shader = R"(#version 450 core
struct Pose { vec3 position; uint flags; vec4 rotation; };
struct Shape { vec3 half_extents; uint word; };
layout(std430, binding = 0) readonly buffer Poses { Pose poses[]; };
layout(std430, binding = 1) readonly buffer Shapes { Shape shapes[]; };
layout(location = 0) uniform float aspect;
out vec3 colour;

vec3 turned(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }

void main()
{
    Pose pose = poses[gl_InstanceID];
    Shape shape = shapes[gl_InstanceID];
    uint kind = (shape.word >> 8) & 255u;
    int side = gl_VertexID / 6, axis = side / 2;
    vec2 corner = vec2[](vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, -1), vec2(1, 1), vec2(-1, 1))[gl_VertexID % 6];
    vec3 normal = vec3(0.0), at;
    normal[axis] = side % 2 == 0 ? 1.0 : -1.0;
    at[axis] = normal[axis];
    at[(axis + 1) % 3] = corner.x * normal[axis];
    at[(axis + 2) % 3] = corner.y;
    vec3 world = pose.position + turned(pose.rotation, at * shape.half_extents);
    float light = 0.3 + 0.7 * max(0.0, dot(turned(pose.rotation, normal), normalize(vec3(0.4, 1.0, 0.6))));
    colour = light * (kind == 0u ? vec3(0.45) : fract(vec3(0.3, 0.6, 0.9) + 0.37 * float(gl_InstanceID)));

    vec3 eye = world - vec3(0.0, 6.0, 16.0); // the camera looks down by 0.25 rad
    eye = vec3(eye.x, 0.969 * eye.y - 0.247 * eye.z, 0.247 * eye.y + 0.969 * eye.z);
    gl_Position = kind == 255u ? vec4(2.0) // an empty slot
                               : vec4(2.0 * eye.x / aspect, 2.0 * eye.y, -1.002 * eye.z - 0.2, -eye.z);
})";

constexpr const char* k_fragment_shader = R"(#version 450 core
in vec3 colour;
out vec4 pixel;
void main() { pixel = vec4(colour, 1.0); })";

GLuint make_program() {
    const GLuint program = glCreateProgram();
    for (const auto& [stage, text] :
         {std::pair{GL_VERTEX_SHADER, k_vertex_shader}, std::pair{GL_FRAGMENT_SHADER, k_fragment_shader}}) {
        const GLuint shader = glCreateShader(stage);
        glShaderSource(shader, 1, &text, nullptr);
        glCompileShader(shader);
        glAttachShader(program, shader);
        glDeleteShader(shader);
    }
    glLinkProgram(program);
    GLint linked = GL_FALSE;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (linked == GL_FALSE) throw std::runtime_error("the shaders do not link");
    return program;
}

void make_frame_buffer() {
    GLuint frame = 0, colour = 0, depth = 0, no_vertices = 0;
    glGenFramebuffers(1, &frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glCreateRenderbuffers(1, &colour);
    glNamedRenderbufferStorage(colour, GL_RGBA8, k_width, k_height);
    glNamedFramebufferRenderbuffer(frame, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour);
    glCreateRenderbuffers(1, &depth);
    glNamedRenderbufferStorage(depth, GL_DEPTH_COMPONENT24, k_width, k_height);
    glNamedFramebufferRenderbuffer(frame, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
    glGenVertexArrays(1, &no_vertices);
    glBindVertexArray(no_vertices);
    glViewport(0, 0, k_width, k_height);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_CULL_FACE);
}

void draw(const talus::World& world, GLuint program) {
    const talus::GlBuffers buffers = world.gl_buffers(); // anew each time: buffers may have grown
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffers.poses);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, buffers.shapes);
    glUseProgram(program);
    glUniform1f(0, static_cast<float>(k_width) / k_height);
    glClearColor(0.75f, 0.85f, 0.95f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glDrawArraysInstanced(GL_TRIANGLES, 0, 36, static_cast<GLsizei>(buffers.body_capacity));
}

void simulate_and_draw() {
    const GLuint program = make_program();
    make_frame_buffer();
    talus::WorldOptions options;
    options.device = talus::DeviceKind::Gpu;
    options.gl_context = talus::GlContext::Current;
    talus::World world({}, options);
    talus::BodyDefinition body;
    body.kind = talus::BodyKind::Static;
    body.shape = talus::Box{{14.0f, 1.0f, 10.0f}};
    body.pose.position = {0.0f, -0.5f, 0.0f};
    world.add(body);
    body.kind = talus::BodyKind::Rigid;
    body.shape = talus::Box{};
    for (int row = 0; row < 8; ++row)
        for (int i = 0; i < 8 - row; ++i) {
            body.pose.position = {1.05f * static_cast<float>(i) - 0.52f * static_cast<float>(7 - row),
                                  0.5f + static_cast<float>(row), 0.0f};
            world.add(body);
        }
    for (int frame = 0; frame < 30; ++frame) {
        world.step(); // the state that draw() has set is as it was
        draw(world, program);
    }
    std::vector<unsigned char> row(3 * k_width);
    std::ofstream file("own_renderer.ppm", std::ios::binary);
    file << "P6 " << k_width << " " << k_height << " 255\n";
    for (int y = k_height - 1; y >= 0; --y) {
        glReadPixels(0, y, k_width, 1, GL_RGB, GL_UNSIGNED_BYTE, row.data());
        file.write(reinterpret_cast<const char*>(row.data()), static_cast<std::streamsize>(row.size()));
    }
    std::printf("30 frames drawn on %s\n", world.device().name.c_str());
}

} // namespace

int main() {
    try {
        const HeadlessContext context;
        context.make_current();
        simulate_and_draw();
    } catch (const std::exception& error) {
        std::fprintf(stderr, "own_renderer: %s\n", error.what());
        return 1;
    }
}
