// SPDX-License-Identifier: MIT
// What the library says to input that it refuses.
#pragma once

#include <softtissue/core/error.hpp>

#include <string>

namespace softtissue_test {

/// The text of the InvalidInput that `action` throws; empty if it throws none.
template <class Action>
std::string refusal(const Action& action) {
    try {
        action();
    } catch (const softtissue::InvalidInput& error) {
        return error.what();
    }
    return {};
}

}  // namespace softtissue_test
