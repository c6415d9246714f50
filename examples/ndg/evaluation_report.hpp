// SPDX-License-Identifier: MIT
/// @file
/// The page of `ndg evaluate`: where on the body each method is wrong, how its errors are spread, the tables.
#pragma once

#include "error_picture.hpp"
#include "evaluation_run.hpp"

#include <filesystem>
#include <vector>

namespace examples {

/// `maps`: of each split.
bool write_evaluation_report(const std::filesystem::path& path, const EvaluationSetup& setup,
                             const std::vector<SplitResult>& splits, const ErrorSurface& surface,
                             const std::vector<std::vector<ErrorMap>>& maps);

}  // namespace examples
