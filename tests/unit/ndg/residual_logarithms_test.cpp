// SPDX-License-Identifier: MIT
#include <softtissue/ndg/residual_logarithms.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/linalg/matrix_exponential.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

namespace {

/// exp of the first matrix in `column`, as the network would.
template <class S>
Matrix3<S> exponential(const MatrixX<S>& logarithms, Index column = 0) {
    return matrix_exponential<S>(logarithms.col(column).reshaped(3, 3));
}

template <class S>
MatrixX<S> as_column(const Matrix3<S>& F) {
    return F.reshaped();
}

}  // namespace

TEST_CASE_TEMPLATE("the exponential gives them back; threads change no bit", S, float, double) {
    RandomGenerator random(1);
    MatrixX<S> residuals(18, 20);
    for (Index k = 0; k < residuals.size() / 9; ++k) {
        Eigen::Map<Matrix3<S>>(residuals.data() + 9 * k) = random_state<S>(StateClass::near_identity, random);
    }
    MatrixX<S> logarithms = residuals;
    const LogarithmCounts counts = residual_logarithms_in_place<S>(logarithms);
    CHECK(counts.repaired == 0);
    CHECK(counts.dropped == 0);
    for (Index k = 0; k < residuals.size() / 9; ++k) {
        const Matrix3<S> F = residuals.reshaped(9, 40).col(k).reshaped(3, 3);
        const MatrixX<S> Q = logarithms.reshaped(9, 40).col(k);
        CHECK((exponential(Q) - F).cwiseAbs().maxCoeff() < S(20) * std::numeric_limits<S>::epsilon());
    }
    const ThreadExecutor threads(3);
    MatrixX<S> again = residuals;
    residual_logarithms_in_place<S>(again, threads);
    CHECK(again == logarithms);
}

TEST_CASE("on both sides of the smallest stretch") {
    RandomGenerator random(2);
    const Matrix3<double> U = random_rotation<double>(random);
    for (const double stretch : {0.5, 0.1001, 0.0999, 1e-6, 0.0, -1e-3, -0.4}) {
        const Matrix3<double> F = U * Vector3<double>(1.3, 0.9, stretch).asDiagonal() * U.transpose();
        MatrixX<double> Q = as_column(F);
        const LogarithmCounts counts = residual_logarithms_in_place<double>(Q);
        CHECK(counts.dropped == 0);
        CHECK(counts.repaired == (stretch < smallest_stretch<double> ? 1 : 0));
        const Matrix3<double> expected =
            U * Vector3<double>(1.3, 0.9, std::max(stretch, smallest_stretch<double>)).asDiagonal() * U.transpose();
        CHECK((exponential(Q) - expected).cwiseAbs().maxCoeff() < 1e-12);
    }
}

TEST_CASE("a rotation by pi has no principal logarithm and is dropped") {
    const Matrix3<double> F = Vector3<double>(1, -1, -1).asDiagonal();
    MatrixX<double> Q = as_column(F);
    CHECK(residual_logarithms_in_place<double>(Q).dropped == 1);
    CHECK(Q.isZero(0));
}

TEST_CASE("numbers that are no matrices are refused") {
    MatrixX<double> Q = MatrixX<double>::Zero(10, 2);
    CHECK_THROWS_WITH_AS(residual_logarithms_in_place<double>(Q),
                         "residual logarithms: columns of 10 numbers, expected nine a matrix, without gaps",
                         InvalidInput);
}
