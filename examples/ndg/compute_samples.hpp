// SPDX-License-Identifier: MIT
/// @file
/// The expensive part of `ndg generate`, in a source of its own.
#pragma once

#include "inputs.hpp"

#include <softtissue/io/dataset_generation.hpp>

#include <functional>

namespace examples {

/// generate_dataset(), compiled once.
softtissue::GenerationProgress compute_samples(
    const softtissue::DatasetFolder& folder, const BodyFunction& maker, const softtissue::GenerationOptions& options,
    const std::function<bool(const softtissue::GenerationProgress&)>& observer);

}  // namespace examples
