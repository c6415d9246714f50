// SPDX-License-Identifier: MIT
#include <softtissue/ndg/coefficient_loss.hpp>

#include <softtissue/ndg/network_training.hpp>
#include <softtissue/testing/random_states.hpp>
#include <softtissue/testing/taylor_rate.hpp>

#include <Eigen/QR>

#include <doctest/doctest.h>

using namespace softtissue;

static_assert(OutputLoss<CoefficientLoss<float>>);
static_assert(OutputLoss<CoefficientLoss<double>>);

namespace {

template <class S>
MatrixX<S> random_matrix(Index rows, Index cols, std::uint64_t seed) {
    RandomGenerator random(seed);
    return MatrixX<S>::NullaryExpr(rows, cols, [&random](Index, Index) { return S(random.normal()); });
}

const std::vector<std::int32_t> columns{3, 0, 3};

}  // namespace

TEST_CASE("the weighted loss is the decoded mean squared error") {
    const MatrixX<double> outputs = random_matrix<double>(4, 3, 1), targets = random_matrix<double>(4, 5, 2);
    MatrixX<double> decoder = Eigen::HouseholderQR<MatrixX<double>>(random_matrix<double>(11, 4, 3)).householderQ() *
                              MatrixX<double>::Identity(11, 4);
    decoder = decoder * Eigen::Vector4d(3, 2, 1, 0.1).asDiagonal();
    const CoefficientLoss<double> loss{decoder.colwise().squaredNorm().transpose() / 11};
    double expected = 0;
    for (Index k = 0; k < 3; ++k) {
        expected += (decoder * (outputs.col(k) - targets.col(columns[size_t(k)]))).squaredNorm() / 11 / 3;
    }
    CHECK(loss.loss(outputs, targets, columns, SequentialExecutor()) == doctest::Approx(expected).epsilon(1e-13));
}

TEST_CASE_TEMPLATE("its derivative, by Taylor rate", S, float, double) {
    const MatrixX<S> outputs = random_matrix<S>(4, 3, 1), targets = random_matrix<S>(4, 5, 2);
    const MatrixX<S> direction = random_matrix<S>(4, 3, 4);
    const CoefficientLoss<S> loss{random_matrix<S>(4, 1, 5).cwiseAbs()};
    const SequentialExecutor executor;
    MatrixX<S> gradient = outputs;
    const double value = loss.loss_and_gradient(gradient, targets, columns, executor);
    CHECK(value == loss.loss(outputs, targets, columns, executor));
    const auto along = [&](S h) { return S(loss.loss(outputs + h * direction, targets, columns, executor)); };
    CHECK(taylor_rate(along, gradient.cwiseProduct(direction).sum()).is_at_least(2));
    CHECK_FALSE(taylor_rate(along, S(1.1) * gradient.cwiseProduct(direction).sum()).is_at_least(2));
}

TEST_CASE("arrays that do not fit are refused") {
    const CoefficientLoss<double> loss{VectorX<double>::Ones(4)};
    const MatrixX<double> targets = MatrixX<double>::Zero(4, 5);
    const SequentialExecutor executor;
    CHECK_THROWS_WITH_AS(loss.loss(MatrixX<double>::Zero(3, 3), targets, columns, executor),
                         "coefficient loss: 3 outputs and 4 targets, expected 4", InvalidInput);
    CHECK_THROWS_WITH_AS(loss.loss(MatrixX<double>::Zero(4, 2), targets, columns, executor),
                         "coefficient loss: 3 samples, expected 2", InvalidInput);
}
