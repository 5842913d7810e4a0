// SPDX-License-Identifier: MIT
// A shader is put together from the solver's own records, the files that all shaders of the renderer share, and its own
// file.
#include "render/program.h"

#include <algorithm>
#include <string>

#include <talus/types.h>

namespace talus::render {

namespace {

std::string_view find_text(std::span<const engine::ShaderFile> files, std::string_view path) {
    const auto found = std::ranges::find(files, path, &engine::ShaderFile::path);
    if (found == files.end()) throw Error("the shader file " + std::string(path) + " is not embedded in the program");
    return found->text;
}

const char* ending_of(GLenum stage) {
    return stage == GL_VERTEX_SHADER ? ".vert.glsl" : stage == GL_FRAGMENT_SHADER ? ".frag.glsl" : ".comp.glsl";
}

/// Adds a file, and in the place of each of its #include lines the file that it names, each file once.
void splice(engine::KernelSource& source, std::string_view text, const std::string& path) {
    constexpr std::string_view k_include = "#include \"";
    const std::size_t file = source.files.size();
    source.files.push_back(path);
    std::size_t number = 0;
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        ++number;
        if (line.starts_with(k_include)) {
            const std::string included(line.substr(k_include.size(), line.rfind('"') - k_include.size()));
            if (std::ranges::find(source.files, included) == source.files.end())
                splice(source, find_text(embedded_shaders(), included), included);
        } else {
            source.text.append(line).push_back('\n');
            source.lines.push_back({file, number});
        }
    }
}

GLuint compile(GLenum stage, std::string_view name) {
    const std::string own = "shaders/" + std::string(name) + ending_of(stage);
    engine::KernelSource source;
    // Only the kernel that fits the shadow map writes its bounds.
    splice(source,
           stage == GL_COMPUTE_SHADER ? "#version 450 core\n#define inline\n#define WRITES_SHADOW_BOUNDS\n"
                                      : "#version 450 core\n#define inline\n",
           "prelude");
    for (const char* shared : {"state/constants.shared.glsl", "state/records.shared.glsl"})
        splice(source, find_text(engine::embedded_files(), shared), shared);
    for (const std::string& path : {std::string("shaders/view.glsl"), std::string("shaders/shadow_bounds.glsl"), own})
        splice(source, find_text(embedded_shaders(), path), path);

    const GLuint shader = glCreateShader(stage);
    const char* start = source.text.c_str();
    glShaderSource(shader, 1, &start, nullptr);
    glCompileShader(shader);
    GLint compiled = 0, length = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (compiled) return shader;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    glGetShaderInfoLog(shader, length, nullptr, log.data());
    glDeleteShader(shader);
    throw Error("the shader " + own + " does not compile on this OpenGL driver:\n" + engine::trace_log(log, source));
}

} // namespace

Program make_program(std::string_view name, std::initializer_list<GLenum> stages) {
    Program program(glCreateProgram());
    for (const GLenum stage : stages) {
        const GLuint shader = compile(stage, name);
        glAttachShader(program, shader);
        glDeleteShader(shader); // goes with the program
    }
    glLinkProgram(program);
    GLint linked = 0, length = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (!linked) {
        glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<std::size_t>(length), '\0');
        glGetProgramInfoLog(program, length, nullptr, log.data());
        throw Error("the shaders " + std::string(name) + " do not link on this OpenGL driver:\n" + log);
    }
    return program;
}

} // namespace talus::render
