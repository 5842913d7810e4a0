// SPDX-License-Identifier: MIT
// What the world refuses, in words. Every function throws Error, with a message that begins with `where`.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include <talus/settings.h>
#include <talus/types.h>

namespace talus::engine {

/// What a message is about: a call, and the body or the place in a list that it was given. It is put into words only
/// where something is refused, as programs may call a hundred thousand times between two steps.
struct Where {
    const char* words; ///< {0} and {1} stand for the call and the number
    const char* call = "";
    std::size_t number = 0;

    std::string in_words() const;
};
Where body_of_call(const char* call, BodyId);

void check_finite(float, const Where&, const char* what);
void check_finite(Vec3, const Where&, const char* what);
void check_pose(const Pose&, const Where&);
void check_velocity(const Velocity&, const Where&);
void check_material(const Material&, const Where&);
void check_definition(const BodyDefinition&, const Where&);
/// Of the bodies that World::add is given, by several threads where they are many; what is said is of the first of them
/// that is wrong.
void check_definitions(std::span<const BodyDefinition>, unsigned threads);
void check_settings(const Settings&);
void check_watch(ContactWatch);
void check_options(const WorldOptions&);
std::string to_words(BodyKind);

} // namespace talus::engine
