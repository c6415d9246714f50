// SPDX-License-Identifier: MIT
/// @file
/// A value inside a JSON document that knows where it stands, so that every refusal can say so.
///
/// What        objects, arrays, integers, finite numbers and texts, each read with what is expected of it.
/// Wording     "a.gltf: accessors[3].count = -4, expected an integer from 1 to 100"
/// Valid       as long as the document lives. An integer may be written as 4.0.
/// Refuses     a value that is missing, of another kind or out of range (InvalidInput names file, place, value, expectation).
/// Needs       nlohmann-json
/// Tests       tests/unit/io/json_element_test.cpp
#pragma once

#if !__has_include(<nlohmann/json.hpp>)
#error "softtissue: io/json_element.hpp needs nlohmann-json (Debian: nlohmann-json3-dev)"
#endif

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace softtissue {

class JsonElement {
public:
    /// `name` starts the messages: a file name for the document itself.
    JsonElement(std::string name, const nlohmann::json& value) : JsonElement(std::move(name), value, ": ") {}

    const std::string& name() const { return name_; }
    const nlohmann::json& value() const { return *value_; }

    bool has(const std::string& key) const {
        require_kind(value_->is_object(), "an object");
        return value_->contains(key);
    }

    /// The member `key` of an object.
    JsonElement at(const std::string& key) const {
        require(has(key), name_, separator_, key, " is missing");
        return {name_ + separator_ + key, *value_->find(key), "."};
    }

    Index size() const {
        require_kind(value_->is_array(), "an array");
        return static_cast<Index>(value_->size());
    }

    /// The item `index` of an array.
    JsonElement at(Index index) const {
        require(index >= 0 && index < size(), name_, " has no item ", index, ", expected 0 to ", size() - 1);
        return {name_ + "[" + std::to_string(index) + "]", (*value_)[static_cast<std::size_t>(index)], "."};
    }

    /// The items of the array `key`; none if it is missing.
    std::vector<JsonElement> items(const std::string& key) const {
        std::vector<JsonElement> result;
        if (has(key)) {
            const JsonElement array = at(key);
            for (Index i = 0; i < array.size(); ++i) {
                result.push_back(array.at(i));
            }
        }
        return result;
    }

    Index integer(Index lowest, Index highest) const {
        bool is_integer = value_->is_number();
        double real = 0.0;
        if (is_integer) {
            real = value_->get<double>();  // exact below 2^53, far beyond what any index can be
            is_integer = real == std::floor(real) && real >= double(lowest) && real <= double(highest);
        }
        require_kind(is_integer, "an integer from ", lowest, " to ", highest);
        return static_cast<Index>(real);
    }

    double number() const {
        const bool is_finite = value_->is_number() && std::isfinite(value_->get<double>());
        require_kind(is_finite, "a finite number");
        return value_->get<double>();
    }

    std::string text() const {
        require_kind(value_->is_string(), "a text");
        return value_->get<std::string>();
    }

    bool flag() const {
        require_kind(value_->is_boolean(), "true or false");
        return value_->get<bool>();
    }

    VectorX<double> numbers(Index count) const {
        require_kind(value_->is_array() && static_cast<Index>(value_->size()) == count, "an array of ", count,
                     " numbers");
        VectorX<double> result(count);
        for (Index i = 0; i < count; ++i) {
            result(i) = at(i).number();
        }
        return result;
    }

private:
    JsonElement(std::string name, const nlohmann::json& value, std::string_view separator)
        : name_(std::move(name)), value_(&value), separator_(separator) {}

    template <class... Parts>
    void require_kind(bool is_kind, const Parts&... expectation) const {
        require(is_kind, name_, " = ", is_kind ? std::string() : shown(), ", expected ", expectation...);
    }

    /// What stands there, if it is short.
    std::string shown() const {
        if (value_->is_object()) {
            return "{...}";
        }
        if (value_->is_array()) {
            return "[" + std::to_string(value_->size()) + " items]";
        }
        const std::string text = value_->dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
        return text.size() <= 40 ? text : text.substr(0, 40) + "...";
    }

    std::string name_;
    const nlohmann::json* value_;
    std::string separator_;
};

}  // namespace softtissue
