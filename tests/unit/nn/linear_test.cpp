// SPDX-License-Identifier: MIT
#include <softtissue/nn/linear.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/testing/random_states.hpp>
#include <softtissue/testing/taylor_rate.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <utility>

using namespace softtissue;

namespace {

template <class S>
MatrixX<S> random_matrix(Index rows, Index columns, std::uint64_t seed) {
    RandomGenerator random(seed);
    return MatrixX<S>::NullaryExpr(rows, columns, [&random] { return S(random.uniform(-1, 1)); });
}

}  // namespace

TEST_CASE_TEMPLATE("W x + b with W row after row, of one sample, of a few and of many rows", S, float, double) {
    for (const auto& size : {std::pair<Index, Index>{7, 1}, {7, 5}, {7, 1100}, {300, 257}}) {
        const Index inputs = size.first, outputs = size.second;
        const Linear<S> layer(inputs, outputs);
        REQUIRE(layer.num_parameters() == (inputs + 1) * outputs);
        const VectorX<S> parameters = random_matrix<S>(layer.num_parameters(), 1, 1);
        for (const Index batch : {1, 2, 19, 140}) {
            const MatrixX<S> x = random_matrix<S>(inputs, batch, 2);
            MatrixX<S> y(outputs, batch);
            layer.forward_into(parameters, x, y);
            double worst = 0;
            for (Index sample = 0; sample < batch; ++sample) {
                for (Index r = 0; r < outputs; ++r) {
                    double expected = double(parameters(inputs * outputs + r));
                    for (Index c = 0; c < inputs; ++c) {
                        expected += double(parameters(inputs * r + c)) * double(x(c, sample));
                    }
                    worst = std::max(worst, std::abs(double(y(r, sample)) - expected));
                }
            }
            CHECK(worst <= double(inputs + 3) * double(std::numeric_limits<S>::epsilon()));
        }
    }
}

TEST_CASE("gradients by parameters and by the input") {
    for (const Index outputs : {3, 600}) {
        const Linear<double> layer(5, outputs);
        const VectorX<double> parameters = random_matrix<double>(layer.num_parameters(), 1, 1);
        const MatrixX<double> x = random_matrix<double>(5, 4, 2), dy = random_matrix<double>(outputs, 4, 3);
        const VectorX<double> dp = random_matrix<double>(layer.num_parameters(), 1, 4);
        const MatrixX<double> dx = random_matrix<double>(5, 4, 5);
        const auto along = [&](double h) {
            const VectorX<double> moved = parameters + h * dp;
            MatrixX<double> y(outputs, 4);
            layer.forward_into(moved, x + h * dx, y);
            return y.cwiseProduct(dy).sum();
        };
        VectorX<double> gradient = random_matrix<double>(layer.num_parameters(), 1, 6);  // to be overwritten
        MatrixX<double> parts(5, layer.num_part_columns(4)), input_gradient(5, 4);
        layer.gradient_into(x, dy, gradient);
        layer.input_gradient_into(parameters, dy, parts, input_gradient);
        const double slope = gradient.cwiseProduct(dp).sum() + input_gradient.cwiseProduct(dx).sum();
        CHECK(taylor_rate(along, slope).is_at_least(2));
        CHECK(!taylor_rate(along, slope + 0.01).is_at_least(2));
    }
}

TEST_CASE_TEMPLATE("same bits for any number of threads", S, float, double) {
    const Linear<S> layer(33, 3000);
    const VectorX<S> parameters = random_matrix<S>(layer.num_parameters(), 1, 1);
    for (const Index batch : {1, 6}) {
        const MatrixX<S> x = random_matrix<S>(33, batch, 2), dy = random_matrix<S>(3000, batch, 3);
        const auto results = [&](const auto& executor) {
            MatrixX<S> y(3000, batch), dx(33, batch);
            VectorX<S> gradient(layer.num_parameters());
            MatrixX<S> parts(33, layer.num_part_columns(batch));
            layer.forward_into(parameters, x, y, executor);
            layer.gradient_into(x, dy, gradient, executor);
            layer.input_gradient_into(parameters, dy, parts, dx, executor);
            return std::vector<MatrixX<S>>{y, gradient, dx};
        };
        const std::vector<MatrixX<S>> expected = results(SequentialExecutor{});
        for (const int threads : {2, 7}) {
            CHECK(results(ThreadExecutor(threads)) == expected);
        }
    }
}

TEST_CASE("a layer of nothing is refused") {
    CHECK_THROWS_WITH_AS(Linear<float>(0, 3), "linear layer of 0 inputs and 3 outputs, expected at least one of each",
                         InvalidInput);
}
