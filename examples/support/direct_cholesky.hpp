// SPDX-License-Identifier: MIT
/// @file
/// The fastest sparse factorisation that was found when this program was built.
#pragma once

#ifdef SOFTTISSUE_HAS_CHOLMOD
#include <softtissue/sparse/cholmod.hpp>
#else
#include <softtissue/sparse/default_cholesky.hpp>
#endif

namespace examples {

#ifdef SOFTTISSUE_HAS_CHOLMOD
using DirectCholesky = softtissue::CholmodCholesky;
#else
using DirectCholesky = softtissue::DefaultCholesky<double>;
#endif

}  // namespace examples
