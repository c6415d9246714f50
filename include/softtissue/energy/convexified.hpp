// SPDX-License-Identifier: MIT
/// @file
/// An energy term whose Hessian is always positive semi-definite.
///
/// What        EnergyTerm around another one: the same energy and gradient, and whatever filter is asked for the convex Hessian
///             that the term has in closed form (add_convex_hessian()). Where it has none: the clamped one in place of the exact.
/// Why         skin that goes slack or folds makes the exact Hessian of a body indefinite nearly to the end of a solve, though
///             its energy is a small part: without the skin's negative curvature Newton may use the flesh's exact Hessian
///             early. The price is linear instead of quadratic convergence, at a rate set by the share of what is left out.
/// Source      Nolte et al. 2026, sec. 3.2 (Teran et al. 2005 for the filter)
/// Tests       tests/unit/energy/convexified_test.cpp
#pragma once

#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/energy/concepts.hpp>

#include <cstdint>
#include <vector>

namespace softtissue {

template <EnergyTerm Term>
class Convexified {
public:
    using Scalar = typename Term::Scalar;

    /// `term` must outlive this.
    explicit Convexified(Term& term) : term_(&term) {}

    template <Executor E>
    Scalar energy(const Matrix3X<Scalar>& d, const E& executor) {
        return term_->energy(d, executor);
    }

    template <Executor E>
    void add_gradient(const Matrix3X<Scalar>& d, Matrix3X<Scalar>& gradient, const E& executor) {
        term_->add_gradient(d, gradient, executor);
    }

    template <Executor E>
    Scalar add_energy_and_gradient(const Matrix3X<Scalar>& d, Matrix3X<Scalar>& gradient, const E& executor) {
        return softtissue::add_energy_and_gradient(*term_, d, gradient, executor);
    }

    void add_neighbours(const PrescribedVertices& prescribed,
                        std::vector<std::vector<std::int32_t>>& neighbours) const {
        term_->add_neighbours(prescribed, neighbours);
    }

    void bind(const PrescribedVertices& prescribed, const BlockPattern& pattern) { term_->bind(prescribed, pattern); }

    template <Executor E>
    void add_hessian(const Matrix3X<Scalar>& d, PsdFilter filter, BlockMatrix<Scalar>& hessian, const E& executor) {
        if constexpr (requires { term_->add_convex_hessian(d, hessian, executor); }) {
            term_->add_convex_hessian(d, hessian, executor);
        } else {
            term_->add_hessian(d, filter == PsdFilter::none ? PsdFilter::clamp : filter, hessian, executor);
        }
    }

private:
    Term* term_;
};

}  // namespace softtissue
