// SPDX-License-Identifier: MIT
// Every read checks the type first; nothing is converted silently.
#include "scenes/gltf_json.h"

#include <cmath>
#include <limits>

#include <talus/types.h>

namespace talus::scenes {

std::string JsonValue::at(const std::string& reason) const {
    return place + ": " + reason;
}

void JsonValue::fail(const std::string& reason) const {
    throw Error(at(reason));
}

void JsonValue::require_object() const {
    if (!json->is_object()) fail(std::string("must be an object, not ") + json->type_name());
}

std::optional<JsonValue> JsonValue::find(const char* key) const {
    require_object();
    const auto found = json->find(key);
    if (found == json->end()) return std::nullopt;
    return JsonValue(*found, place + ", " + key);
}

JsonValue JsonValue::member(const char* key) const {
    std::optional<JsonValue> found = find(key);
    if (!found) fail(std::string("has no '") + key + "'");
    return *std::move(found);
}

std::optional<JsonValue> JsonValue::extension(const char* name) const {
    const std::optional<JsonValue> extensions = find("extensions");
    if (!extensions) return std::nullopt;
    std::optional<JsonValue> found = extensions->find(name);
    // Errors need not name the extension: its members have names of their own.
    if (found) found->place = place;
    return found;
}

std::size_t JsonValue::size() const {
    if (!json->is_array()) fail(std::string("must be an array, not ") + json->type_name());
    return json->size();
}

JsonValue JsonValue::element(std::size_t index) const {
    if (index >= size()) fail("has no element " + std::to_string(index));
    return {(*json)[index], place + "[" + std::to_string(index) + "]"};
}

JsonValue JsonValue::named_element(std::size_t index, const std::string& file, const char* noun) const {
    JsonValue result = element(index);
    result.place = file + ": " + noun + " " + std::to_string(index);
    if (const std::optional<JsonValue> name = result.find("name")) result.place += " '" + name->text() + "'";
    return result;
}

bool JsonValue::boolean() const {
    if (!json->is_boolean()) fail(std::string("must be true or false, not ") + json->type_name());
    return json->get<bool>();
}

std::string JsonValue::text() const {
    if (!json->is_string()) fail(std::string("must be a string, not ") + json->type_name());
    return json->get<std::string>();
}

double JsonValue::number() const {
    if (!json->is_number()) fail(std::string("must be a number, not ") + json->type_name());
    const double value = json->get<double>();
    if (!std::isfinite(value) || std::abs(value) > static_cast<double>(std::numeric_limits<float>::max()))
        fail(json->dump() + " is too large");
    return value;
}

std::size_t JsonValue::index(std::size_t count, const char* plural) const {
    const double value = number();
    if (value != std::floor(value) || value < 0.0) fail(json->dump() + " is not an index");
    if (value >= static_cast<double>(count))
        fail(json->dump() + " is out of range: the file has " + std::to_string(count) + " " + plural);
    return static_cast<std::size_t>(value);
}

} // namespace talus::scenes
