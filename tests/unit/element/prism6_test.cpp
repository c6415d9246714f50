// SPDX-License-Identifier: MIT
#include <softtissue/element/prism6.hpp>

#include <softtissue/core/dual.hpp>
#include <softtissue/element/concepts.hpp>
#include <softtissue/testing/random_states.hpp>
#include <support/reference_case.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

using namespace softtissue;

static_assert(Element<Prism6, float> && Element<Prism6, double>);

namespace {

template <class Scalar>
using Nodes = NodePositions<Prism6, Scalar>;

template <class Scalar>
Nodes<Scalar> right_prism(double thickness = 1) {
    Nodes<Scalar> X;
    X << 0, 1, 0, 0, 1, 0,  //
        0, 0, 1, 0, 0, 1,   //
        0, 0, 0, 1, 1, 1;
    X.row(2) *= Scalar(thickness);
    return X;
}

/// Sheared, twisted and tapered as far as `amount` says, but with nine positive Bernstein coefficients.
Nodes<double> random_prism(RandomGenerator& random, double amount) {
    Nodes<double> X;
    do {
        X = right_prism<double>() + amount * random_normal<Nodes<double>>(random);
    } while (!(Prism6::smallest_jacobian_bound(X) > 1e-3));
    return X;
}

Nodes<double> permuted(const Nodes<double>& X, const std::array<int, 6>& order) {
    Nodes<double> result;
    for (int k = 0; k < 6; ++k) {
        result.col(k) = X.col(order[std::size_t(k)]);
    }
    return result;
}

/// Sums f(xi) det dX/d(lambda_1, lambda_2, s) by 4 x 4 x 4 Gauss points on the collapsed cube: exact to degree 6.
template <class Function>
void integrate(const Nodes<double>& X, const Function& f) {
    constexpr std::array<double, 4> points{0.069431844202973712, 0.33000947820757187, 0.66999052179242813,
                                           0.93056815579702629};
    constexpr std::array<double, 4> weights{0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                            0.17392742256872693};
    for (std::size_t a = 0; a < 4; ++a) {
        for (std::size_t b = 0; b < 4; ++b) {
            for (std::size_t c = 0; c < 4; ++c) {
                const Vector3<double> xi(points[a], points[b] * (1 - points[a]), 2 * points[c] - 1);
                Matrix3<double> frame;  // columns dX/d(lambda_1, lambda_2, s)
                const double s = points[c];
                frame.col(0) = (1 - s) * (X.col(1) - X.col(0)) + s * (X.col(4) - X.col(3));
                frame.col(1) = (1 - s) * (X.col(2) - X.col(0)) + s * (X.col(5) - X.col(3));
                frame.col(2) = (1 - xi(0) - xi(1)) * (X.col(3) - X.col(0)) + xi(0) * (X.col(4) - X.col(1)) +
                               xi(1) * (X.col(5) - X.col(2));
                const double jacobian = frame.col(0).cross(frame.col(1)).dot(frame.col(2));
                f(xi, weights[a] * weights[b] * weights[c] * (1 - points[a]) * jacobian);
            }
        }
    }
}

/// By elimination with full pivoting.
int rank(MatrixX<double> A) {
    const double threshold = 1e-12 * A.cwiseAbs().maxCoeff();
    int found = 0;
    Index row = 0;
    Index column = 0;
    while (A.cwiseAbs().maxCoeff(&row, &column) > threshold) {
        const VectorX<double> pivot_column = A.col(column) / A(row, column);
        const VectorX<double> pivot_row = A.row(row).transpose();
        A -= pivot_column * pivot_row.transpose();
        A.row(row).setZero();
        A.col(column).setZero();
        ++found;
    }
    return found;
}

}  // namespace

TEST_CASE_TEMPLATE("the right prism, by hand", Scalar, float, double) {
    const Nodes<Scalar> X = right_prism<Scalar>();
    CHECK(Prism6::rest_volume(X) == Scalar(0.5));
    CHECK(Prism6::smallest_jacobian_bound(X) == Scalar(1));
    const Scalar epsilon = std::numeric_limits<Scalar>::epsilon();
    CHECK((Prism6::shape_integrals(X).array() - Scalar(1) / Scalar(12)).abs().maxCoeff() < epsilon);
    Nodes<Scalar> g;                  // half of the tet-like gradients in the plane; -1/3 and 1/3 across
    g << -0.5, 0.5, 0, -0.5, 0.5, 0,  //
        -0.5, 0, 0.5, -0.5, 0, 0.5,   //
        -1, -1, -1, 1, 1, 1;
    g.row(2) /= Scalar(3);
    CHECK((Prism6::gradient_operator(X) - g).norm() < 20 * epsilon);
}

TEST_CASE("of the 720 node orders exactly the six symmetries have a positive bound") {
    const Nodes<double> X = right_prism<double>();
    std::array<int, 6> order;
    std::iota(order.begin(), order.end(), 0);
    int positive = 0;
    do {
        const bool is_symmetry =
            std::find(Prism6::symmetries.begin(), Prism6::symmetries.end(), order) != Prism6::symmetries.end();
        const bool is_positive = Prism6::smallest_jacobian_bound(permuted(X, order)) > 0;
        CHECK(is_positive == is_symmetry);
        positive += is_positive ? 1 : 0;
    } while (std::next_permutation(order.begin(), order.end()));
    CHECK(positive == 6);
}

TEST_CASE("the bound is sharp enough: what it calls positive is, and the corner Jacobians are among its nine") {
    RandomGenerator random(4);
    for (int sample = 0; sample < 200; ++sample) {
        const Nodes<double> X = right_prism<double>() + 0.35 * random_normal<Nodes<double>>(random);
        const double bound = Prism6::smallest_jacobian_bound(X);
        const double corner = (X.col(1) - X.col(0)).cross(X.col(2) - X.col(0)).dot(X.col(3) - X.col(0));
        CHECK(bound <= corner + 1e-15);
        integrate(X, [&](const Vector3<double>&, double weight) { CHECK((weight > 0 || bound <= 0)); });
    }
}

TEST_CASE("volume, shape integrals and the best affine fit agree with numerical quadrature") {
    RandomGenerator random(5);
    for (int sample = 0; sample < 50; ++sample) {
        const Nodes<double> X = random_prism(random, 0.15);
        NodeValues<Prism6, double> integrals = NodeValues<Prism6, double>::Zero();
        integrate(X, [&](const Vector3<double>& xi, double weight) { integrals += weight * Prism6::shape_values(xi); });
        const double volume = integrals.sum();
        CHECK(Prism6::rest_volume(X) == doctest::Approx(volume).epsilon(1e-14));
        CHECK((Prism6::shape_integrals(X) - integrals).norm() < 1e-14 * volume);

        const Vector3<double> centroid = X * integrals / volume;
        Matrix3<double> M = Matrix3<double>::Zero();
        Nodes<double> moments = Nodes<double>::Zero();
        integrate(X, [&](const Vector3<double>& xi, double weight) {
            const Vector3<double> local = Prism6::position(X, xi) - centroid;
            const NodeValues<Prism6, double> N = Prism6::shape_values(xi);
            for (int i = 0; i < 6; ++i) {
                moments.col(i) += weight * N(i) * local;
            }
            M += weight * local * local.transpose();
        });
        const Nodes<double> g = Prism6::gradient_operator(X);
        CHECK((M * g - moments).norm() < 1e-13 * moments.norm());
    }
}

TEST_CASE("the operator is the mean of dN/dX for right prisms and not for sheared ones") {
    const auto distance_to_mean = [](const Nodes<double>& X) {
        Nodes<double> mean = Nodes<double>::Zero();
        integrate(X,
                  [&](const Vector3<double>& xi, double weight) { mean += weight * Prism6::shape_gradients(X, xi); });
        mean /= Prism6::rest_volume(X);
        return (Prism6::gradient_operator(X) - mean).norm() / mean.norm();
    };
    Nodes<double> X = right_prism<double>(0.2);
    CHECK(distance_to_mean(X) < 1e-14);
    X.col(4) += Vector3<double>(0.3, 0.1, 0.1);
    CHECK(distance_to_mean(X) > 0.01);
}

TEST_CASE("single precision keeps its digits in a cell 30 mm wide, 1 mm thick and half a metre away") {
    RandomGenerator random(6);
    for (int sample = 0; sample < 50; ++sample) {
        Nodes<double> shape = right_prism<double>() + 0.05 * random_normal<Nodes<double>>(random);
        shape.row(2) /= 30;
        const Vector3<double> away = 0.5 * random_unit<Vector3<double>>(random);
        const Nodes<double> placed = (0.03 * random_rotation<double>(random) * shape).colwise() + away;
        const Nodes<float> X = placed.cast<float>();  // the rounded nodes are the cell
        const Nodes<double> g = Prism6::gradient_operator(X).cast<double>();
        const Nodes<double> expected = Prism6::gradient_operator<double>(X.cast<double>());
        // Grows with width / thickness = 30, once; twice for an M formed in world axes.
        CHECK((g - expected).norm() < 30 * 10 * double(std::numeric_limits<float>::epsilon()) * expected.norm());
    }
}

TEST_CASE("elasticity sees six strains: six rigid and six hourglass motions cost nothing") {
    RandomGenerator random(7);
    const Nodes<double> X = random_prism(random, 0.1);
    const Nodes<double> g = Prism6::gradient_operator(X);
    // F depends on 9 of 18 freedoms: three slopes of each component.
    const MatrixX<double> scalar_stiffness = Prism6::rest_volume(X) * g.transpose() * g;
    CHECK(rank(scalar_stiffness) == 3);

    MatrixX<double> elastic = MatrixX<double>::Zero(18, 18);  // |sym(grad u)|^2
    for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) {
            elastic.block<3, 3>(3 * i, 3 * j) = 0.5 * (g.col(i).dot(g.col(j)) * Matrix3<double>::Identity() +
                                                       g.col(j) * g.col(i).transpose());
        }
    }
    CHECK(rank(elastic) == 18 - 12);
}

TEST_CASE("every point of a sheared and twisted prism is found, and points around it") {
    RandomGenerator random(8);
    double worst = 0;
    for (int sample = 0; sample < 2000; ++sample) {
        const Nodes<double> X = random_prism(random, sample % 2 == 0 ? 0.1 : 0.3);
        const double condition = X.norm() * X.norm() * X.norm() / Prism6::smallest_jacobian_bound(X);
        for (int k = 0; k < 10; ++k) {
            Vector3<double> weights(random.uniform(), random.uniform(), random.uniform());
            weights /= weights.sum();
            const Vector3<double> xi(weights(0), weights(1), random.uniform(-1, 1));
            const Vector3<double> p = Prism6::position(X, xi);
            const NaturalCoordinates<double> found = Prism6::natural_coordinates(X, p);
            REQUIRE(found.converged);
            worst = std::max(worst, (found.coordinates - xi).norm() / condition);
        }
    }
    CHECK(worst < 100 * std::numeric_limits<double>::epsilon());
}

TEST_CASE("outside: continued linearly by a right prism, lost beyond 32 thicknesses, and for a flat cell") {
    const Nodes<double> X = right_prism<double>(0.01);
    const NaturalCoordinates<double> above = Prism6::natural_coordinates<double>(X, {0.25, 0.5, 0.05});
    CHECK(above.converged);
    CHECK((above.coordinates - Vector3<double>(0.25, 0.5, 9)).norm() < 1e-12);
    const NaturalCoordinates<double> beside = Prism6::natural_coordinates<double>(X, {-2, 3, 0.005});
    CHECK(beside.converged);
    CHECK((beside.coordinates - Vector3<double>(-2, 3, 0)).norm() < 1e-12);
    CHECK_FALSE(Prism6::natural_coordinates<double>(X, {0.25, 0.5, 0.5}).converged);
    const Nodes<double> flat = right_prism<double>(0);
    CHECK_FALSE(Prism6::natural_coordinates<double>(flat, {0.25, 0.25, 0}).converged);
}

TEST_CASE("the inverse map carries derivatives") {
    using D = Dual<double, 3>;
    RandomGenerator random(9);
    const Nodes<double> X = random_prism(random, 0.1);
    const Vector3<double> xi(0.2, 0.3, 0.4);
    const Vector3<double> p = Prism6::position(X, xi);
    const Vector3<D> moving(D::variable(p(0), 0), D::variable(p(1), 1), D::variable(p(2), 2));
    const NodeValues<Prism6, D> N =
        Prism6::shape_values(Prism6::natural_coordinates<D>(X.cast<D>(), moving).coordinates);
    const Nodes<double> expected = Prism6::shape_gradients(X, xi);
    for (int i = 0; i < 6; ++i) {
        for (int d = 0; d < 3; ++d) {
            CHECK(N(i).derivative[std::size_t(d)] == doctest::Approx(expected(d, i)).epsilon(1e-12));
        }
    }
}

#if __has_include(<zip.h>)
TEST_CASE("agrees with an independent 40-digit computation to 1e-12") {
    const std::optional<NpzFile> file = softtissue_test::reference_case("o2_prism.npz");
    if (!file) {
        return;
    }
    const auto all_X = file->at("X").matrices<double, 6, 3>();
    const auto g = file->at("g").matrices<double, 6, 3>();
    const auto phi = file->at("phi").matrices<double, 6, 3>();
    const auto A = file->at("A").matrices<double, 3, 3>();
    const VectorX<double> volume = file->at("volume").vector<double>();
    const MatrixX<double> integrals = file->at("int_N").matrix<double>();
    const auto xi = file->at("xi").as<double>();
    const auto x = file->at("x").as<double>();
    const auto N = file->at("N").as<double>();
    const auto dN = file->at("dNdx").as<double>();
    const std::size_t num_points = xi.size() / (4 * all_X.size());
    for (std::size_t c = 0; c < all_X.size(); ++c) {
        CAPTURE(c);
        const Nodes<double> X = all_X[c].transpose();
        const Nodes<double> operator_g = Prism6::gradient_operator(X);
        CHECK(std::abs(Prism6::rest_volume(X) / volume(Index(c)) - 1) < 1e-12);
        CHECK((Prism6::shape_integrals(X) - integrals.row(Index(c)).transpose()).norm() < 1e-12 * volume(Index(c)));
        CHECK((operator_g - g[c].transpose()).norm() < 1e-12 * g[c].norm());
        // From differences of positions: their distance from the origin would cost digits.
        const Nodes<double> moved = (phi[c].rowwise() - phi[c].row(0)).transpose();
        CHECK((moved * operator_g.transpose() - A[c]).norm() < 1e-12 * A[c].norm());
        for (std::size_t k = c * num_points; k < (c + 1) * num_points; ++k) {
            const Vector3<double> at(xi[4 * k + 1], xi[4 * k + 2], xi[4 * k + 3]);
            const Vector3<double> p(x[3 * k], x[3 * k + 1], x[3 * k + 2]);
            CHECK((Prism6::position(X, at) - p).norm() < 1e-12 * p.norm());
            const Eigen::Map<const NodeValues<Prism6, double>> values(&N[6 * k]);
            CHECK((Prism6::shape_values(at) - values).norm() < 1e-12);
            const Eigen::Map<const Nodes<double>> gradients(&dN[18 * k]);
            CHECK((Prism6::shape_gradients(X, at) - gradients).norm() < 1e-12 * gradients.norm());
            // Rounding of p itself, seen through the thickness, is up to 1e-12 in the stored coordinates.
            const NaturalCoordinates<double> found = Prism6::natural_coordinates(X, p);
            CHECK(found.converged);
            CHECK((found.coordinates - at).norm() < 2e-12);
        }
    }
}
#endif
