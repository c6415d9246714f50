// SPDX-License-Identifier: MIT
/// @file
/// `ndg train`: trains a model from a data set.
#pragma once

#include <CLI/App.hpp>

namespace examples {

/// Adds the subcommand, which runs when it is parsed.
void add_train(CLI::App& app);

}  // namespace examples
