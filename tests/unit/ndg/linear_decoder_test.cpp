// SPDX-License-Identifier: MIT
#include <softtissue/ndg/linear_decoder.hpp>

#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

namespace {

template <class S>
MatrixX<S> random_matrix(Index rows, Index cols, RandomGenerator& random) {
    return MatrixX<S>::NullaryExpr(rows, cols, [&random](Index, Index) { return S(random.normal()); });
}

}  // namespace

TEST_CASE_TEMPLATE("folded or behind the network: the same numbers", S, float, double) {
    RandomGenerator random(1);
    for (const std::vector<Index>& hidden : {std::vector<Index>{8, 3}, std::vector<Index>{}}) {
        Mlp<S> mlp({.inputs = 4, .hidden = hidden, .outputs = 5});
        mlp.initialize(2);
        const LinearDecoder<S> decoder{random_matrix<S>(11, 5, random), random_matrix<S>(11, 1, random)};
        const Mlp<S> folded = fold_decoder(mlp, decoder);
        CHECK(folded.sizes().inputs == 4);
        CHECK(folded.sizes().hidden == hidden);
        CHECK(folded.sizes().outputs == 11);
        const MatrixX<S> inputs = random_matrix<S>(4, 3, random);
        MatrixX<S> coefficients(5, 3), outputs(11, 3);
        auto scratch = mlp.make_scratch(3);
        mlp.infer_into(inputs, scratch, coefficients);
        auto folded_scratch = folded.make_scratch(3);
        folded.infer_into(inputs, folded_scratch, outputs);
        const MatrixX<S> expected = (decoder.weight * coefficients).colwise() + decoder.bias;
        CHECK((outputs - expected).cwiseAbs().maxCoeff() < S(100) * std::numeric_limits<S>::epsilon());
    }
}

TEST_CASE("a decoder of other coefficients is refused") {
    const Mlp<double> mlp({.inputs = 4, .hidden = {}, .outputs = 5});
    const LinearDecoder<double> four{MatrixX<double>::Zero(11, 4), VectorX<double>::Zero(11)};
    CHECK_THROWS_WITH_AS(fold_decoder(mlp, four), "linear decoder: 4 coefficients and 11 biases, expected 5 and 11",
                         InvalidInput);
    const LinearDecoder<double> ten{MatrixX<double>::Zero(11, 5), VectorX<double>::Zero(10)};
    CHECK_THROWS_WITH_AS(fold_decoder(mlp, ten), "linear decoder: 5 coefficients and 10 biases, expected 5 and 11",
                         InvalidInput);
}
