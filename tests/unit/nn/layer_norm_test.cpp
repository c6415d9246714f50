// SPDX-License-Identifier: MIT
#include <softtissue/nn/layer_norm.hpp>

#include <softtissue/testing/random_states.hpp>
#include <softtissue/testing/taylor_rate.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <vector>

using namespace softtissue;

namespace {

template <class S>
MatrixX<S> random_matrix(Index rows, Index columns, std::uint64_t seed) {
    RandomGenerator random(seed);
    return MatrixX<S>::NullaryExpr(rows, columns, [&random] { return S(random.normal()); });
}

/// Everything that a forward pass writes.
template <class S>
struct Normalized {
    MatrixX<S> n, y;
    VectorX<S> inverse_deviations;

    Normalized(const VectorX<S>& parameters, const MatrixX<S>& x)
        : n(x.rows(), x.cols()), y(x.rows(), x.cols()), inverse_deviations(x.cols()) {
        LayerNorm<S>(x.rows()).forward_into(parameters, x, n, inverse_deviations, y);
    }
};

}  // namespace

TEST_CASE_TEMPLATE("every column has mean 0 and variance 1, then weights and biases", S, float, double) {
    for (const Index features : {2, 15, 16, 49, 300}) {
        const VectorX<S> parameters = random_matrix<S>(2 * features, 1, 1);
        const MatrixX<S> x = (S(3) * random_matrix<S>(features, 4, 2)).array() + S(5);
        const Normalized<S> result(parameters, x);
        const double tolerance = 40 * double(std::numeric_limits<S>::epsilon());
        for (Index sample = 0; sample < 4; ++sample) {
            const VectorX<double> column = x.col(sample).template cast<double>();
            const double mean = column.mean();
            const double variance = (column.array() - mean).square().mean();
            const VectorX<double> n = (column.array() - mean) / std::sqrt(variance + 1e-5);
            CHECK((result.n.col(sample).template cast<double>() - n).cwiseAbs().maxCoeff() <= tolerance);
            const VectorX<double> y = parameters.head(features).template cast<double>().cwiseProduct(n) +
                                      parameters.tail(features).template cast<double>();
            CHECK((result.y.col(sample).template cast<double>() - y).cwiseAbs().maxCoeff() <= 4 * tolerance);
            CHECK(double(result.inverse_deviations(sample)) ==
                  doctest::Approx(1 / std::sqrt(variance + 1e-5)).epsilon(tolerance));
        }
    }
}

TEST_CASE("a constant column is the bias") {
    const VectorX<double> parameters = random_matrix<double>(10, 1, 1);
    const Normalized<double> result(parameters, MatrixX<double>::Constant(5, 1, 2.5));
    CHECK(result.n == MatrixX<double>::Zero(5, 1));
    CHECK(result.y == parameters.bottomRows(5));
}

TEST_CASE("in place gives the same bits") {
    const VectorX<float> parameters = random_matrix<float>(100, 1, 1);
    MatrixX<float> x = random_matrix<float>(50, 3, 2);
    const Normalized<float> expected(parameters, x);
    VectorX<float> inverse_deviations(3);
    LayerNorm<float>(50).forward_into(parameters, x, x, inverse_deviations, x);
    CHECK(x == expected.y);
}

TEST_CASE("gradients by parameters and by the input") {
    constexpr Index features = 37;
    const LayerNorm<double> layer(features);
    const VectorX<double> parameters = random_matrix<double>(2 * features, 1, 1);
    const MatrixX<double> x = random_matrix<double>(features, 3, 2);
    const VectorX<double> dp = random_matrix<double>(2 * features, 1, 3);
    const MatrixX<double> dx = random_matrix<double>(features, 3, 4);
    const MatrixX<double> dy = random_matrix<double>(features, 3, 5);
    const auto along = [&](double h) {
        return Normalized<double>(parameters + h * dp, x + h * dx).y.cwiseProduct(dy).sum();
    };
    const Normalized<double> forward(parameters, x);
    MatrixX<double> gradients = dy;
    VectorX<double> gradient = random_matrix<double>(2 * features, 1, 6);  // to be overwritten
    layer.backward_into(parameters, forward.n, forward.inverse_deviations, gradients, gradient);
    const double slope = gradient.dot(dp) + gradients.cwiseProduct(dx).sum();
    CHECK(taylor_rate(along, slope).is_at_least(2));
    CHECK(!taylor_rate(along, slope + 0.01).is_at_least(2));
}

TEST_CASE("the order of a sum does not depend on where its terms lie") {
    const MatrixX<float> terms = random_matrix<float>(1000, 1, 1);
    std::vector<float> copy(1001);
    std::copy(terms.data(), terms.data() + 1000, copy.data() + 1);
    const auto sum = [](const float* from) {
        return detail::lane_sum<float>(1000, [from](Index i) { return from[i]; });
    };
    CHECK(sum(terms.data()) == sum(copy.data() + 1));
    CHECK(sum(terms.data()) == doctest::Approx(double(terms.cast<double>().sum())).epsilon(1e-5));
}

TEST_CASE("no features are refused") {
    CHECK_THROWS_WITH_AS(LayerNorm<float>(0), "layer normalisation of 0 features, expected at least one", InvalidInput);
}
