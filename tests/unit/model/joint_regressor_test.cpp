// SPDX-License-Identifier: MIT
#include <softtissue/model/joint_regressor.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace softtissue;

namespace {

/// Points on two crossing tubes, in general position.
Matrix3X<double> tubes() {
    Matrix3X<double> x(3, 1200);
    for (Index i = 0; i < x.cols(); ++i) {
        const double angle = 2.399963 * double(i);
        const double along = double(i % 600) / 600.0 - 0.5;
        const Vector3<double> p(0.05 * std::cos(angle), along, 0.06 * std::sin(angle));
        x.col(i) = i < 600 ? p : Vector3<double>(p(1) + 0.3, p(0), p(2));
    }
    return x;
}

}  // namespace

TEST_CASE("JointRegressor: rows sum to one, reproduce joints, follow affine shape directions, and are sparse") {
    const Matrix3X<double> x = tubes();
    Matrix3X<double> joints(3, 2);
    joints.col(0) << 0.01, 0.2, -0.01;
    joints.col(1) << 0.35, 0.0, 0.02;
    Matrix3<double> A;
    A << 0.02, 0.01, 0.0, -0.01, 0.03, 0.0, 0.0, 0.01, -0.02;
    const Matrix3X<double> moved = A * x;
    const MatrixX<double> directions = Eigen::Map<const MatrixX<double>>(moved.data(), 3 * x.cols(), 1);
    const JointRegressor regressor;
    const auto R = regressor(x, joints, directions, {Matrix3X<double>(A * joints)});
    REQUIRE(R.rows() == 2);
    REQUIRE(R.cols() == x.cols());
    for (Index j = 0; j < 2; ++j) {
        CHECK(std::abs(R.row(j).sum() - 1.0) < 1e-14);
        CHECK(R.row(j).nonZeros() <= regressor.support);
        CHECK(R.row(j).nonZeros() > 8);
        CHECK(R.row(j).coeffs().abs().maxCoeff() < 0.5);
    }
    const Matrix3X<double> found = (R * x.transpose()).transpose();
    CHECK((found - joints).cwiseAbs().maxCoeff() < 1e-12);
    // An affine direction holds for every exact row: the tolerance costs nothing.
    const Matrix3X<double> followed = (R * moved.transpose()).transpose();
    CHECK((followed - A * joints).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("JointRegressor: a direction that is not affine is followed far better than by nearness alone") {
    const Matrix3X<double> x = tubes();
    Matrix3X<double> joints(3, 1);
    joints.col(0) << 0.0, 0.2, 0.0;
    Matrix3X<double> moved = Matrix3X<double>::Zero(3, x.cols());
    for (Index i = 0; i < x.cols(); ++i) {
        moved(1, i) = 0.02 + x(0, i) * x(0, i) - x(2, i) * x(2, i);
    }
    const MatrixX<double> directions = Eigen::Map<const MatrixX<double>>(moved.data(), 3 * x.cols(), 1);
    Matrix3X<double> wanted = Matrix3X<double>::Zero(3, 1);
    wanted(1, 0) = 0.02;  // x^2 - z^2 is nothing on the tube's axis
    const auto with = JointRegressor{.support = 48, .tolerance = 5e-5}(x, joints, directions, {wanted});
    const auto without = JointRegressor()(x, joints, MatrixX<double>(3 * x.cols(), 0), {});
    const double error_with = std::abs((with * moved.transpose())(0, 1) - 0.02);
    const double error_without = std::abs((without * moved.transpose())(0, 1) - 0.02);
    CHECK(error_without > 1e-4);
    CHECK(error_with < 0.3 * error_without);
}
