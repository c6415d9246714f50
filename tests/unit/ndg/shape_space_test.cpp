// SPDX-License-Identifier: MIT
#include <softtissue/ndg/shape_space.hpp>

#include <softtissue/core/random.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

namespace {

/// A box of points, longer, wider and higher by random factors.
template <class S>
std::vector<Matrix3X<S>> random_bodies(size_t count) {
    RandomGenerator random(2);
    const Matrix3X<S> body =
        Matrix3X<S>::NullaryExpr(3, 40, [&random](Index, Index) { return S(random.uniform(-1, 1)); });
    std::vector<Matrix3X<S>> bodies;
    for (size_t b = 0; b < count; ++b) {
        const Vector3<S> factors(S(1 + 0.3 * random.normal()), S(1 + 0.1 * random.normal()),
                                 S(1 + 0.05 * random.normal()));
        bodies.push_back(factors.asDiagonal() * body);
    }
    return bodies;
}

}  // namespace

TEST_CASE_TEMPLATE("three ways to differ make three coefficients, which give the body back", S, float, double) {
    const std::vector<Matrix3X<S>> bodies = random_bodies<S>(12);
    const ShapeSpace<S> space = ShapeSpace<S>::from_bodies(bodies, {});
    CHECK(space.num_vertices() == 40);
    REQUIRE(space.num_coefficients() == 3);
    S square(0);
    for (const Matrix3X<S>& body : bodies) {
        const VectorX<S> coefficients = space.encode(body);
        square += coefficients.squaredNorm() / S(3 * 11);
        CHECK((space.decode(coefficients) - body).cwiseAbs().maxCoeff() < S(200) * std::numeric_limits<S>::epsilon());
    }
    CHECK(square == doctest::Approx(1.0).epsilon(1e-4));
}

TEST_CASE("bodies of another size are refused") {
    std::vector<Matrix3X<double>> bodies = random_bodies<double>(12);
    const ShapeSpace<double> space = ShapeSpace<double>::from_bodies(bodies, {.max_components = 2});
    CHECK(space.num_coefficients() == 2);
    CHECK_THROWS_WITH_AS(space.encode(Matrix3X<double>::Zero(3, 39)), "shape space: a body of 39 vertices, expected 40",
                         InvalidInput);
    Matrix3X<double> spoilt = bodies[0];
    spoilt(1, 7) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS(space.encode(spoilt), "shape space: rest position of vertex 7 is not finite", InvalidInput);
    CHECK_THROWS_WITH_AS(space.decode(Eigen::Vector2d(0, std::numeric_limits<double>::infinity())),
                         "shape space: coefficient 1 = inf, expected a finite value", InvalidInput);
    bodies[3].resize(3, 41);
    CHECK_THROWS_WITH_AS(ShapeSpace<double>::from_bodies(bodies, {}),
                         "shape space: body 3 has 41 vertices, expected 40", InvalidInput);
    CHECK_THROWS_WITH_AS(ShapeSpace<double>::from_bodies({}, {}), "shape space: no bodies", InvalidInput);
    PrincipalComponents<double> broken = space.components();
    for (const double deviation : {0.0, std::numeric_limits<double>::infinity()}) {
        broken.standard_deviations(1) = deviation;
        CHECK_THROWS_WITH_AS(ShapeSpace<double>{broken}, "shape space: expected finite numbers and positive deviations",
                             InvalidInput);
    }
    CHECK(ShapeSpace<double>().num_coefficients() == 0);
}
