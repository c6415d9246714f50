// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/prism_quality.hpp>

#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>

using namespace softtissue;

namespace {

/// A right prism of height h on the triangle (0, 0), (1, 0), (x, y).
template <class S>
Prism6::Nodes<S> right_prism(S x, S y, S h) {
    Prism6::Nodes<S> X;
    X << S(0), S(1), x, S(0), S(1), x, S(0), S(0), y, S(0), S(0), y, S(0), S(0), S(0), h, h, h;
    return X;
}

template <class S>
Vector3<S> inverse_sines(const Prism6::Nodes<S>& X) {
    Triangles triangle(3, 1);
    triangle << 3, 4, 5;
    return inverse_corner_sines<S>(Matrix3X<S>(X), triangle).col(0);
}

}  // namespace

TEST_CASE_TEMPLATE("a right prism has coefficients of one on any triangle, at any height", S, float, double) {
    for (const S x : {S(0.5), S(0.1), S(2)}) {
        for (const S h : {S(1e-3), S(1), S(50)}) {
            const Prism6::Nodes<S> X = right_prism<S>(x, S(0.6), h);
            const Matrix3<S> r = relative_coefficients<S>(X, inverse_sines(X));
            CHECK((r.array() - S(1)).abs().maxCoeff() < S(64) * std::numeric_limits<S>::epsilon());
        }
    }
}

TEST_CASE_TEMPLATE("shear multiplies them by the cosine; the other side makes them negative", S, float, double) {
    Prism6::Nodes<S> X = right_prism<S>(S(0.4), S(0.7), S(1));
    const Vector3<S> sines = inverse_sines(X);
    X.row(0).tail(3).array() += S(1);  // columns at 45 degrees
    const S tolerance = S(64) * std::numeric_limits<S>::epsilon();
    const S cosine = std::sqrt(S(0.5));
    CHECK((relative_coefficients<S>(X, sines).array() - cosine).abs().maxCoeff() < tolerance);
    X.row(2).tail(3).array() -= S(2);
    CHECK((relative_coefficients<S>(X, sines).array() + cosine).abs().maxCoeff() < tolerance);
    X = Prism6::Nodes<S>::Zero();
    CHECK(relative_coefficients<S>(X, sines) == Matrix3<S>::Zero());
    CHECK(scaled_jacobian<S>(X) == S(0));
}

TEST_CASE_TEMPLATE("positive coefficients are those with positive Bernstein coefficients, whatever the size", S, float,
                   double) {
    RandomGenerator random(3);
    for (int sample = 0; sample < 50; ++sample) {
        Prism6::Nodes<S> X = right_prism<S>(S(0.4), S(0.7), S(0.8));
        X += S(0.3) * random_normal<Prism6::Nodes<S>>(random);
        const Vector3<S> sines = inverse_sines(X);
        const Matrix3<S> r = relative_coefficients<S>(X, sines);
        CHECK(((r.array() > S(0)) == (Prism6::bernstein_jacobians(X).array() > S(0))).all());
        const Matrix3<S> larger = relative_coefficients<S>(Prism6::Nodes<S>(S(4) * X), sines);  // exact in binary
        CHECK(larger.isApprox(r, S(16) * std::numeric_limits<S>::epsilon()));
    }
}

TEST_CASE_TEMPLATE("the scaled Jacobian of the regular prism is one, of a right triangle 2/sqrt(3) of the worst corner",
                   S, float, double) {
    const S tolerance = S(16) * std::numeric_limits<S>::epsilon();
    const S height = S(0.5) * std::numbers::sqrt3_v<S>;
    CHECK(std::abs(scaled_jacobian<S>(right_prism<S>(S(0.5), height, S(3))) - S(1)) < tolerance);
    const S expected = S(2) * std::numbers::inv_sqrt3_v<S> * std::sqrt(S(0.5));  // 45 degrees
    CHECK(std::abs(scaled_jacobian<S>(right_prism<S>(S(0), S(1), S(1))) - expected) < tolerance);
}

TEST_CASE("nodes between two surfaces: the lower triangle first") {
    RandomGenerator random(5);
    const Matrix3X<double> lower = Matrix3X<double>::NullaryExpr(3, 4, [&] { return random.normal(); });
    const Matrix3X<double> upper = lower.array() + 1;
    Triangles triangles(3, 2);
    triangles << 0, 1, 1, 3, 2, 2;
    const Prism6::Nodes<double> X = nodes_between(triangles, 1, lower, upper);
    for (int k = 0; k < 3; ++k) {
        CHECK(X.col(k) == lower.col(triangles(k, 1)));
        CHECK(X.col(k + 3) == upper.col(triangles(k, 1)));
    }
}
