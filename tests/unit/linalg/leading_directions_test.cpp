// SPDX-License-Identifier: MIT
#include <softtissue/linalg/leading_directions.hpp>

#include <softtissue/core/random.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

namespace {

/// Numbers along the axes, each axis with less deviation than the one before, around a mean.
template <class S>
MatrixX<S> samples_along_axes(Index n, Index count, double ratio) {
    RandomGenerator random(1);
    MatrixX<S> x(n, count);
    for (Index s = 0; s < count; ++s) {
        double deviation = 1;
        for (Index i = 0; i < n; ++i, deviation *= ratio) {
            x(i, s) = S(3) + S(deviation * random.normal());
        }
    }
    return x;
}

/// The part of the variance that lies outside the directions.
template <class S>
double variance_outside(const MatrixX<S>& samples, const LeadingDirections<S>& leading) {
    double all = 0, inside = 0;
    for (Index s = 0; s < samples.cols(); ++s) {
        const VectorX<S> x = samples.col(s) - leading.mean;
        all += double(x.squaredNorm());
        for (Index k = 0; k < leading.directions.cols(); ++k) {
            const double part = double(leading.directions.col(k).dot(x));
            inside += part * part;
        }
    }
    return 1 - inside / all;
}

template <class S>
S deviation_from_orthonormal(const MatrixX<S>& Q) {
    S worst(0);
    for (Index i = 0; i < Q.cols(); ++i) {
        for (Index j = 0; j <= i; ++j) {
            worst = std::max(worst, std::abs(Q.col(i).dot(Q.col(j)) - S(i == j ? 1 : 0)));
        }
    }
    return worst;
}

}  // namespace

TEST_CASE_TEMPLATE("the variance outside is nearly the least possible", S, float, double) {
    const MatrixX<S> x = samples_along_axes<S>(30, 200, 0.8);
    double least = 0, all = 0;
    const auto leading = leading_directions<S>(x, 6);
    for (Index i = 0; i < 30; ++i) {
        const double variance = double((x.row(i).array() - leading.mean(i)).square().sum());
        all += variance;
        least += i < 6 ? 0.0 : variance;  // the axes are nearly the best directions
    }
    CHECK(leading.directions.cols() == 6);
    CHECK(deviation_from_orthonormal<S>(leading.directions) < S(20) * std::numeric_limits<S>::epsilon());
    CHECK(variance_outside<S>(x, leading) < 1.02 * least / all);
    CHECK(variance_outside<S>(x, leading_directions<S>(x, 6, 0)) > variance_outside<S>(x, leading));
    CHECK((leading.mean.array() - S(3)).abs().maxCoeff() < S(0.3));
}

TEST_CASE_TEMPLATE("as many directions as the samples span", S, float, double) {
    const MatrixX<S> x = samples_along_axes<S>(30, 4, 0.9);
    const auto leading = leading_directions<S>(x, 10);
    CHECK(leading.directions.cols() == 3);
    CHECK(std::abs(variance_outside<S>(x, leading)) < 1e-5);
    CHECK(leading_directions<S>(MatrixX<S>::Constant(5, 7, S(0.3)), 2).directions.cols() == 0);
    CHECK(leading_directions<S>(samples_along_axes<S>(4, 50, 0.9), 10).directions.cols() == 4);
}

TEST_CASE("no directions and samples that are not finite are refused") {
    MatrixX<double> x = MatrixX<double>::Ones(2, 3);
    CHECK_THROWS_WITH_AS(leading_directions<double>(x, 0),
                         "leading directions: 0 of 3 samples, expected at least one of each", InvalidInput);
    x(1, 1) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS(leading_directions<double>(x, 1), "leading directions: a sample is not finite", InvalidInput);
}
