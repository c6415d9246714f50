// SPDX-License-Identifier: MIT
#include <softtissue/energy/placement.hpp>

#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE_TEMPLATE("x = p + A d, and its transpose for forces", Scalar, float, double) {
    RandomGenerator random(1);
    Placement<Scalar> placement;
    placement.origins = random_normal<Eigen::Matrix<Scalar, 3, 2>>(random);
    const Eigen::Matrix<Scalar, 3, 2> d = random_normal<Eigen::Matrix<Scalar, 3, 2>>(random);
    const Vector3<Scalar> f = random_normal<Vector3<Scalar>>(random);
    Matrix3X<Scalar> x;

    CHECK_FALSE(placement.has_maps());
    placement.positions_into(d, x);
    CHECK(x == placement.origins + d);
    CHECK(placement.displacement(1, d.col(1)) == d.col(1));
    CHECK(placement.pull_back(1, f) == f);

    placement.maps = random_normal<Eigen::Matrix<Scalar, 3, 6>>(random);
    CHECK(placement.has_maps());
    placement.positions_into(d, x);
    const Matrix3<Scalar> A = placement.maps.template rightCols<3>();
    const Scalar tolerance = Scalar(64) * std::numeric_limits<Scalar>::epsilon();
    CHECK((x.col(1) - placement.origins.col(1) - A * d.col(1)).norm() < tolerance);
    CHECK(x.col(0) == placement.position(0, d.col(0)));
    // the work of f is the work of the force pulled back
    CHECK(std::abs(f.dot(placement.displacement(1, d.col(1))) - placement.pull_back(1, f).dot(d.col(1))) < tolerance);
}
