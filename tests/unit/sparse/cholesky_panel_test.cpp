// SPDX-License-Identifier: MIT
#include <softtissue/sparse/cholesky_panel.hpp>

#include <softtissue/core/random.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

namespace {

/// L with a diagonal in [1, 2] and what it factors, in a panel whose columns are `stride` apart.
template <class S>
struct Example {
    MatrixX<S> L, panel;

    Example(Index height, Index width, Index stride, std::uint64_t seed)
        : L(MatrixX<S>::Zero(height, width)), panel(MatrixX<S>::Constant(stride, width, S(7))) {
        RandomGenerator random(seed);
        for (Index j = 0; j < width; ++j) {
            L(j, j) = S(random.uniform(1, 2));
            for (Index i = j + 1; i < height; ++i) {
                L(i, j) = S(random.uniform(-1, 1)) / S(width);
            }
        }
        const MatrixX<S> A = L * L.topRows(width).transpose();
        for (Index j = 0; j < width; ++j) {
            panel.col(j).segment(j, height - j) = A.col(j).tail(height - j);
        }
    }
};

}  // namespace

TEST_CASE_TEMPLATE("gives back the factor of every width and height", S, float, double) {
    for (const Index width : {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 12, 16, 17, 31, 48, 75}) {
        for (const Index below : {0, 1, 7, 8, 20, 61}) {
            CAPTURE(width);
            CAPTURE(below);
            const Index height = width + below;
            Example<S> example(height, width, height + 3, std::uint64_t(width * 100 + below));
            REQUIRE(factor_panel(example.panel.data(), height + 3, height, width));
            const MatrixX<S> lower = example.panel.topRows(height).template triangularView<Eigen::Lower>();
            CHECK((lower - example.L).cwiseAbs().sum() <=
                  S(40) * std::numeric_limits<S>::epsilon() * S(height * width));
            for (Index j = 0; j < width; ++j) {
                CHECK((example.panel.col(j).tail(3).array() == S(7)).all());
            }
        }
    }
}

TEST_CASE_TEMPLATE("a pivot that is not positive and finite is found wherever it is", S, float, double) {
    for (const Index width : {1, 3, 8, 20, 40}) {
        for (Index j = 0; j < width; ++j) {
            for (const S pivot :
                 {S(0), S(-1), std::numeric_limits<S>::quiet_NaN(), std::numeric_limits<S>::infinity()}) {
                Example<S> example(width + 9, width, width + 9, 5);
                example.panel(j, j) = pivot;
                CHECK_FALSE(factor_panel(example.panel.data(), width + 9, width + 9, width));
            }
        }
    }
}
