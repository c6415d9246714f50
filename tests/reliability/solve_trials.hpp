// SPDX-License-Identifier: MIT
// Solves of a block of a few cells: what is random, and what they are measured by. Elements and laws: solve_kinds.hpp.
#pragma once

#include "any_elastic.hpp"
#include "ledger.hpp"

#include <softtissue/core/random.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace reliability {

/// What a trial draws; the law takes of it what it knows.
struct Tissue {
    double young_modulus;  ///< [Pa]
    double poisson_ratio;
    std::uint64_t seed;  ///< of the axes of an orthotropic law
};

/// A block of cells of one element: the unit cube, or what was made of it.
template <class S>
struct TrialBlock {
    Matrix3X<S> rest;
    VectorX<S> masses;
    std::vector<std::int32_t> bottom, top;
    std::unique_ptr<AnyElastic<S>> elastic;
};

enum class Shape {
    regular,  ///< cells of one size, somewhat in disorder
    slender,  ///< one direction shrunk by 1 to 1e-6
    slivers,  ///< inner vertices pushed towards the opposite faces of their cells: heights of 1 to 1e-6
    thin      ///< layers of random thickness, 1e-2 to 1e-9
};

template <class S>
using BlockMaker = std::function<TrialBlock<S>(Shape shape, const Tissue& tissue, RandomGenerator& random)>;

struct SolveKind {
    std::string name;              ///< of law and element
    bool recovers = false;         ///< the law has no other minimum than rest that was ever met
    double rest_tolerance = 1e-6;  ///< in sizes of the block
};

/// The four kinds of trials with a law and an element, `count` of each.
template <class S>
void run_solves(Ledger& ledger, const SolveKind& kind, const BlockMaker<S>& make, long count, std::uint64_t seed);

extern template void run_solves(Ledger&, const SolveKind&, const BlockMaker<float>&, long, std::uint64_t);
extern template void run_solves(Ledger&, const SolveKind&, const BlockMaker<double>&, long, std::uint64_t);

}  // namespace reliability
