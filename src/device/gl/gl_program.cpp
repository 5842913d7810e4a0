// SPDX-License-Identifier: MIT
// Kernels name their buffers by block and never by number: binding points are dealt out here, after linking.
#include "device/gl/gl_program.h"

#include <cctype>
#include <string_view>
#include <utility>

#include "device/gl/record_blocks.h"

namespace talus::engine {
namespace {

// The same extension under two names.
constexpr const char* k_arb_side_by_side = "GL_ARB_parallel_shader_compile";
constexpr const char* k_khr_side_by_side = "GL_KHR_parallel_shader_compile";

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

GLint resource(GLuint program, GLenum interface, GLuint index, GLenum property) {
    GLint value = 0;
    glGetProgramResourceiv(program, interface, index, 1, &property, 1, nullptr, &value);
    return value;
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

bool compiles_side_by_side() {
    return epoxy_has_gl_extension(k_arb_side_by_side) || epoxy_has_gl_extension(k_khr_side_by_side);
}

void compile_side_by_side() {
    constexpr GLuint k_as_many_as_it_likes = 0xffffffffu;
    if (epoxy_has_gl_extension(k_arb_side_by_side))
        glMaxShaderCompilerThreadsARB(k_as_many_as_it_likes);
    else if (epoxy_has_gl_extension(k_khr_side_by_side))
        glMaxShaderCompilerThreadsKHR(k_as_many_as_it_likes);
}

GlProgram::GlProgram(const std::string& path, const KernelTarget& target, const ProgramCache& cache)
    : path_(path), source_(std::make_unique<KernelSource>(kernel_source(path, target))),
      name_(cache.load(path, source_->text)) {
    if (name_ == 0) begin_compiling();
}

GlProgram::~GlProgram() {
    glDeleteShader(shader_);
    glDeleteProgram(name_);
}

void GlProgram::begin_compiling() {
    shader_ = glCreateShader(GL_COMPUTE_SHADER);
    const char* text = source_->text.c_str();
    glShaderSource(shader_, 1, &text, nullptr);
    glCompileShader(shader_);
    name_ = glCreateProgram();
    glProgramParameteri(name_, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
    glAttachShader(name_, shader_);
    glLinkProgram(name_);
}

bool GlProgram::is_compiled() const {
    if (shader_ == 0 || !compiles_side_by_side()) return true;
    GLint done = GL_FALSE;
    glGetProgramiv(name_, GL_COMPLETION_STATUS_ARB, &done);
    return done == GL_TRUE;
}

void GlProgram::finish(const ProgramCache& cache) {
    if (finished()) return;
    if (shader_ != 0) {
        check_compiled();
        glDetachShader(name_, shader_);
        glDeleteShader(std::exchange(shader_, 0));
        cache.store(path_, source_->text, name_);
    }
    glObjectLabel(GL_PROGRAM, name_, -1, path_.c_str());
    find_blocks();
    find_parameters();
    args_location_ = glGetUniformLocation(name_, "args");
    source_.reset();
}

void GlProgram::check_compiled() const {
    GLint done = GL_FALSE;
    glGetShaderiv(shader_, GL_COMPILE_STATUS, &done);
    if (done == GL_FALSE)
        throw Error("kernel " + path_ + " does not compile:\n" + trace_log(shader_log(shader_), *source_));
    glGetProgramiv(name_, GL_LINK_STATUS, &done);
    if (done == GL_FALSE)
        throw Error("kernel " + path_ + " does not link:\n" + trace_log(program_log(name_), *source_));
}

void GlProgram::find_parameters() {
    const GLuint parameters = glGetUniformBlockIndex(name_, "ParametersBlock");
    uses_parameters_ = parameters != GL_INVALID_INDEX;
    if (!uses_parameters_) return;
    GLint bytes = 0;
    glGetActiveUniformBlockiv(name_, parameters, GL_UNIFORM_BLOCK_DATA_SIZE, &bytes);
    if (static_cast<std::size_t>(bytes) != sizeof(Parameters))
        throw Error("kernel " + path_ + ": the block of Parameters has " + std::to_string(bytes) +
                    " bytes in GLSL, but " + std::to_string(sizeof(Parameters)) + " in C++");
    glUniformBlockBinding(name_, parameters, k_parameters_binding);
}

BufferId GlProgram::buffer(const StorageBlock& block, const Launch& launch) const {
    for (const Binding& binding : launch.bindings)
        if (block.name == binding.block) return binding.buffer;
    if (block.buffer) return *block.buffer;
    throw Error("kernel " + path_ + ": its block " + block.name +
                " is neither a buffer of src/state/buffers.h nor among the bindings of the launch");
}

void GlProgram::set_args(const std::array<uint, 4>& args) {
    if (args_location_ < 0 || args == args_) return;
    glProgramUniform4ui(name_, args_location_, args[0], args[1], args[2], args[3]);
    args_ = args;
}

void GlProgram::find_blocks() {
    blocks_.clear();
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
        block.written = !is_declared_readonly(source_->text, block.name);
        if (block.buffer) check_stride(index, block.name, element_bytes(*block.buffer));
        glShaderStorageBlockBinding(name_, index, index);
        blocks_.push_back(std::move(block));
    }
}

void GlProgram::check_stride(GLuint block_index, const std::string& block, std::size_t bytes) const {
    const GLint count = resource(name_, GL_SHADER_STORAGE_BLOCK, block_index, GL_NUM_ACTIVE_VARIABLES);
    std::vector<GLint> variables(static_cast<std::size_t>(count));
    const GLenum property = GL_ACTIVE_VARIABLES;
    glGetProgramResourceiv(name_, GL_SHADER_STORAGE_BLOCK, block_index, 1, &property, count, nullptr, variables.data());
    for (const GLint variable : variables) {
        const auto index = static_cast<GLuint>(variable);
        GLint stride = resource(name_, GL_BUFFER_VARIABLE, index, GL_TOP_LEVEL_ARRAY_STRIDE);
        if (stride == 0) // some drivers have it only for arrays of structs
            stride = resource(name_, GL_BUFFER_VARIABLE, index, GL_ARRAY_STRIDE);
        if (stride != 0 && static_cast<std::size_t>(stride) != bytes)
            throw Error("kernel " + path_ + ": an element of the block " + block + " has " + std::to_string(stride) +
                        " bytes in GLSL, but " + std::to_string(bytes) + " in C++");
    }
}

} // namespace talus::engine
