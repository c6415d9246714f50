// SPDX-License-Identifier: MIT
/// @file
/// The expensive part of `ndg generate`, in a source of its own.
#pragma once

#include <softtissue/io/dataset_generation.hpp>
#include <softtissue/ndg/shaped_body.hpp>

#include <functional>

namespace examples {

/// generate_dataset() with the fastest factorisation.
softtissue::GenerationProgress compute_samples(
    const softtissue::DatasetFolder& folder, const softtissue::ShapedBodyMaker<double>& maker,
    const softtissue::GenerationOptions& options,
    const std::function<bool(const softtissue::GenerationProgress&)>& observer);

}  // namespace examples
