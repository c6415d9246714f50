// SPDX-License-Identifier: MIT
// An energy term in fifteen lines, for tests of solvers: the sum of f over all components of d.
#pragma once

#include <softtissue/energy/concepts.hpp>

#include <cstdint>
#include <vector>

namespace softtissue_test {

using namespace softtissue;

/// `Function` offers value(x), first(x) and second(x), the derivatives.
template <class S, class Function>
struct SeparableEnergy {
    using Scalar = S;
    Function f;
    std::vector<std::int32_t> free{};

    template <Executor E>
    S energy(const Matrix3X<S>& d, const E&) const {
        S sum(0);
        for (Index k = 0; k < d.size(); ++k) {
            sum += f.value(d.data()[k]);
        }
        return sum;
    }
    template <Executor E>
    void add_gradient(const Matrix3X<S>& d, Matrix3X<S>& gradient, const E&) const {
        for (Index k = 0; k < d.size(); ++k) {
            gradient.data()[k] += f.first(d.data()[k]);
        }
    }
    void add_neighbours(const PrescribedVertices&, std::vector<std::vector<std::int32_t>>&) const {}
    void bind(const PrescribedVertices& prescribed, const BlockPattern&) { free = prescribed.free_vertices(); }
    template <Executor E>
    void add_hessian(const Matrix3X<S>& d, PsdFilter filter, BlockMatrix<S>& hessian, const E&) const {
        for (Index j = 0; j < Index(free.size()); ++j) {
            Matrix3<S> block = Matrix3<S>::Zero();
            for (int c = 0; c < 3; ++c) {
                block(c, c) = filtered_eigenvalue(f.second(d(c, free[size_t(j)])), filter);
            }
            hessian.add(j, hessian.pattern().rank(j, std::int32_t(j)), block);
        }
    }
};

/// k/2 (x - centre)^2
template <class S>
struct Spring {
    S stiffness = S(1);
    S centre = S(0);
    S value(S x) const { return S(0.5) * stiffness * (x - centre) * (x - centre); }
    S first(S x) const { return stiffness * (x - centre); }
    S second(S) const { return stiffness; }
};

}  // namespace softtissue_test
