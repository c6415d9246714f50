// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/prism_barrier.hpp>

#include <softtissue/testing/random_states.hpp>
#include <softtissue/testing/taylor_rate.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace softtissue;

namespace {

const Vector3<double> any_sines(1.3, 1.1, 2.0);

template <class S>
Prism6::Nodes<S> prism() {
    Prism6::Nodes<S> X;
    X << S(0), S(1), S(0.4), S(0.1), S(1.1), S(0.5), S(0), S(0), S(0.7), S(0), S(0.1), S(0.8), S(0), S(0), S(0.1),
        S(0.9), S(1), S(1);
    return X;
}

/// A random prism with positive coefficients.
template <class S>
Prism6::Nodes<S> valid_prism(RandomGenerator& random) {
    for (;;) {
        const Prism6::Nodes<S> X = prism<S>() + S(0.15) * random_normal<Prism6::Nodes<S>>(random);
        if (relative_coefficients<S>(X, any_sines.cast<S>()).minCoeff() > S(0.05)) {
            return X;
        }
    }
}

}  // namespace

TEST_CASE_TEMPLATE("zero for good prisms, positive for bad ones, infinite for inverted ones", S, float, double) {
    const PrismBarrier<S> barrier{S(0.4)};
    Prism6::Nodes<S> X = prism<S>();
    const Vector3<S> sines = any_sines.cast<S>();
    CHECK(barrier.energy(X, sines) == S(0));
    Vector3<S> gradient = Vector3<S>::Zero();
    Matrix3<S> hessian = Matrix3<S>::Zero();
    barrier.add_derivatives(X, sines, 2, gradient, hessian);
    CHECK(gradient == Vector3<S>::Zero());
    CHECK(hessian == Matrix3<S>::Zero());
    X.row(2) << S(0), S(0), S(0), S(1), S(1), S(1);
    S before(0);
    for (const S shift : {S(3), S(6), S(12), S(24)}) {  // the more shear, the more
        X.row(0).tail(3) = prism<S>().row(0).tail(3).array() + shift;
        const S energy = barrier.energy(X, sines);
        CHECK(energy > before);
        CHECK(std::isfinite(energy));
        before = energy;
    }
    X.row(2).tail(3).setConstant(S(-1));
    CHECK(barrier.energy(X, sines) == std::numeric_limits<S>::infinity());
    CHECK(barrier.energy(Prism6::Nodes<S>::Zero(), sines) == std::numeric_limits<S>::infinity());
}

TEST_CASE("the value is the sum over the nine coefficients") {
    const PrismBarrier<double> barrier{1.5};  // so high that most count
    RandomGenerator random(1);
    for (int sample = 0; sample < 20; ++sample) {
        const Prism6::Nodes<double> X = valid_prism<double>(random);
        double expected = 0;
        for (const double r : relative_coefficients<double>(X, any_sines).reshaped()) {
            const double q = r / 1.5;
            expected += q < 1 ? -(1 - q) * (1 - q) * std::log(q) : 0.0;
        }
        CHECK(barrier.energy(X, any_sines) == doctest::Approx(expected).epsilon(1e-13));
    }
}

TEST_CASE_TEMPLATE("gradient and Hessian are the derivatives, for every node", S, float, double) {
    const PrismBarrier<S> barrier{S(1.5)};
    const Vector3<S> sines = any_sines.cast<S>();
    RandomGenerator random(2);
    for (int sample = 0; sample < 6; ++sample) {
        const Prism6::Nodes<S> X = valid_prism<S>(random);
        for (int node = 0; node < 6; ++node) {
            CAPTURE(node);
            const Vector3<S> direction = S(0.1) * random_unit<Vector3<S>>(random);
            const auto derivatives = [&](S h, Matrix3<S>& hessian) {
                Prism6::Nodes<S> moved = X;
                moved.col(node) += h * direction;
                Vector3<S> gradient = Vector3<S>::Zero();
                hessian.setZero();
                barrier.add_derivatives(moved, sines, node, gradient, hessian);
                return gradient;
            };
            const auto energy = [&](S h) {
                Prism6::Nodes<S> moved = X;
                moved.col(node) += h * direction;
                return barrier.energy(moved, sines);
            };
            Matrix3<S> hessian;
            Matrix3<S> unused;
            const Vector3<S> gradient = derivatives(S(0), hessian);
            CHECK(taylor_rate(energy, gradient.dot(direction)).is_at_least(2));
            const auto gradients = [&](S h) { return derivatives(h, unused); };
            CHECK(taylor_rate(gradients, Vector3<S>(hessian * direction)).is_at_least(2));
            CHECK((hessian - hessian.transpose()).norm() <= S(16) * std::numeric_limits<S>::epsilon() * hessian.norm());
        }
    }
}

TEST_CASE("twice differentiable where a coefficient passes the threshold") {
    // Columns sheared along x: r falls through the threshold, seen alone. Just below it b ~ (1 - q)^3.
    const Vector3<double> sines = any_sines;
    Prism6::Nodes<double> X = prism<double>();
    const double smallest = relative_coefficients<double>(X, sines).minCoeff();
    const PrismBarrier<double> barrier{smallest * (1 + 1e-4)};
    CHECK(barrier.energy(X, sines) > 0);
    CHECK(barrier.energy(X, sines) < 9e-12);
    Vector3<double> gradient = Vector3<double>::Zero();
    Matrix3<double> hessian = Matrix3<double>::Zero();
    barrier.add_derivatives(X, sines, 0, gradient, hessian);
    CHECK(gradient.norm() < 1e-5);
    CHECK(hessian.norm() < 1e-1);
}
