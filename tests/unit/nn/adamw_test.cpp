// SPDX-License-Identifier: MIT
#include <softtissue/nn/adamw.hpp>

#include <softtissue/core/random.hpp>
#include <softtissue/core/thread_executor.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

namespace {

template <class S>
VectorX<S> random_vector(Index size, std::uint64_t seed) {
    RandomGenerator random(seed);
    return VectorX<S>::NullaryExpr(size, [&random] { return S(random.normal()); });
}

/// Parameters and moments.
template <class S>
struct Weights {
    VectorX<S> p, m, v;

    explicit Weights(Index size) : p(random_vector<S>(size, 1)), m(VectorX<S>::Zero(size)), v(VectorX<S>::Zero(size)) {}

    template <class E = SequentialExecutor>
    void update(const AdamWOptions& options, Index step, const E& executor = {}) {
        adamw_update(options, options.learning_rate, step, random_vector<S>(p.size(), 10 + std::uint64_t(step)), m, v,
                     p, executor);
    }
};

}  // namespace

TEST_CASE_TEMPLATE("ten steps as written in the paper", S, float, double) {
    const AdamWOptions options{
        .learning_rate = 0.02, .beta1 = 0.8, .beta2 = 0.95, .epsilon = 1e-6, .weight_decay = 0.1};
    constexpr Index size = 9;
    Weights<S> weights(size);
    VectorX<double> p = weights.p.template cast<double>(), m = VectorX<double>::Zero(size), v = m;
    for (Index step = 1; step <= 10; ++step) {
        weights.update(options, step);
        const VectorX<double> g = random_vector<S>(size, 10 + std::uint64_t(step)).template cast<double>();
        for (Index i = 0; i < size; ++i) {
            m(i) = 0.8 * m(i) + 0.2 * g(i);
            v(i) = 0.95 * v(i) + 0.05 * g(i) * g(i);
            const double m_hat = m(i) / (1 - std::pow(0.8, double(step))),
                         v_hat = v(i) / (1 - std::pow(0.95, double(step)));
            p(i) -= 0.02 * 0.1 * p(i);
            p(i) -= 0.02 * m_hat / (std::sqrt(v_hat) + 1e-6);
        }
    }
    CHECK((weights.p.template cast<double>() - p).norm() <= 20 * double(std::numeric_limits<S>::epsilon()) * p.norm());
    CHECK((weights.m.template cast<double>() - m).norm() <= 20 * double(std::numeric_limits<S>::epsilon()) * m.norm());
    CHECK((weights.v.template cast<double>() - v).norm() <= 20 * double(std::numeric_limits<S>::epsilon()) * v.norm());
}

TEST_CASE("the first step is the learning rate against the gradient's sign, whatever its size") {
    Weights<double> weights(3);
    weights.p.setZero();
    const VectorX<double> gradient{{1e-8, -3, 1e6}};
    adamw_update({.epsilon = 0, .weight_decay = 0}, 0.5, 1, gradient, weights.m, weights.v, weights.p);
    CHECK((weights.p - VectorX<double>{{-0.5, 0.5, -0.5}}).norm() <= 1e-13);
}

TEST_CASE("without gradient there is only decay") {
    Weights<double> weights(2);
    const VectorX<double> start = weights.p, gradient = VectorX<double>::Zero(2);
    adamw_update({.weight_decay = 0.1}, 0.5, 1, gradient, weights.m, weights.v, weights.p);
    CHECK((weights.p - 0.95 * start).norm() <= 1e-14);
}

TEST_CASE_TEMPLATE("same bits for any number of threads", S, float, double) {
    Weights<S> sequential(100001);
    sequential.update({}, 1);
    for (const int threads : {2, 7}) {
        Weights<S> parallel(100001);
        parallel.update({}, 1, ThreadExecutor(threads));
        CHECK(parallel.p == sequential.p);
        CHECK(parallel.v == sequential.v);
    }
}

TEST_CASE("bad options, steps and sizes are refused") {
    CHECK_NOTHROW(AdamWOptions{}.validate());
    CHECK_THROWS_WITH_AS(AdamWOptions{.beta1 = 1}.validate(), "AdamW: beta1 = 1, expected 0 <= beta1 < 1",
                         InvalidInput);
    CHECK_THROWS_AS(AdamWOptions{.beta2 = -0.1}.validate(), InvalidInput);
    CHECK_THROWS_AS(AdamWOptions{.learning_rate = std::numeric_limits<double>::quiet_NaN()}.validate(), InvalidInput);
    CHECK_THROWS_AS(AdamWOptions{.epsilon = -1}.validate(), InvalidInput);
    CHECK_THROWS_AS(AdamWOptions{.weight_decay = -1}.validate(), InvalidInput);
    VectorX<float> three = VectorX<float>::Zero(3), four = VectorX<float>::Zero(4);
    CHECK_THROWS_WITH_AS(adamw_update({}, 1, 1, four, three, three, three),
                         "AdamW: gradient of 4 and moments of 3 and 3 entries, expected 3", InvalidInput);
    CHECK_THROWS_WITH_AS(adamw_update({}, 1, 0, three, three, three, three), "AdamW: step 0, expected at least 1",
                         InvalidInput);
}
