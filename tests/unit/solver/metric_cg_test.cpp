// SPDX-License-Identifier: MIT
#include <softtissue/solver/metric_cg.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/solver/scalar_metric.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

constexpr Index n = 20;

/// A closed chain of springs (block -w I between neighbours) on anchors; weights vary around 1 by `spread`.
template <class S>
BlockMatrix<S> chain(double spread, double anchor, RandomGenerator& random) {
    std::vector<std::vector<std::int32_t>> neighbours(static_cast<size_t>(n));
    for (Index i = 0; i < n; ++i) {
        const std::int32_t j = std::int32_t((i + 1) % n);
        neighbours[size_t(i)].push_back(j);
        neighbours[size_t(j)].push_back(std::int32_t(i));
    }
    BlockMatrix<S> H{BlockPattern(std::move(neighbours))};
    const auto rank = [&](Index column, Index row) { return H.pattern().rank(column, std::int32_t(row)); };
    for (Index i = 0; i < n; ++i) {
        const Index j = (i + 1) % n;
        const Matrix3<S> stiffness = S(random.uniform(1 - spread, 1 + spread)) * Matrix3<S>::Identity();
        H.add(i, rank(i, i), stiffness + S(anchor) * Matrix3<S>::Identity());
        H.add(j, rank(j, j), stiffness);
        H.add(i, rank(i, j), -stiffness);
        H.add(j, rank(j, i), -stiffness);
    }
    return H;
}

template <class S>
VectorX<S> random_vector(RandomGenerator& random) {
    return VectorX<S>::NullaryExpr(3 * n, [&] { return S(random.normal()); });
}

}  // namespace

TEST_CASE_TEMPLATE("the system is solved to the tolerance asked for", Scalar, float, double) {
    RandomGenerator random(1);
    const BlockMatrix<Scalar> K0 = chain<Scalar>(0, 0.5, random), H = chain<Scalar>(0.6, 0.5, random);
    const VectorX<Scalar> rhs = random_vector<Scalar>(random);
    ScalarMetric<Scalar> metric;
    metric.factorize(K0, "K0");
    MetricCg<ScalarMetric<Scalar>> solver(metric);
    VectorX<Scalar> p;
    int last = 0;
    for (const Scalar tolerance : {Scalar(1e-1), Scalar(1e-3), Scalar(1e-5)}) {
        const LinearSolveResult result = solver.solve(H, rhs, tolerance, p, SequentialExecutor{});
        CHECK(result.is_positive_definite);
        CHECK(result.iterations > last);
        last = result.iterations;
        CHECK((H.matrix() * p - rhs).norm() <= Scalar(1.01) * tolerance * rhs.norm());
    }
    VectorX<Scalar> p_threads;
    CHECK(solver.solve(H, rhs, Scalar(1e-5), p_threads, ThreadExecutor(3)).iterations == last);
    CHECK(p == p_threads);
}

TEST_CASE("the matrix itself as metric leaves one iteration") {
    RandomGenerator random(2);
    const BlockMatrix<double> H = chain<double>(0.6, 0.5, random);
    ScalarMetric<double> metric;
    metric.factorize(H, "H");
    MetricCg<ScalarMetric<double>> solver(metric);
    VectorX<double> p;
    CHECK(solver.solve(H, random_vector<double>(random), 1e-12, p, SequentialExecutor{}).iterations == 1);
    CHECK(solver.solve(H, VectorX<double>::Zero(3 * n), 1e-12, p, SequentialExecutor{}).iterations == 0);
    CHECK(p.norm() == 0.0);
}

TEST_CASE("maps carry the metric into the world") {
    // H = Q K0 Q^T with a rotation per vertex: preconditioned with the maps it is the identity
    RandomGenerator random(3);
    const BlockMatrix<double> K0 = chain<double>(0.3, 0.5, random);
    Matrix3X<double> Q(3, 3 * n);
    for (Index v = 0; v < n; ++v) {
        Q.middleCols<3>(3 * v) = random_rotation<double>(random);
    }
    BlockMatrix<double> H(K0.pattern());
    const MatrixX<double> dense = K0.matrix().toDense();
    for (Index j = 0; j < n; ++j) {
        for (const std::int32_t i : K0.pattern().rows(j)) {
            H.add(j, K0.pattern().rank(j, i),
                  Q.middleCols<3>(3 * i) * dense.block<3, 3>(3 * i, 3 * j) * Q.middleCols<3>(3 * j).transpose());
        }
    }
    ScalarMetric<double> metric;
    metric.factorize(K0, "K0");
    MetricCg<ScalarMetric<double>> solver(metric);
    const VectorX<double> rhs = random_vector<double>(random);
    VectorX<double> p;
    const int without = solver.solve(H, rhs, 1e-8, p, SequentialExecutor{}).iterations;
    metric.maps() = Q;
    const LinearSolveResult with = solver.solve(H, rhs, 1e-8, p, SequentialExecutor{});
    CHECK(with.iterations == 1);
    CHECK(without > 5);
    CHECK((H.matrix() * p - rhs).norm() < 1e-8 * rhs.norm());
}

TEST_CASE("negative curvature is reported") {
    RandomGenerator random(4);
    const BlockMatrix<double> K0 = chain<double>(0, 0.5, random), indefinite = chain<double>(0, -0.5, random);
    ScalarMetric<double> metric;
    metric.factorize(K0, "K0");
    MetricCg<ScalarMetric<double>> solver(metric);
    VectorX<double> p;
    CHECK_FALSE(
        solver.solve(indefinite, random_vector<double>(random), 1e-8, p, SequentialExecutor{}).is_positive_definite);
}

TEST_CASE("numbers that leave the range of the scalar do not pass for a solution") {
    RandomGenerator random(5);
    const BlockMatrix<float> K = chain<float>(0, 0.5, random);
    ScalarMetric<float> metric;
    metric.factorize(K, "K");
    MetricCg<ScalarMetric<float>> solver(metric);
    VectorX<float> p, rhs = random_vector<float>(random);
    CHECK(solver.solve(K, rhs, 1e-4F, p, SequentialExecutor{}).is_positive_definite);
    rhs *= 1e25F;  // finite, but its norm is not
    CHECK_FALSE(solver.solve(K, rhs, 1e-4F, p, SequentialExecutor{}).is_positive_definite);
    rhs(0) = std::numeric_limits<float>::quiet_NaN();
    CHECK_FALSE(solver.solve(K, rhs, 1e-4F, p, SequentialExecutor{}).is_positive_definite);
}
