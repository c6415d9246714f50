// SPDX-License-Identifier: MIT
#include <softtissue/ndg/gradient_loss.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/ndg/network_training.hpp>
#include <softtissue/testing/random_states.hpp>
#include <softtissue/testing/taylor_rate.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

static_assert(OutputLoss<GradientLoss<float>>);
static_assert(OutputLoss<GradientLoss<double>>);

namespace {

template <class S>
MatrixX<S> random_matrix(Index rows, Index cols, S size, std::uint64_t seed) {
    RandomGenerator random(seed);
    return MatrixX<S>::NullaryExpr(rows, cols, [&](Index, Index) { return size * S(random.normal()); });
}

const std::vector<std::int32_t> columns{1, 3, 0};
constexpr Index num_cells = 530;  // more than a block

}  // namespace

TEST_CASE_TEMPLATE("exact predictions have no loss, others that of equation (17)", S, float, double) {
    const MatrixX<S> Q = random_matrix<S>(9 * num_cells, 3, S(0.4), 1);
    MatrixX<S> targets = MatrixX<S>::Zero(9 * num_cells, 4);
    for (const bool exponential : {true, false}) {
        const GradientLoss<S> loss{exponential};
        double expected = 0;
        for (Index k = 0; k < 3; ++k) {
            for (Index c = 0; c < num_cells; ++c) {
                const Matrix3<S> q = Q.col(k).segment(9 * c, 9).reshaped(3, 3).transpose();
                const Matrix3<S> F = exponential ? matrix_exponential<S>(q) : Matrix3<S>(Matrix3<S>::Identity() + q);
                targets.col(columns[size_t(k)]).segment(9 * c, 9) = F.transpose().reshaped();
            }
        }
        const SequentialExecutor executor;
        CHECK(loss.loss(Q, targets, columns, executor) < 1e-11);
        const MatrixX<S> moved = targets + random_matrix<S>(9 * num_cells, 4, S(0.1), 2);
        for (const std::int32_t column : columns) {
            expected += double((moved - targets).col(column).squaredNorm()) / double(9 * num_cells) / 3;
        }
        CHECK(loss.loss(Q, moved, columns, executor) == doctest::Approx(expected).epsilon(1e-5));
    }
}

TEST_CASE_TEMPLATE("its derivative, by Taylor rate; threads change no bit", S, float, double) {
    const MatrixX<S> Q = random_matrix<S>(9 * num_cells, 3, S(0.4), 1);
    const MatrixX<S> targets = random_matrix<S>(9 * num_cells, 4, S(1), 2);  // determinants of both signs
    const SequentialExecutor executor;
    const ThreadExecutor threads(3);
    for (const bool exponential : {true, false}) {
        const GradientLoss<S> loss{exponential};
        MatrixX<S> gradient = Q, with_threads = Q;
        const double value = loss.loss_and_gradient(gradient, targets, columns, executor);
        CHECK(value == loss.loss(Q, targets, columns, executor));
        CHECK(loss.loss_and_gradient(with_threads, targets, columns, threads) == value);
        CHECK(with_threads == gradient);
        const MatrixX<S> direction = gradient / gradient.cwiseAbs().maxCoeff();
        const auto along = [&](S h) { return S(loss.loss(Q + h * direction, targets, columns, executor)); };
        const S slope = gradient.cwiseProduct(direction).sum();
        CHECK(taylor_rate(along, slope).is_at_least(2));
        CHECK_FALSE(taylor_rate(along, S(1.1) * slope).is_at_least(2));
    }
}

TEST_CASE("arrays that do not fit are refused") {
    const GradientLoss<double> loss;
    const MatrixX<double> targets = MatrixX<double>::Zero(18, 5);
    const SequentialExecutor executor;
    CHECK_THROWS_WITH_AS(loss.loss(MatrixX<double>::Zero(9, 3), targets, columns, executor),
                         "gradient loss: 9 outputs and 18 targets, expected nine a cell", InvalidInput);
    CHECK_THROWS_WITH_AS(loss.loss(MatrixX<double>::Zero(17, 3), targets, columns, executor),
                         "gradient loss: 17 outputs and 18 targets, expected nine a cell", InvalidInput);
    CHECK_THROWS_WITH_AS(loss.loss(MatrixX<double>::Zero(18, 2), targets, columns, executor),
                         "gradient loss: 3 samples, expected 2", InvalidInput);
}
