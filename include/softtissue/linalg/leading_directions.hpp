// SPDX-License-Identifier: MIT
/// @file
/// The directions in which columns vary most, as a subspace.
///
/// What        leading_directions(): orthonormal columns that span what holds most of the variance of samples
/// Equation    Q <- orth(X X^T Q), X the centred samples, from a pivoted orthogonalisation of the samples: subspace iteration
/// Shapes      samples n x s, one a column; result n x k, k <= count: fewer if the samples span less
/// Valid       a start that pivots is already near; `rounds` of iteration, each gaining the ratio of variances inside and
///             outside. The columns are no principal directions: see principal_components.hpp for those.
/// Refuses     count < 1, samples that are not finite (InvalidInput)
/// Cost        4 n s k flop a round and 2 n k^2; no decomposition, hence quick to compile too
/// Tests       tests/unit/linalg/leading_directions_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace softtissue {

template <RealScalar S>
struct LeadingDirections {
    VectorX<S> mean;
    MatrixX<S> directions;
};

namespace detail {

/// Column k without its part along the columns before, of length one; what is left of its length before.
template <RealScalar S>
S orthonormalise_column(MatrixX<S>& Q, Index k) {
    S left(1);
    for (int pass = 0; pass < 2; ++pass) {  // the second takes away what rounding left
        for (Index i = 0; i < k; ++i) {
            Q.col(k) -= Q.col(i).dot(Q.col(k)) * Q.col(i);
        }
        const S length = std::sqrt(Q.col(k).squaredNorm());
        Q.col(k) /= length > S(0) ? length : S(1);
        left *= length;
    }
    return left;
}

}  // namespace detail

template <RealScalar S>
LeadingDirections<S> leading_directions(MatrixX<S> samples, Index count, int rounds = 4) {
    const Index n = samples.rows();
    require(count >= 1 && samples.cols() >= 1, "leading directions: ", count, " of ", samples.cols(),
            " samples, expected at least one of each");
    require(samples.allFinite(), "leading directions: a sample is not finite");
    LeadingDirections<S> result{VectorX<S>::Zero(n), MatrixX<S>(n, std::min({count, n, samples.cols()}))};
    for (Index s = 0; s < samples.cols(); ++s) {
        result.mean += samples.col(s) / S(samples.cols());
    }
    samples.colwise() -= result.mean;

    MatrixX<S>& Q = result.directions;
    MatrixX<S> rest = samples;
    const S largest = rest.colwise().squaredNorm().maxCoeff();
    const S rounding =
        S(100) * std::numeric_limits<S>::epsilon() * (result.mean.cwiseAbs().maxCoeff() + std::sqrt(largest));
    Index rank = 0;
    for (; rank < Q.cols(); ++rank) {
        Index pivot = 0;
        if (std::sqrt(rest.colwise().squaredNorm().maxCoeff(&pivot)) <= rounding) {
            break;
        }
        Q.col(rank) = rest.col(pivot);
        detail::orthonormalise_column(Q, rank);
        for (Index s = 0; s < rest.cols(); ++s) {
            rest.col(s) -= Q.col(rank).dot(rest.col(s)) * Q.col(rank);
        }
    }
    Q.conservativeResize(n, rank);
    for (int round = 0; round < rounds; ++round) {
        MatrixX<S> next = MatrixX<S>::Zero(n, rank);
        for (Index k = 0; k < rank; ++k) {
            for (Index s = 0; s < samples.cols(); ++s) {
                next.col(k) += samples.col(s).dot(Q.col(k)) * samples.col(s);
            }
        }
        for (Index k = 0; k < rank; ++k) {
            if (!(detail::orthonormalise_column(next, k) > S(0))) {
                return result;  // as good as it gets in rounding
            }
        }
        Q.swap(next);
    }
    return result;
}

}  // namespace softtissue
