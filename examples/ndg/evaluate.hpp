// SPDX-License-Identifier: MIT
/// @file
/// `ndg evaluate`: trained models and classical methods on the samples that no training has seen.
#pragma once

#include <CLI/App.hpp>

namespace examples {

/// Adds the subcommand, which runs when it is parsed.
void add_evaluate(CLI::App& app);

}  // namespace examples
