// SPDX-License-Identifier: MIT
/// @file
/// Words of OpenUSD's text format: identifiers, numbers, tuples, values over time.
///
/// What        usd_identifier(): other characters become '_', names that coincide are numbered; append_usd_tuples(): the columns
///             of a matrix; UsdSamples: one attribute, a value or samples numbered from 0.
/// Valid       numbers are written in the shortest decimal form that gives them back
/// Source      Pixar, "OpenUSD", USDA text format
/// Tests       tests/unit/io/usd_text_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>

#include <array>
#include <charconv>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace softtissue {

/// `name` as an identifier of USD that is not among `used`, which it joins then.
inline std::string usd_identifier(const std::string& name, std::set<std::string>& used) {
    std::string result;
    for (const char c : name) {
        const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
        const bool is_digit = c >= '0' && c <= '9';
        if (result.empty() && !is_letter) {
            result = "_";
        }
        if (is_letter || is_digit || result != "_") {
            result += is_letter || is_digit ? c : '_';
        }
    }
    const std::string base = result.empty() ? "_" : result;
    result = base;
    for (int number = 1; !used.insert(result).second; ++number) {
        result = base + "_" + std::to_string(number);
    }
    return result;
}

/// The shortest decimal form that gives the number back.
template <class T>
void append_usd_number(std::string& text, T value) {
    std::array<char, 32> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
    text.append(digits.data(), end);
}

/// Appends "(a, b, c)" for each column, between brackets.
template <class Derived>
void append_usd_tuples(std::string& text, const Eigen::MatrixBase<Derived>& columns) {
    text += '[';
    for (Index i = 0; i < columns.cols(); ++i) {
        text += i == 0 ? "(" : ", (";
        for (Index d = 0; d < columns.rows(); ++d) {
            text += d == 0 ? "" : ", ";
            append_usd_number(text, columns(d, i));
        }
        text += ')';
    }
    text += ']';
}

/// One attribute over time: its samples as text.
class UsdSamples {
public:
    template <class Derived>
    void add(const Eigen::MatrixBase<Derived>& columns) {
        std::string& sample = samples_.emplace_back();
        append_usd_tuples(sample, columns);
    }
    Index size() const { return Index(samples_.size()); }

    /// One sample is a value, several are numbered from 0.
    void append_to(std::string& text, const std::string& declaration) const {
        if (samples_.size() == 1) {
            text += "        " + declaration + " = " + samples_.front() + "\n";
            return;
        }
        text += "        " + declaration + ".timeSamples = {\n";
        for (std::size_t t = 0; t < samples_.size(); ++t) {
            text += "            " + std::to_string(t) + ": " + samples_[t] + ",\n";
        }
        text += "        }\n";
    }

private:
    std::vector<std::string> samples_;
};

}  // namespace softtissue
