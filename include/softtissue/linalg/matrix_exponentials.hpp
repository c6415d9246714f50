// SPDX-License-Identifier: MIT
/// @file
/// The exponentials of many 3x3 matrices, and their derivatives.
///
/// What        matrix_exponential() and matrix_exponential_pullback() of every column; for_each_exponential_block() for who has
///             more to do with them than to store them
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
#include <softtissue/core/branchless_exp.hpp>
#include <softtissue/linalg/matrix3_entries.hpp>
#include <softtissue/linalg/matrix_exponential.hpp>

namespace softtissue {

template <class S>
using Matrix9X = Eigen::Matrix<S, 9, Eigen::Dynamic>;

namespace detail {

/// exp of every lane of Q, or with `E` the derivative of exp there applied to the lane of E, without squarings; and what
/// tells which lanes need them. Flattened: a call would keep the loop from vectorising.
template <RealScalar S, class... Directions>
[[gnu::flatten]] void exponential_series_lanes(const Matrix3Lanes<S>& Q, S* norms, Matrix3Lanes<S>& result,
                                               const Directions&... E) {
    for (Index l = 0; l < Matrix3Lanes<S>::lanes; ++l) {
        const TraceSplit<S> A(Q.lane(l), S(1));
        norms[l] = quarter_row_norm(A.B);
        const CubicExponential<S> r = ExponentialSeries<S>::at(A.p, A.q);
        const S factor = branchless_exp(A.t);
        const Matrix3Entries<S> X = exponential_of(A, r, factor);
        if constexpr (sizeof...(E) == 0) {
            result.set_lane(l, X);
        } else {
            result.set_lane(l, exponential_derivative_of(A, r, factor, X, E.lane(l)...));
        }
    }
}

template <RealScalar S, class... Directions>
void exponential_lanes(const Matrix3Lanes<S>& Q, Matrix3Lanes<S>& result, const Directions&... E) {
    S norms[size_t(Matrix3Lanes<S>::lanes)];
    exponential_series_lanes(Q, norms, result, E...);
    for (Index l = 0; l < Matrix3Lanes<S>::lanes; ++l) {
        if (norms[l] > ExponentialSeries<S>::largest_norm / 4) {
            if constexpr (sizeof...(E) == 0) {
                result.set_lane(l, squared_exponential(Q.lane(l), Q.lane(l)).value);
            } else {
                result.set_lane(l, squared_exponential(Q.lane(l), E.lane(l)...).derivative);
            }
        }
    }
}

}  // namespace detail

/// consume(first, count, lanes) with the exponentials of `count` columns from `first` on, as long as they lie in lanes.
template <RealScalar S, class Consume, Executor E = SequentialExecutor>
void for_each_exponential_block(ConstRef<Matrix9X<S>> Q, const Consume& consume, const E& executor = {}) {
    for_each_lane_block(executor, Q.cols(), [&](Index first, Index count) {
        Matrix3Lanes<S> lanes, result;
        lanes.load(Q.col(first).data(), Q.outerStride(), count);
        detail::exponential_lanes(lanes, result);
        consume(first, count, result);
    });
}

/// exp of every column of Q.
template <RealScalar S, Executor E = SequentialExecutor>
void matrix_exponentials_into(ConstRef<Matrix9X<S>> Q, Eigen::Ref<Matrix9X<S>> out, const E& executor = {}) {
    require(out.cols() == Q.cols(), "matrix exponentials: ", out.cols(), " results, expected ", Q.cols());
    for_each_exponential_block<S>(
        Q,
        [&](Index first, Index count, const Matrix3Lanes<S>& exponentials) {
            exponentials.store(out.col(first).data(), out.outerStride(), count);
        },
        executor);
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
        detail::exponential_lanes(lanes, result, gradients);
        result.store(out.col(first).data(), out.outerStride(), count);
    });
}

}  // namespace softtissue
