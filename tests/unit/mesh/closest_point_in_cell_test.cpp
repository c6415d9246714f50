// SPDX-License-Identifier: MIT
#include <softtissue/mesh/closest_point_in_cell.hpp>

#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace softtissue;

namespace {

/// A point of the reference cell; on its boundary if `on_boundary`.
template <class E, class S>
Vector3<S> random_coordinates(RandomGenerator& random, bool on_boundary) {
    Vector3<S> xi(S(random.uniform()), S(random.uniform()), S(random.uniform()));
    if (std::is_same_v<E, Tet4>) {
        while (xi.sum() > S(1)) {
            xi = Vector3<S>(S(random.uniform()), S(random.uniform()), S(random.uniform()));
        }
    } else {
        if (xi(0) + xi(1) > S(1)) {
            xi.template head<2>() = Eigen::Matrix<S, 2, 1>(S(1) - xi(0), S(1) - xi(1));
        }
        xi(2) = S(2) * xi(2) - S(1);
    }
    if (on_boundary) {
        const Index face = random.index(E::faces.size());
        if (std::is_same_v<E, Prism6> && face >= 3) {
            xi(2) = face == 3 ? S(1) : S(-1);
        } else {
            xi(face % 3 == 2 && std::is_same_v<E, Prism6> ? 0 : face % 3) = S(0);
        }
    }
    return xi;
}

/// Noise of a third of the size, and a shear of the top over the bottom.
template <class E, class S>
NodePositions<E, S> random_cell(RandomGenerator& random, double shear) {
    NodePositions<E, S> reference;
    if constexpr (std::is_same_v<E, Tet4>) {
        reference << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1;
    } else {
        reference << 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 1, 1;
    }
    Matrix3<S> sheared = Matrix3<S>::Identity();
    sheared(0, 2) = S(shear);
    NodePositions<E, S> X;
    do {
        X = sheared * (reference + S(0.2) * random_normal<NodePositions<E, S>>(random));
    } while (!(E::smallest_jacobian_bound(X) > S(0.05)));
    return X;
}

template <class E, class S>
double sampled_distance(const NodePositions<E, S>& X, const Vector3<S>& p) {
    constexpr int n = 24;
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; i + j <= n; ++j) {
            for (int k = 0; k <= n; ++k) {
                Vector3<S> xi(S(i) / n, S(j) / n, S(k) / n);
                if (std::is_same_v<E, Prism6>) {
                    xi(2) = S(2) * xi(2) - S(1);
                } else if (i + j + k > n) {
                    continue;
                }
                best = std::min(best, double((E::position(X, xi) - p).norm()));
            }
        }
    }
    return best;
}

}  // namespace

TEST_CASE("membership of the reference cells, boundary included, NaN not") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    CHECK(is_in_reference_cell<Tet4, double>({0, 0, 1}));
    CHECK(!is_in_reference_cell<Tet4, double>({0.5, 0.5, 0.25}));
    CHECK(!is_in_reference_cell<Tet4, double>({-0.1, 0.5, 0.25}));
    CHECK(!is_in_reference_cell<Tet4, double>({nan, 0.5, 0.25}));
    CHECK(is_in_reference_cell<Prism6, double>({0.5, 0.5, -1}));
    CHECK(!is_in_reference_cell<Prism6, double>({0.5, 0.75, 0}));
    CHECK(!is_in_reference_cell<Prism6, double>({0.5, 0.25, 1.1}));
    CHECK(!is_in_reference_cell<Prism6, double>({0.5, 0.25, nan}));
}

TEST_CASE_TEMPLATE("a point of the cell has distance 0 and its own coordinates", S, float, double) {
    RandomGenerator random(1);
    for (int n = 0; n < 200; ++n) {
        const auto check = [&]<class E>(E) {
            const NodePositions<E, S> X = random_cell<E, S>(random, n % 2 == 0 ? 0.0 : 1.5);
            const Vector3<S> xi = random_coordinates<E, S>(random, false);
            const CellPoint<S> found = closest_point_in_cell<E, S>(X, E::position(X, xi));
            // A point within rounding of the boundary may count as outside.
            const S rounding = S(500) * std::numeric_limits<S>::epsilon();
            CHECK(std::sqrt(found.squared_distance) <= rounding);
            CHECK((found.coordinates - xi).cwiseAbs().maxCoeff() <= rounding);
            const CellPoint<S> corner = closest_point_in_cell<E, S>(X, X.col(n % E::num_nodes));
            CHECK(std::sqrt(corner.squared_distance) <= rounding);
        };
        check(Tet4());
        check(Prism6());
    }
}

TEST_CASE_TEMPLATE("no sampled point of the cell is closer", S, float, double) {
    RandomGenerator random(2);
    for (int n = 0; n < 60; ++n) {
        const auto check = [&]<class E>(E) {
            const NodePositions<E, S> X = random_cell<E, S>(random, n % 3 == 0 ? 0.0 : 1.5);
            const Vector3<S> start = E::position(X, random_coordinates<E, S>(random, true));
            const Vector3<S> p = start + random_normal<Vector3<S>>(random) * S(n % 2 == 0 ? 1 : 0.05);
            const CellPoint<S> found = closest_point_in_cell<E, S>(X, p);
            const double distance = std::sqrt(double(found.squared_distance));
            CHECK(is_in_reference_cell<E, S>(
                found.coordinates.cwiseProduct(Vector3<S>::Constant(S(1) - S(4) * std::numeric_limits<S>::epsilon()))));
            const double rounding = 200 * double(std::numeric_limits<S>::epsilon());
            CHECK(std::abs((E::position(X, found.coordinates) - p).template cast<double>().norm() - distance) <=
                  rounding);
            const double sampled = sampled_distance<E, S>(X, p);
            CHECK(distance <= sampled + rounding);
            CHECK(distance >= sampled - 0.25);  // half the spacing of the samples, with room
        };
        check(Tet4());
        check(Prism6());
    }
}

TEST_CASE("columns that lean by 60 degrees still lead to the closest point") {
    Prism6::Nodes<double> X;
    X << 0, 1, 0, 1.732, 2.732, 1.732,  //
        0, 0, 1, 0, 0, 1,               //
        0, 0, 0, 1, 1, 1;
    // In front of the side y = 0, over the middle of it.
    const Vector3<double> p = 0.25 * (X.col(0) + X.col(1) + X.col(3) + X.col(4)) - Vector3<double>(0, 0.5, 0);
    const CellPoint<double> found = closest_point_in_cell<Prism6, double>(X, p);
    CHECK(std::sqrt(found.squared_distance) == doctest::Approx(0.5).epsilon(1e-12));
    CHECK((found.coordinates - Vector3<double>(0.5, 0, 0)).norm() < 1e-10);
}
