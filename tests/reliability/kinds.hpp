// SPDX-License-Identifier: MIT
// All that the program tries. `count` trials of each kind; equal seeds give equal trials.
#pragma once

#include "ledger.hpp"

#include <cstdint>

namespace reliability {

/// Blocks of cells, every element and law.
void run_sampled_laws(Ledger& ledger, long count, std::uint64_t seed);
void run_more_double_laws(Ledger& ledger, long count, std::uint64_t seed);
void run_more_float_laws(Ledger& ledger, long count, std::uint64_t seed);

/// The embedded body, skinned in any pose and shape.
void run_skinning(Ledger& ledger, long count, std::uint64_t seed);

/// Avatars thrown from pose to pose.
void run_avatars(Ledger& ledger, long count, std::uint64_t seed);

/// Layered flesh and what stands in for it: all methods, networks of random weights.
void run_layers(Ledger& ledger, long count, std::uint64_t seed);

/// The embedded body with a layer of tissue: avatars, shapes to four deviations, neural animation.
void run_embedded(Ledger& ledger, long count, std::uint64_t seed);

/// Not a number, infinity, huge and denormal numbers through every door.
void run_doors(Ledger& ledger);
void run_heavy_doors(Ledger& ledger);

/// Eigenvalues, singular values, rotations, exponentials and logarithms of any matrix.
void run_matrices(Ledger& ledger, long count, std::uint64_t seed);

}  // namespace reliability
