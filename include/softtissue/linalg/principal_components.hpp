// SPDX-License-Identifier: MIT
/// @file
/// Principal components of the columns of a matrix with far more rows than columns.
///
/// What        mean, orthonormal directions of largest variance, standard deviations along them; numbers in units of these.
/// Equation    x = mean + C diag(s) c;  C_k = X v_k / |X v_k| with the eigenvectors v_k of X^T X, X the centred columns;
///             s_k^2 = |X v_k|^2 / (n - 1)
/// Shapes      samples d x n, components C d x k, coefficients k
/// Choice      as many components as explain `variance` of the total, at most max_components; never one whose variance is
///             lost in rounding. Of each component the entry of largest magnitude is positive.
/// Valid       float samples: products are taken in float over pieces of the rows and added in double.
/// Refuses     fewer than two samples, samples that are not finite or all equal, a variance outside (0, 1] (InvalidInput)
/// Source      Turk, Pentland 1991 (the small matrix in place of the large one)
/// Cost        d n^2 + 10 n^3 + 2 d n k flop; the samples are centred in place. Same bits for every executor.
/// Tests       tests/unit/linalg/principal_components_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace softtissue {

struct PrincipalComponentsOptions {
    double variance = 1.0;
    Index max_components = std::numeric_limits<Index>::max();
};

template <RealScalar S>
struct PrincipalComponents {
    VectorX<S> mean;
    MatrixX<S> components;
    VectorX<S> standard_deviations;
    double explained = 0.0;  ///< part of the samples' variance

    Index num_components() const { return components.cols(); }

    /// Coefficients of x in standard deviations; what lies outside the components is lost.
    VectorX<S> encode(ConstRef<VectorX<S>> x) const {
        require(x.size() == mean.size(), "principal components: ", x.size(), " numbers, expected ", mean.size());
        return (components.transpose() * (x - mean)).cwiseQuotient(standard_deviations);
    }

    /// The coefficients of many columns.
    template <Executor E = SequentialExecutor>
    MatrixX<S> encode_columns(const MatrixX<S>& x, const E& executor = {}) const {
        require(x.rows() == mean.size(), "principal components: columns of ", x.rows(), " numbers, expected ",
                mean.size());
        constexpr Index tile = 64;
        MatrixX<S> coefficients(num_components(), x.cols());
        executor.for_each_range((x.cols() + tile - 1) / tile, [&](Index begin, Index end) {
            for (Index first = begin * tile; first < std::min(end * tile, x.cols()); first += tile) {
                const Index count = std::min(tile, x.cols() - first);
                const MatrixX<S> centred = x.middleCols(first, count).colwise() - mean;
                coefficients.middleCols(first, count).noalias() = components.transpose() * centred;
                coefficients.middleCols(first, count).array().colwise() /= standard_deviations.array();
            }
        });
        return coefficients;
    }

    VectorX<S> decode(ConstRef<VectorX<S>> coefficients) const {
        require(coefficients.size() == num_components(), "principal components: ", coefficients.size(),
                " coefficients, expected ", num_components());
        return mean + components * coefficients.cwiseProduct(standard_deviations);
    }
};

namespace detail {

/// Products of columns of X, in tiles; each entry sums pieces of the rows in a fixed order.
template <RealScalar S, Executor E>
MatrixX<double> gram_matrix(const MatrixX<S>& X, const E& executor) {
    constexpr Index tile = 128, piece = 4096;
    const Index tiles = (X.cols() + tile - 1) / tile;
    MatrixX<double> gram = MatrixX<double>::Zero(X.cols(), X.cols());
    executor.for_each_range(tiles * tiles, [&](Index begin, Index end) {
        MatrixX<S> product;
        for (Index k = begin; k < end; ++k) {
            const Index i = (k % tiles) * tile, j = (k / tiles) * tile;
            if (i > j) {
                continue;
            }
            const Index rows = std::min(tile, X.cols() - i), cols = std::min(tile, X.cols() - j);
            for (Index first = 0; first < X.rows(); first += piece) {
                const Index count = std::min(piece, X.rows() - first);
                product.noalias() = X.block(first, i, count, rows).transpose() * X.block(first, j, count, cols);
                gram.block(i, j, rows, cols) += product.template cast<double>();
            }
        }
    });
    gram.template triangularView<Eigen::StrictlyLower>() = gram.transpose();
    return gram;
}

}  // namespace detail

/// Takes the samples to centre them.
template <RealScalar S, Executor E = SequentialExecutor>
PrincipalComponents<S> principal_components(MatrixX<S> samples, const PrincipalComponentsOptions& options = {},
                                            const E& executor = {}) {
    const Index n = samples.cols();
    require(n >= 2, "principal components: ", n, " samples, expected at least 2");
    require(options.variance > 0 && options.variance <= 1 && options.max_components >= 1,
            "principal components: variance ", options.variance, ", at most ", options.max_components,
            " components, expected (0, 1] and at least 1");
    PrincipalComponents<S> result;
    result.mean.resize(samples.rows());
    executor.for_each_range(samples.rows(), [&](Index begin, Index end) {
        VectorX<double> sum = VectorX<double>::Zero(end - begin);
        for (Index k = 0; k < n; ++k) {
            sum += samples.col(k).segment(begin, end - begin).template cast<double>();
        }
        result.mean.segment(begin, end - begin) = (sum / double(n)).template cast<S>();
        for (Index k = 0; k < n; ++k) {
            samples.col(k).segment(begin, end - begin) -= result.mean.segment(begin, end - begin);
        }
    });
    require(result.mean.allFinite(), "principal components: a sample is not finite");
    const Eigen::SelfAdjointEigenSolver<MatrixX<double>> solver(detail::gram_matrix(samples, executor));
    const VectorX<double> eigenvalues = solver.eigenvalues().reverse().cwiseMax(0.0);
    const double total = eigenvalues.sum();
    require(total > 0, "principal components: all samples are equal");

    const double rounding = double(std::numeric_limits<S>::epsilon()) * double(n) * eigenvalues(0);
    double explained = 0;
    Index count = 0;
    while (count < std::min(n - 1, options.max_components) && explained < options.variance * total &&
           eigenvalues(count) > rounding) {
        explained += eigenvalues(count++);
    }
    result.explained = explained / total;
    const MatrixX<S> directions = solver.eigenvectors().rowwise().reverse().leftCols(count).template cast<S>();
    result.components.resize(samples.rows(), count);
    result.standard_deviations = (eigenvalues.head(count) / double(n - 1)).cwiseSqrt().template cast<S>();
    constexpr Index piece = 4096;
    executor.for_each_range((samples.rows() + piece - 1) / piece, [&](Index begin, Index end) {
        for (Index k = begin; k < end; ++k) {
            const Index rows = std::min(piece, samples.rows() - k * piece);
            result.components.middleRows(k * piece, rows).noalias() = samples.middleRows(k * piece, rows) * directions;
        }
    });
    executor.for_each_range(count, [&](Index begin, Index end) {
        for (Index k = begin; k < end; ++k) {
            Index largest = 0;
            result.components.col(k).cwiseAbs().maxCoeff(&largest);
            const double norm = result.components.col(k).template cast<double>().norm();
            result.components.col(k) *= S((result.components(largest, k) < S(0) ? -1 : 1) / norm);
        }
    });
    return result;
}

}  // namespace softtissue
