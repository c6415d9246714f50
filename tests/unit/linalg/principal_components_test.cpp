// SPDX-License-Identifier: MIT
#include <softtissue/linalg/principal_components.hpp>

#include <softtissue/core/random.hpp>
#include <softtissue/core/thread_executor.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

namespace {

/// d x n numbers of rank 6 and falling size, far from the origin.
template <class S>
MatrixX<S> random_samples(Index d, Index n) {
    RandomGenerator random(9);
    const auto normal = [&random](Index, Index) { return random.normal(); };
    const MatrixX<double> directions = MatrixX<double>::NullaryExpr(d, 6, normal);
    MatrixX<double> numbers = MatrixX<double>::NullaryExpr(6, n, normal);
    for (Index k = 0; k < 6; ++k) {
        numbers.row(k) *= std::pow(0.4, double(k));
    }
    const VectorX<double> mean = VectorX<double>::NullaryExpr(d, [&random](Index) { return 3 * random.normal(); });
    return ((directions * numbers).colwise() + mean).template cast<S>();
}

}  // namespace

TEST_CASE_TEMPLATE("the components are the eigenvectors of the covariance, in the order of variance", S, float,
                   double) {
    const MatrixX<S> samples = random_samples<S>(5000, 20);  // more than a piece
    const PrincipalComponents<S> found = principal_components<S>(samples);
    REQUIRE(found.num_components() == 6);
    CHECK(found.explained == doctest::Approx(1.0).epsilon(1e-6));
    const MatrixX<double> X = samples.template cast<double>();
    const VectorX<double> mean = X.rowwise().mean();
    const S tolerance = S(200) * std::numeric_limits<S>::epsilon();
    CHECK((found.mean.template cast<double>() - mean).cwiseAbs().maxCoeff() < double(tolerance));
    for (Index k = 0; k < 6; ++k) {
        CHECK((k == 0 || found.standard_deviations(k) < found.standard_deviations(k - 1)));
        Index largest = 0;
        found.components.col(k).cwiseAbs().maxCoeff(&largest);
        CHECK(found.components(largest, k) > S(0));
    }
    const MatrixX<S> gram = found.components.transpose() * found.components;
    CHECK((gram - MatrixX<S>::Identity(6, 6)).cwiseAbs().maxCoeff() < tolerance * S(10));
    for (Index k = 0; k < 20; ++k) {
        const VectorX<S> x = samples.col(k);
        CHECK((found.decode(found.encode(x)) - x).cwiseAbs().maxCoeff() < S(100) * tolerance);
    }
    // coefficients have variance 1 and are not correlated: so the components are the eigenvectors of the covariance
    MatrixX<double> coefficients(6, 20);
    for (Index k = 0; k < 20; ++k) {
        coefficients.col(k) = found.encode(samples.col(k)).template cast<double>();
    }
    const MatrixX<double> covariance = coefficients * coefficients.transpose() / 19;
    CHECK((covariance - MatrixX<double>::Identity(6, 6)).cwiseAbs().maxCoeff() < double(tolerance) * 100);
}

TEST_CASE("as many components as the variance asks for, or as are allowed") {
    const MatrixX<double> samples = random_samples<double>(300, 20);
    const PrincipalComponents<double> all = principal_components<double>(samples);
    const VectorX<double> variances = all.standard_deviations.cwiseAbs2() / all.standard_deviations.squaredNorm();
    for (const double variance : {0.5, 0.9, 0.99, 0.999}) {
        const PrincipalComponents<double> part = principal_components<double>(samples, {.variance = variance});
        const Index k = part.num_components();
        CHECK(part.explained >= variance);
        CHECK(variances.head(k).sum() == doctest::Approx(part.explained));
        CHECK(variances.head(k - 1).sum() < variance);
    }
    CHECK(principal_components<double>(samples, {.variance = 1.0, .max_components = 2}).num_components() == 2);
}

TEST_CASE_TEMPLATE("threads change no bit", S, float, double) {
    const MatrixX<S> samples = random_samples<S>(9000, 150);  // several pieces and tiles
    const ThreadExecutor threads(3);
    const PrincipalComponents<S> one = principal_components<S>(samples);
    const PrincipalComponents<S> three = principal_components<S>(samples, {}, threads);
    CHECK((one.mean == three.mean));
    CHECK((one.components == three.components));
    CHECK((one.standard_deviations == three.standard_deviations));
    const MatrixX<S> coefficients = one.encode_columns(samples);
    CHECK((one.encode_columns(samples, threads) == coefficients));
    for (const Index k : {0, 63, 64, 149}) {
        CHECK((coefficients.col(k) - one.encode(samples.col(k))).cwiseAbs().maxCoeff() <
              S(1e4) * std::numeric_limits<S>::epsilon());
    }
}

TEST_CASE("what has no components is refused") {
    MatrixX<double> samples = MatrixX<double>::Ones(4, 3);
    CHECK_THROWS_WITH_AS(principal_components<double>(samples), "principal components: all samples are equal",
                         InvalidInput);
    CHECK_THROWS_WITH_AS(principal_components<double>(samples.leftCols(1)),
                         "principal components: 1 samples, expected at least 2", InvalidInput);
    CHECK_THROWS_AS(principal_components<double>(samples, {.variance = 0.0}), InvalidInput);
    samples(2, 1) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS(principal_components<double>(samples), "principal components: a sample is not finite",
                         InvalidInput);
    const PrincipalComponents<double> some = principal_components<double>(random_samples<double>(30, 5));
    CHECK_THROWS_WITH_AS(some.encode(VectorX<double>::Zero(29)), "principal components: 29 numbers, expected 30",
                         InvalidInput);
    CHECK_THROWS_WITH_AS(some.decode(VectorX<double>::Zero(3)), "principal components: 3 coefficients, expected 4",
                         InvalidInput);
}
