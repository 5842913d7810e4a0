// SPDX-License-Identifier: MIT
// Kernels name their buffers by block and never by number: binding points are dealt out here, after linking.
#include "device/gl/gl_program.h"

#include <cctype>
#include <string_view>

#include "device/gl/kernel_source.h"

namespace talus::engine {
namespace {

/// A shader or program object until its owner takes it over.
struct Unfinished {
    GLuint name;
    void (*destroy)(GLuint);
    ~Unfinished() {
        if (name != 0) destroy(name);
    }
};

std::string shader_log(GLuint shader) {
    GLint length = 0;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    glGetShaderInfoLog(shader, length, &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    return log;
}

std::string program_log(GLuint program) {
    GLint length = 0;
    glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length), '\0');
    glGetProgramInfoLog(program, length, &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    return log;
}

GLuint link_kernel(const std::string& path, const KernelSource& source) {
    const Unfinished shader{glCreateShader(GL_COMPUTE_SHADER), [](GLuint name) { glDeleteShader(name); }};
    const char* text = source.text.c_str();
    glShaderSource(shader.name, 1, &text, nullptr);
    glCompileShader(shader.name);
    GLint done = GL_FALSE;
    glGetShaderiv(shader.name, GL_COMPILE_STATUS, &done);
    if (done == GL_FALSE)
        throw Error("kernel " + path + " does not compile:\n" + trace_log(shader_log(shader.name), source));

    Unfinished program{glCreateProgram(), [](GLuint name) { glDeleteProgram(name); }};
    glAttachShader(program.name, shader.name);
    glLinkProgram(program.name);
    glDetachShader(program.name, shader.name);
    glGetProgramiv(program.name, GL_LINK_STATUS, &done);
    if (done == GL_FALSE)
        throw Error("kernel " + path + " does not link:\n" + trace_log(program_log(program.name), source));
    glObjectLabel(GL_PROGRAM, program.name, -1, path.c_str());
    const GLuint name = program.name;
    program.name = 0;
    return name;
}

GLint resource(GLuint program, GLenum interface, GLuint index, GLenum property) {
    GLint value = 0;
    glGetProgramResourceiv(program, interface, index, 1, &property, 1, nullptr, &value);
    return value;
}

std::optional<BufferId> buffer_of_block(std::string_view block) {
    for (std::size_t i = 0; i < k_buffers.size(); ++i) {
        if (block == k_buffers[i].block) return static_cast<BufferId>(i);
    }
    return std::nullopt;
}

/// Whether the text declares the block `readonly`: introspection does not tell. A declaration which is not recognised
/// counts as written to, which is always safe.
bool is_declared_readonly(std::string_view source, const std::string& block) {
    const std::string declaration = "buffer " + block;
    for (std::size_t at = source.find(declaration); at != std::string_view::npos;
         at = source.find(declaration, at + 1)) {
        const std::size_t end = at + declaration.size();
        if (end < source.size() && (std::isalnum(static_cast<unsigned char>(source[end])) != 0 || source[end] == '_'))
            continue;
        const std::size_t line = source.rfind('\n', at) + 1; // npos + 1 is the first line
        return source.substr(line, at - line).find("readonly") != std::string_view::npos;
    }
    return false;
}

} // namespace

GlProgram::GlProgram(const std::string& path) : path_(path) {
    const KernelSource source = kernel_source(path);
    Unfinished linked{link_kernel(path, source), [](GLuint name) { glDeleteProgram(name); }};
    name_ = linked.name;
    find_blocks(source.text);
    args_location_ = glGetUniformLocation(name_, "args");
    const GLuint parameters = glGetUniformBlockIndex(name_, "ParametersBlock");
    if (parameters != GL_INVALID_INDEX) {
        GLint bytes = 0;
        glGetActiveUniformBlockiv(name_, parameters, GL_UNIFORM_BLOCK_DATA_SIZE, &bytes);
        if (static_cast<std::size_t>(bytes) != sizeof(Parameters))
            throw Error("kernel " + path + ": the block of Parameters has " + std::to_string(bytes) +
                        " bytes in GLSL, but " + std::to_string(sizeof(Parameters)) + " in C++");
        glUniformBlockBinding(name_, parameters, k_parameters_binding);
        uses_parameters_ = true;
    }
    linked.name = 0;
}

GlProgram::~GlProgram() {
    glDeleteProgram(name_);
}

BufferId GlProgram::buffer(const StorageBlock& block, const Launch& launch) const {
    if (block.buffer) return *block.buffer;
    for (const Binding& binding : launch.bindings) {
        if (block.name == binding.block) return binding.buffer;
    }
    throw Error("kernel " + path_ + ": its block " + block.name +
                " is neither a buffer of src/state/buffers.h nor among the bindings of the launch");
}

void GlProgram::set_args(const std::array<uint, 4>& args) {
    if (args_location_ < 0 || args == args_) return;
    glProgramUniform4ui(name_, args_location_, args[0], args[1], args[2], args[3]);
    args_ = args;
}

void GlProgram::find_blocks(const std::string& source) {
    GLint count = 0;
    glGetProgramInterfaceiv(name_, GL_SHADER_STORAGE_BLOCK, GL_ACTIVE_RESOURCES, &count);
    if (static_cast<std::size_t>(count) > k_max_storage_blocks)
        throw Error("kernel " + path_ + " uses " + std::to_string(count) + " buffers; the most allowed is " +
                    std::to_string(k_max_storage_blocks));
    for (GLuint index = 0; index < static_cast<GLuint>(count); ++index) {
        const GLint length = resource(name_, GL_SHADER_STORAGE_BLOCK, index, GL_NAME_LENGTH);
        StorageBlock block;
        block.name.resize(static_cast<std::size_t>(length));
        GLsizei written = 0;
        glGetProgramResourceName(name_, GL_SHADER_STORAGE_BLOCK, index, length, &written, block.name.data());
        block.name.resize(static_cast<std::size_t>(written));
        block.buffer = buffer_of_block(block.name);
        block.written = !is_declared_readonly(source, block.name);
        if (block.buffer) check_stride(index, k_buffers[static_cast<std::size_t>(*block.buffer)]);
        glShaderStorageBlockBinding(name_, index, index);
        blocks_.push_back(std::move(block));
    }
}

void GlProgram::check_stride(GLuint block_index, const BufferInfo& buffer) const {
    const GLint count = resource(name_, GL_SHADER_STORAGE_BLOCK, block_index, GL_NUM_ACTIVE_VARIABLES);
    std::vector<GLint> variables(static_cast<std::size_t>(count));
    const GLenum property = GL_ACTIVE_VARIABLES;
    glGetProgramResourceiv(name_, GL_SHADER_STORAGE_BLOCK, block_index, 1, &property, count, nullptr, variables.data());
    for (const GLint variable : variables) {
        const auto index = static_cast<GLuint>(variable);
        GLint stride = resource(name_, GL_BUFFER_VARIABLE, index, GL_TOP_LEVEL_ARRAY_STRIDE);
        if (stride == 0) // some drivers have it only for arrays of structs
            stride = resource(name_, GL_BUFFER_VARIABLE, index, GL_ARRAY_STRIDE);
        if (stride != 0 && static_cast<std::size_t>(stride) != buffer.stride)
            throw Error("kernel " + path_ + ": an element of the block " + buffer.block + " has " +
                        std::to_string(stride) + " bytes in GLSL, but " + std::to_string(buffer.stride) + " in C++");
    }
}

} // namespace talus::engine
