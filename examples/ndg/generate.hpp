// SPDX-License-Identifier: MIT
/// @file
/// `ndg generate`: makes a data set of posed bodies.
#pragma once

#include <CLI/App.hpp>

namespace examples {

/// Adds the subcommand, which runs when it is parsed.
void add_generate(CLI::App& app);

}  // namespace examples
