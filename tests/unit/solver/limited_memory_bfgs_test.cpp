// SPDX-License-Identifier: MIT
#include <softtissue/solver/limited_memory_bfgs.hpp>

#include <softtissue/core/random.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace softtissue;

namespace {

template <class S>
VectorX<S> random_vector(RandomGenerator& random, Index n = 5) {
    VectorX<S> v(n);
    for (S& value : v) {
        value = S(random.uniform(-1, 1));
    }
    return v;
}

/// The initial metric is 2 I.
template <class S>
VectorX<S> direction(LimitedMemoryBfgs<S>& memory, const VectorX<S>& gradient) {
    VectorX<S> p;
    memory.direction_into(
        gradient, [](const VectorX<S>& rhs, VectorX<S>& x) { x = rhs / S(2); }, p);
    return p;
}

}  // namespace

TEST_CASE_TEMPLATE("without memory the metric decides; the last step is met exactly; every direction descends", S,
                   float, double) {
    RandomGenerator random(4);
    LimitedMemoryBfgs<S> memory;
    const VectorX<S> g = random_vector<S>(random);
    CHECK(direction(memory, g) == -g / S(2));
    for (int k = 0; k < 20; ++k) {
        const VectorX<S> step = random_vector<S>(random);
        VectorX<S> change = random_vector<S>(random);
        change += (S(1.2) * std::abs(step.dot(change)) / step.squaredNorm() + S(0.5)) * step;
        memory.remember(step, change);
        CHECK(memory.size() == std::min(size_t(k + 1), LimitedMemoryBfgs<S>::capacity));
        CHECK((direction(memory, change) + step).norm() < S(200) * std::numeric_limits<S>::epsilon() * step.norm());
        const VectorX<S> other = random_vector<S>(random);
        CHECK(direction(memory, other).dot(other) < S(0));
    }
    memory.clear();
    CHECK(direction(memory, g) == -g / S(2));
}

TEST_CASE("as many steps as the quadratic has unknowns, each to the minimum of its line, find its minimum") {
    RandomGenerator random(5);
    Eigen::Matrix<double, 5, 5> A = Eigen::Matrix<double, 5, 5>::Identity();
    for (int k = 0; k < 5; ++k) {
        const VectorX<double> v = random_vector<double>(random);
        A += 3 * v * v.transpose();
    }
    VectorX<double> x = random_vector<double>(random);
    LimitedMemoryBfgs<double> memory;
    for (int k = 0; k < 5; ++k) {
        const VectorX<double> g = A * x;
        const VectorX<double> p = direction(memory, g);
        const VectorX<double> step = -g.dot(p) / p.dot(A * p) * p;
        x += step;
        memory.remember(step, A * step);
    }
    CHECK(x.norm() < 1e-10);
}

TEST_CASE("steps without positive curvature are not remembered") {
    LimitedMemoryBfgs<double> memory;
    const VectorX<double> step = VectorX<double>::Ones(3);
    memory.remember(step, -step);
    memory.remember(step, VectorX<double>::Zero(3));
    memory.remember(step, VectorX<double>::Constant(3, std::numeric_limits<double>::quiet_NaN()));
    CHECK(memory.size() == 0);
}
