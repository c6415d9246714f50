// SPDX-License-Identifier: MIT
#include <softtissue/ndg/gradient_network.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

constexpr Index num_cells = 600;  // more than a block

template <class S>
Mlp<S> random_network(S size) {
    Mlp<S> mlp({.inputs = 6, .hidden = {10, 5}, .outputs = 9 * num_cells});
    mlp.initialize(4, size);
    return mlp;
}

template <class S>
VectorX<S> random_input(std::uint64_t seed) {
    RandomGenerator random(seed);
    return VectorX<S>::NullaryExpr(6, [&random](Index) { return S(random.normal()); });
}

}  // namespace

TEST_CASE_TEMPLATE("the exponential of the network's outputs, or one more than them", S, float, double) {
    const Mlp<S> mlp = random_network<S>(S(0.5));
    const VectorX<S> input = random_input<S>(1);
    VectorX<S> outputs(9 * num_cells);
    auto scratch = mlp.make_scratch(1);
    mlp.infer_into(input, scratch, outputs);
    GradientNetwork<S> network(mlp, true), without(mlp, false);
    CHECK(network.num_cells() == num_cells);
    const MatrixX<S> F = network.predict(input);
    const MatrixX<S> G = without.predict(input);
    for (Index c = 0; c < num_cells; ++c) {
        const Matrix3<S> Q = outputs.segment(9 * c, 9).reshaped(3, 3);
        CHECK((F.col(c).reshaped(3, 3) - matrix_exponential<S>(Q)).cwiseAbs().maxCoeff() <
              S(50) * std::numeric_limits<S>::epsilon());
        CHECK(G.col(c).reshaped(3, 3) == Q + Matrix3<S>::Identity());
    }
    CHECK(network.residuals() == F);
    const ThreadExecutor threads(3);
    CHECK(network.predict(input, threads) == F);
}

TEST_CASE_TEMPLATE("no gradient is inverted, whatever the weights", S, float, double) {
    bool inverts_without = false;
    for (const double size : {0.1, 1.0, 3.0}) {  // at 3, logarithms of norms up to 10
        const Mlp<S> mlp = random_network<S>(S(size));
        GradientNetwork<S> network(mlp, true), without(mlp, false);
        for (std::uint64_t seed = 0; seed < 20; ++seed) {
            const VectorX<S> input = S(2) * random_input<S>(seed);
            network.predict(input);
            CHECK(network.smallest_determinant() > S(0));
            without.predict(input);
            inverts_without = inverts_without || without.smallest_determinant() < S(0);
        }
    }
    CHECK(inverts_without);
}

TEST_CASE("what is no gradient network is refused") {
    const Mlp<float> mlp({.inputs = 4, .hidden = {}, .outputs = 10});
    CHECK_THROWS_WITH_AS(GradientNetwork<float>(mlp, true), "gradient network: 10 outputs, expected nine for each cell",
                         InvalidInput);
    const Mlp<float> nine({.inputs = 4, .hidden = {}, .outputs = 9});
    GradientNetwork<float> network(nine, true);
    CHECK_THROWS_WITH_AS(network.predict(VectorX<float>::Zero(3)), "gradient network: 3 inputs, expected 4",
                         InvalidInput);
}
