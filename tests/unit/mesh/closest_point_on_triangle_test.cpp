// SPDX-License-Identifier: MIT
#include <softtissue/mesh/closest_point_on_triangle.hpp>

#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace softtissue;

namespace {

/// The distance from `p` to the closest of many points of the triangle.
template <class S>
double sampled_distance(const Matrix3<S>& corners, const Vector3<S>& p, int n) {
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; i + j <= n; ++j) {
            const Vector3<double> b(double(n - i - j) / n, double(i) / n, double(j) / n);
            best = std::min(best, (corners.template cast<double>() * b - p.template cast<double>()).norm());
        }
    }
    return best;
}

template <class S>
void check_closest(const Matrix3<S>& corners, const Vector3<S>& p) {
    constexpr int n = 60;
    const TrianglePoint<S> found = closest_point_on_triangle<S>(corners, p);
    const S size = (corners.colwise() - p).cwiseAbs().maxCoeff();
    const S rounding = S(16) * std::numeric_limits<S>::epsilon() * size;
    CHECK(found.barycentric.minCoeff() >= S(0));
    CHECK(std::abs(found.barycentric.sum() - S(1)) <= S(4) * std::numeric_limits<S>::epsilon());
    const S distance = std::sqrt(found.squared_distance);
    CHECK(std::abs((corners * found.barycentric - p).norm() - distance) <= rounding);
    const double sampled = sampled_distance(corners, p, n);
    const double spacing =
        double((corners.col(1) - corners.col(0)).norm() + (corners.col(2) - corners.col(0)).norm()) / n;
    CHECK(double(distance) <= sampled + double(rounding));
    CHECK(double(distance) >= sampled - spacing - double(rounding));
}

}  // namespace

TEST_CASE_TEMPLATE("no sampled point of the triangle is closer", S, float, double) {
    RandomGenerator random(1);
    for (int n = 0; n < 60; ++n) {
        Matrix3<S> corners = random_normal<Matrix3<S>>(random);
        switch (n % 6) {
            case 1:
                corners.col(2) = (corners.col(0) + corners.col(1)) / S(2) + S(1e-4) * corners.col(2);  // sliver
                break;
            case 2:
                corners.col(2) = (corners.col(0) + S(2) * corners.col(1)) / S(3);  // no area
                break;
            case 3:
                corners.col(1) = corners.col(2) = corners.col(0);
                break;
            default:
                break;
        }
        check_closest<S>(corners, random_normal<Vector3<S>>(random) * S(n % 2 == 0 ? 2 : 0.2));
        check_closest<S>(corners, corners.col(n % 3));
        check_closest<S>(corners, (corners.col(0) + corners.col(1)) / S(2));
    }
}

TEST_CASE("above the inside, an edge and a corner") {
    Matrix3<double> corners;
    corners << 0, 3, 0,  //
        0, 0, 3,         //
        0, 0, 0;
    const auto inside = closest_point_on_triangle<double>(corners, {1, 1, 2});
    CHECK(inside.squared_distance == doctest::Approx(4));
    CHECK(inside.barycentric.isApprox(Vector3<double>::Constant(1.0 / 3)));
    const auto edge = closest_point_on_triangle<double>(corners, {3, 3, 1});
    CHECK(edge.squared_distance == doctest::Approx(5.5));
    CHECK(edge.barycentric.isApprox(Vector3<double>(0, 0.5, 0.5)));
    const auto corner = closest_point_on_triangle<double>(corners, {-1, -2, 2});
    CHECK(corner.squared_distance == 9);
    CHECK(corner.barycentric == Vector3<double>(1, 0, 0));
}

TEST_CASE("the closest point of a segment stays on it") {
    const Vector3<double> a(0, 0, 0);
    const Vector3<double> b(2, 0, 0);
    CHECK(closest_point_on_segment<double>(a, b, {0.5, 3, 0}) == 0.25);
    CHECK(closest_point_on_segment<double>(a, b, {-1, 3, 0}) == 0);
    CHECK(closest_point_on_segment<double>(a, b, {9, 3, 0}) == 1);
    CHECK(closest_point_on_segment<double>(a, a, {9, 3, 0}) == 0);
}
