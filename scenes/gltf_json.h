// SPDX-License-Identifier: MIT
// JSON that is read with checks: a value together with its place in the file, so that each error says where it is.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace talus::scenes {

class JsonValue {
public:
    /// `place` as errors name it: "scene.gltf: node 3 'Cube'". The value must outlive this.
    JsonValue(const nlohmann::json& value, std::string where) : json(&value), place(std::move(where)) {}

    /// Place, colon, reason.
    std::string at(const std::string& reason) const;
    /// Throws Error with that.
    [[noreturn]] void fail(const std::string& reason) const;

    /// A member of an object, if there is one. Throws Error where this is no object.
    std::optional<JsonValue> find(const char* key) const;
    /// As `find`; throws Error where there is none.
    JsonValue member(const char* key) const;
    /// The extension of this name, if this object has it.
    std::optional<JsonValue> extension(const char* name) const;

    /// Throw Error where this is no array.
    std::size_t size() const;
    JsonValue element(std::size_t) const;
    /// An element with a name of its own: `noun` 3 'its "name"' directly in the file.
    JsonValue named_element(std::size_t, const std::string& file, const char* noun) const;

    /// Throw Error for a value of another type.
    bool boolean() const;
    std::string text() const;
    /// Finite, also as a float.
    double number() const;
    /// A whole number below `count`, the number of `plural` in the file.
    std::size_t index(std::size_t count, const char* plural) const;
    /// An array of exactly N numbers.
    template <std::size_t N> std::array<double, N> numbers() const {
        if (size() != N) fail("must have " + std::to_string(N) + " numbers, not " + std::to_string(size()));
        std::array<double, N> result;
        for (std::size_t i = 0; i < N; ++i)
            result[i] = element(i).number();
        return result;
    }

private:
    const nlohmann::json* json;
    std::string place;

    void require_object() const;
};

} // namespace talus::scenes
