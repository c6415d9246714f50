// SPDX-License-Identifier: MIT
/// @file
/// What a fuzz target is: a part of the library that any bytes are given to.
///
/// What        Target: a name and a function; expect(): a property that must hold, or the program ends; is_accepted(): runs
///             something that may refuse with InvalidInput; input_file(): the bytes as a file, for readers that take a path.
/// Valid       a target returns whatever the bytes are. It lets InvalidInput out; any other exception, a crash, an undefined
///             operation, memory out of proportion to the bytes, a hang or an unmet expectation is a finding.
#pragma once

#include "container.hpp"

#include <softtissue/core/error.hpp>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace softtissue_fuzz {

using Bytes = std::span<const unsigned char>;

struct Target {
    std::string_view name;
    Container container;
    void (*run)(Bytes);
};

std::span<const Target> npz_targets();
std::span<const Target> json_targets();
std::span<const Target> text_targets();
std::span<const Target> agreement_targets();

inline void expect(bool holds, const char* what) {
    if (!holds) {
        std::fprintf(stderr, "not as expected: %s\n", what);
        std::abort();
    }
}

template <class Function>
bool is_accepted(const Function& function) {
    try {
        function();
        return true;
    } catch (const softtissue::InvalidInput&) {
        return false;
    }
}

/// A folder of this process, removed with its content at the end.
const std::filesystem::path& input_folder();

/// `bytes` as the file `name` in input_folder().
std::filesystem::path input_file(std::string_view name, std::string_view bytes);

inline std::string_view as_text(Bytes bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}
inline std::filesystem::path input_file(std::string_view name, Bytes bytes) {
    return input_file(name, as_text(bytes));
}

}  // namespace softtissue_fuzz
