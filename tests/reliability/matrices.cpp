// SPDX-License-Identifier: MIT
#include "doors.hpp"
#include "kinds.hpp"

#include <softtissue/core/random.hpp>
#include <softtissue/linalg/matrix_exponential.hpp>
#include <softtissue/linalg/matrix_logarithm.hpp>
#include <softtissue/linalg/polar.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/linalg/symmetric_eigen.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace reliability {

namespace {

using namespace softtissue;

/// Entries of any sizes: of one size, graded by rows and columns, of few values, of low rank, denormal or huge, next to the
/// identity or of two or three eigenvalues.
template <class S, int N>
Eigen::Matrix<S, N, N> any_matrix(RandomGenerator& random) {
    Eigen::Matrix<double, N, N> A;
    for (double& a : A.reshaped()) {
        a = random.normal();
    }
    const double range = std::log10(double(std::numeric_limits<S>::max()));
    switch (random.index(8)) {
        case 0:
            break;
        case 1:  // graded
            for (int i = 0; i < N; ++i) {
                A.row(i) *= std::pow(10, -random.uniform(0, 0.4 * range));
                A.col(i) *= std::pow(10, -random.uniform(0, 0.4 * range));
            }
            break;
        case 2:  // few values, many of them zero
            for (double& a : A.reshaped()) {
                a = double(random.index(3)) - 1;
            }
            break;
        case 3:  // low rank
            for (int i = 1; i < N; ++i) {
                A.row(i) = (random.uniform() < 0.8 ? random.normal() : 1e-9) * A.row(0);
            }
            break;
        case 4:  // denormal and tiny
            A *= std::pow(10, -random.uniform(0.9, 1.05) * range);
            break;
        case 5:  // huge
            A *= std::pow(10, random.uniform(0.8, 0.95) * range);
            break;
        case 6: {  // all eigenvalues equal but for one or two
            const Eigen::Matrix<double, N, 2> v = A.template leftCols<2>();
            A.setIdentity();
            A *= random.index(2) == 0 ? 1 : -1;
            const Index last = random.index(2);
            for (Index k = 0; k <= last; ++k) {
                A += random.normal() * v.col(k) * v.col(k).transpose();
            }
            break;
        }
        default:  // nearly a multiple of the identity
            A *= std::pow(10, -random.uniform(0, 20));
            A.diagonal().array() += 1;
            break;
    }
    return A.template cast<S>();
}

template <class S, int N>
void diagonalise(Ledger& ledger, const std::string& what, long count, std::uint64_t seed) {
    Tally& tally = ledger.begin("eigenvalues, " + what);
    for (long k = 0; k < count; ++k) {
        RandomGenerator random(seed + std::uint64_t(k));
        Eigen::Matrix<S, N, N> A = any_matrix<S, N>(random);
        A = (S(0.5) * (A + A.transpose())).eval();
        tally.attempt([&] {
            const SymmetricEigen<S, N> eigen = symmetric_eigen<S, N>(A);
            const double size = double(A.cwiseAbs().maxCoeff());
            const int exponent = size > 0 ? -std::ilogb(size) : 0;
            const auto unit = [exponent](S x) {
                return std::ldexp(double(x), exponent);
            };  // of the size of 1, whatever A is
            const Eigen::Matrix<double, N, N> V = eigen.vectors.template cast<double>();
            const Eigen::Matrix<double, N, 1> values = eigen.values.unaryExpr(unit);
            const Eigen::Matrix<double, N, N> error =
                V * values.asDiagonal() * V.transpose() - A.unaryExpr(unit).eval();
            const double epsilon = double(std::numeric_limits<S>::epsilon());
            const double floor = unit(std::numeric_limits<S>::denorm_min());  // numbers are no denser than that
            if (!(error.cwiseAbs().maxCoeff() <= 200 * epsilon + 4 * N * floor)) {
                tally.fail("the matrix does not come back: " + std::to_string(error.cwiseAbs().maxCoeff() / epsilon) +
                           " epsilon, size 10^" + std::to_string(std::log10(size)));
            }
            if (!((V.transpose() * V - Eigen::Matrix<double, N, N>::Identity()).cwiseAbs().maxCoeff() <=
                  200 * epsilon)) {
                tally.fail("the vectors are not orthonormal");
            }
            return Doors<S>::finite(eigen.values.allFinite() && eigen.vectors.allFinite());
        });
    }
    ledger.print_last();
}

template <class S>
void decompose(Ledger& ledger, const std::string& what, long count, std::uint64_t seed) {
    Tally& tally = ledger.begin("nearest rotation, exponential, logarithm, " + what);
    for (long k = 0; k < count; ++k) {
        RandomGenerator random(seed + std::uint64_t(k));
        const Matrix3<S> F = any_matrix<S, 3>(random);
        tally.attempt([&] {
            const Matrix3<S> R = polar_rotation(F);
            if (!is_rotation<S>(R, S(32) * std::numeric_limits<S>::epsilon())) {
                tally.fail("the nearest rotation is none");
            }
            const Matrix3<S> G = F / std::max(S(1), F.cwiseAbs().maxCoeff() / S(4));
            const Matrix3<S> X = matrix_exponential<S>(G);
            const std::optional<Matrix3<S>> Q = matrix_logarithm<S>(X);
            return Doors<S>::finite(X.allFinite() && (!Q || Q->allFinite()));
        });
    }
    ledger.print_last();
}

/// What is not finite must not come out as if it were.
template <class S, int N>
void spoil_one_entry(Ledger& ledger, const std::string& what) {
    Tally& tally = ledger.begin("an entry that is not finite, " + what);
    for (const S bad : {std::numeric_limits<S>::quiet_NaN(), std::numeric_limits<S>::infinity()}) {
        for (int j = 0; j < N; ++j) {
            for (int i = j; i < N; ++i) {
                RandomGenerator random(std::uint64_t(7 * N + i + j));
                Eigen::Matrix<S, N, N> A = any_matrix<S, N>(random);
                A(i, j) = A(j, i) = bad;
                tally.attempt([&] {
                    const SymmetricEigen<S, N> eigen = symmetric_eigen<S, N>(A);
                    if (!eigen.values.array().isNaN().all() || !eigen.vectors.array().isNaN().all()) {
                        tally.fail("some eigenvalues or vectors look like numbers");
                    }
                    const Eigen::Matrix<S, N, N> clamped = filtered<S, N>(A, PsdFilter::clamp);
                    if (clamped.allFinite()) {
                        tally.fail("a filtered matrix looks finite");
                    }
                    return Outcome{};
                });
            }
        }
    }
    ledger.print_last();
}

}  // namespace

void run_matrices(Ledger& ledger, long count, std::uint64_t seed) {
    spoil_one_entry<double, 3>(ledger, "3 x 3");
    spoil_one_entry<float, 9>(ledger, "9 x 9, float");
    diagonalise<double, 3>(ledger, "3 x 3", count, seed);
    diagonalise<double, 9>(ledger, "9 x 9", count, seed);
    diagonalise<float, 3>(ledger, "3 x 3, float", count, seed);
    diagonalise<float, 9>(ledger, "9 x 9, float", count, seed);
    decompose<double>(ledger, "double", count, seed);
    decompose<float>(ledger, "float", count, seed);
}

}  // namespace reliability
