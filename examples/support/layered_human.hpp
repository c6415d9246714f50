// SPDX-License-Identifier: MIT
/// @file
/// Layered bodies of skinned ones, compiled once for all programs.
#pragma once

#include <softtissue/anatomy/layered_body.hpp>
#include <softtissue/ndg/shaped_body.hpp>
#include <softtissue/skinning/smpl_body.hpp>

#include <functional>

namespace examples {

/// From shape coefficients to layered bodies.
using BodyFunction = std::function<softtissue::ShapedBody<double>(const softtissue::VectorX<double>&)>;

/// Those of a body.
BodyFunction layered_bodies(const softtissue::SmplBody<double>& body);

/// That of the body's template.
softtissue::LayeredBody<double> layered_body_of(const softtissue::SmplBody<double>& body);

}  // namespace examples
