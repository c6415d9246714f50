// SPDX-License-Identifier: MIT
/// @file
/// Bad data at a boundary: one exception type, one cold helper, one way to word a message.
///
/// What        InvalidInput: a constructor, mesh, file or parameter that the library refuses.
///             Numerical outcomes are never exceptions: solvers return a SolveReport.
/// Wording     name, index, value, expectation: "young_modulus = -3, expected > 0".
/// Tests       tests/unit/core/error_test.cpp
#pragma once

#include <softtissue/core/config.hpp>

#include <sstream>
#include <stdexcept>
#include <string>

namespace softtissue {

/// Thrown for input that cannot be worked with; the text names what, where, its value, and what was expected.
class InvalidInput : public std::invalid_argument {
public:
    using std::invalid_argument::invalid_argument;
};

/// Throws InvalidInput with the arguments streamed into one text; never returns.
template <class... Parts>
[[noreturn]] void throw_invalid_input(const Parts&... parts) {
    std::ostringstream text;
    text.precision(10);
    (text << ... << parts);
    SOFTTISSUE_THROW(InvalidInput, text.str());
}

/// Throws InvalidInput built from `parts` unless `condition` holds.
template <class... Parts>
void require(bool condition, const Parts&... parts) {
    if (!condition) {
        throw_invalid_input(parts...);
    }
}

}  // namespace softtissue
