// SPDX-License-Identifier: MIT
// What the world refuses, in words. Every function throws Error; `where` begins the message and names the body or call.
#pragma once

#include <string>

#include <talus/settings.h>
#include <talus/types.h>

namespace talus::engine {

void check_finite(float, const std::string& where, const char* what);
void check_finite(Vec3, const std::string& where, const char* what);
/// The pose with its rotation brought to unit length.
Pose checked_pose(const Pose&, const std::string& where);
void check_velocity(const Velocity&, const std::string& where);
void check_material(const Material&, const std::string& where);
/// The definition with its rotation brought to unit length.
BodyDefinition checked_definition(const BodyDefinition&, const std::string& where);
void check_settings(const Settings&);
void check_watch(ContactWatch);
void check_options(const WorldOptions&);
std::string to_words(BodyKind);

} // namespace talus::engine
