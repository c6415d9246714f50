// SPDX-License-Identifier: MIT
/// @file
/// The exponentials of many 3x3 matrices, and their derivatives.
///
/// What        matrix_exponential() and matrix_exponential_pullback() of every column
/// Shapes      9 x n, a matrix a column: row after row or column after column, which commutes with both functions.
///             float and double, to be named: matrix_exponentials_into<float>(Q, X)
/// Valid       as matrix_exponential(); accuracy the same. `out` may be one of the arguments.
/// Refuses     arrays of different sizes (InvalidInput)
/// Threads     columns are taken in blocks of 16, a lane each. A column's result depends neither on its neighbours nor on
///             the executor.
/// Cost        that of matrix_exponential() over the number of lanes of the machine. Columns with |B| > 2 (float) or
///             3 (double) are done one by one. No allocation.
/// Tests       tests/unit/linalg/matrix_exponentials_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/branchless_exp.hpp>
#include <softtissue/linalg/matrix3_entries.hpp>
#include <softtissue/linalg/matrix_exponential.hpp>

namespace softtissue {

template <class S>
using Matrix9X = Eigen::Matrix<S, 9, Eigen::Dynamic>;

namespace detail {

/// value[lane] = exp(Q[lane]), and the derivative there applied to E[lane] if there is an E.
template <RealScalar S>
void exponential_lanes(const Matrix3Lanes<S>& Q, const Matrix3Lanes<S>* E, Matrix3Lanes<S>& result) {
    constexpr Index lanes = Matrix3Lanes<S>::lanes;
    S norms[size_t(lanes)];
    for (Index l = 0; l < lanes; ++l) {
        const TraceSplit<S> A(Q.lane(l), S(1));
        norms[l] = quarter_row_norm(A.B);
        const CubicExponential<S> r = ExponentialSeries<S>::at(A.p, A.q);
        const S factor = branchless_exp(A.t);
        const Matrix3Entries<S> X = exponential_of(A, r, factor);
        result.set_lane(l, E == nullptr ? X : exponential_derivative_of(A, r, factor, X, E->lane(l)));
    }
    for (Index l = 0; l < lanes; ++l) {
        if (norms[l] > ExponentialSeries<S>::largest_norm / 4) {
            const ExponentialWithDerivative<S> squared =
                squared_exponential(Q.lane(l), (E == nullptr ? Q : *E).lane(l));
            result.set_lane(l, E == nullptr ? squared.value : squared.derivative);
        }
    }
}

}  // namespace detail

/// exp of every column of Q.
template <RealScalar S, Executor E = SequentialExecutor>
void matrix_exponentials_into(ConstRef<Matrix9X<S>> Q, Eigen::Ref<Matrix9X<S>> out, const E& executor = {}) {
    require(out.cols() == Q.cols(), "matrix exponentials: ", out.cols(), " results, expected ", Q.cols());
    for_each_lane_block(executor, Q.cols(), [&](Index first, Index count) {
        Matrix3Lanes<S> lanes, result;
        lanes.load(Q.col(first).data(), Q.outerStride(), count);
        detail::exponential_lanes<S>(lanes, nullptr, result);
        result.store(out.col(first).data(), out.outerStride(), count);
    });
}

/// The gradient by Q of the sum over all columns of <G, exp Q>.
template <RealScalar S, Executor E = SequentialExecutor>
void matrix_exponential_pullbacks_into(ConstRef<Matrix9X<S>> Q, ConstRef<Matrix9X<S>> G, Eigen::Ref<Matrix9X<S>> out,
                                       const E& executor = {}) {
    require(G.cols() == Q.cols() && out.cols() == Q.cols(), "matrix exponential pullbacks: ", G.cols(),
            " gradients and ", out.cols(), " results, expected ", Q.cols());
    for_each_lane_block(executor, Q.cols(), [&](Index first, Index count) {
        Matrix3Lanes<S> lanes, gradients, result;
        lanes.load(Q.col(first).data(), Q.outerStride(), count);
        gradients.load(G.col(first).data(), G.outerStride(), count);
        lanes.transpose();
        detail::exponential_lanes<S>(lanes, &gradients, result);
        result.store(out.col(first).data(), out.outerStride(), count);
    });
}

}  // namespace softtissue
