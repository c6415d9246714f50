// SPDX-License-Identifier: MIT
/// @file
/// `ndg animate`: a body in motion by a trained model, with bones and muscles.
#pragma once

#include <CLI/App.hpp>

namespace examples {

/// Adds the subcommand, which runs when it is parsed.
void add_animate(CLI::App& app);

}  // namespace examples
