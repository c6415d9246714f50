// SPDX-License-Identifier: MIT
// Symmetric matrices that are hard to diagonalise, and how well they are.
#pragma once

#include <softtissue/core/random.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

namespace softtissue_test {

template <class Scalar, int N>
using Square = Eigen::Matrix<Scalar, N, N>;

/// |A - Q diag(values) Q^T| and |Q^T Q - I|, the larger.
template <class S, int N>
S decomposition_error(const Square<S, N>& A, const Square<S, N>& Q, const Eigen::Matrix<S, N, 1>& values) {
    S error(0);
    for (int j = 0; j < N; ++j) {
        for (int i = 0; i < N; ++i) {
            S rebuilt(0), gram(0);
            for (int k = 0; k < N; ++k) {
                rebuilt += Q(i, k) * values(k) * Q(j, k);
                gram += Q(k, i) * Q(k, j);
            }
            error = std::max({error, std::abs(rebuilt - A(i, j)), std::abs(gram - S(i == j ? 1 : 0))});
        }
    }
    return error;
}

/// Q M Q^T, by loops that take no time to compile.
template <class S, int N>
Square<S, N> turned(const Square<S, N>& Q, const Square<S, N>& M) {
    Square<S, N> result;
    for (int j = 0; j < N; ++j) {
        for (int i = 0; i < N; ++i) {
            S sum(0);
            for (int k = 0; k < N; ++k) {
                for (int l = 0; l < N; ++l) {
                    sum += Q(i, k) * M(k, l) * Q(j, l);
                }
            }
            result(i, j) = sum;
        }
    }
    return result;
}

template <class S, int N>
Square<S, N> random_symmetric(softtissue::RandomGenerator& random) {
    Square<S, N> A;
    for (int j = 0; j < N; ++j) {
        for (int i = j; i < N; ++i) {
            A(i, j) = A(j, i) = S(random.uniform(-1, 1));
        }
    }
    return A;
}

template <class S, int N>
Square<S, N> tridiagonal(const Eigen::Matrix<S, N, 1>& diagonal, const Eigen::Matrix<S, N, 1>& below) {
    Square<S, N> T = Square<S, N>::Zero();
    for (int i = 0; i < N; ++i) {
        T(i, i) = diagonal(i);
        if (i + 1 < N) {
            T(i, i + 1) = T(i + 1, i) = below(i);
        }
    }
    return T;
}

/// Matrices that end early, late, or in the middle: blocks, repeated eigenvalues, graded, rank one, zero, tiny entries.
template <class S, int N>
std::vector<Square<S, N>> hard_matrices(softtissue::RandomGenerator& random) {
    std::vector<Square<S, N>> list{Square<S, N>::Zero(), Square<S, N>::Identity(), Square<S, N>::Ones(),
                                   -Square<S, N>::Identity(), -Square<S, N>::Ones()};
    for (int sample = 0; sample < 20; ++sample) {
        const Square<S, N> A = random_symmetric<S, N>(random);
        list.push_back(A);
        Square<S, N> blocks = A, graded = A, nearly_diagonal = A, neighbours = A;
        for (int j = 0; j < N; ++j) {
            for (int i = 0; i < N; ++i) {
                blocks(i, j) *= S((i < N / 2) == (j < N / 2) ? 1 : 0);
                graded(i, j) *= std::pow(S(0.05), S(i + j));
                nearly_diagonal(i, j) *= i == j ? S(1) : std::numeric_limits<S>::epsilon();
                neighbours(i, j) *= S(std::abs(i - j) < 2 ? 1 : 0);
            }
        }
        list.insert(list.end(), {blocks, graded, nearly_diagonal, neighbours});
        Eigen::Matrix<S, N, 1> v = A.col(0);
        v /= std::sqrt(v.squaredNorm());
        list.push_back(v * v.transpose());
        list.push_back(Square<S, N>::Identity() - S(2) * v * v.transpose());  // eigenvalues -1, 1, ..., 1
        list.push_back(S(2) * v * v.transpose() - Square<S, N>::Identity());  // 1, -1, ..., -1
        list.push_back(A * std::numeric_limits<S>::min());
    }
    return list;
}

}  // namespace softtissue_test
