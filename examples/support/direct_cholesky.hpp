// SPDX-License-Identifier: MIT
/// @file
/// The fastest sparse factorisation of solid meshes.
#pragma once

#include <softtissue/sparse/supernodal_cholesky.hpp>

namespace examples {

using DirectCholesky = softtissue::SupernodalCholesky<double>;

}  // namespace examples
