// SPDX-License-Identifier: MIT
// The shader programs of the renderer.
#pragma once

#include <initializer_list>
#include <span>
#include <string_view>

#include "device/gl/kernel_source.h"
#include "render/gl_names.h"

namespace talus::render {

/// A program of the files render/shaders/<name>.<stage>.glsl, each opened by what all shaders know. Throws Error with
/// the driver's log.
Program make_program(std::string_view name, std::initializer_list<GLenum> stages);

/// Every file of render/shaders, as the build embedded it.
std::span<const engine::ShaderFile> embedded_shaders();

} // namespace talus::render
