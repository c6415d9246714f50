// SPDX-License-Identifier: MIT
#include <softtissue/ndg/rotated_exponentials.hpp>

#include <softtissue/core/random.hpp>
#include <softtissue/core/thread_executor.hpp>
#include <softtissue/ndg/residual_gradients.hpp>

#include <support/refusal.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <vector>

using namespace softtissue;
using softtissue_test::refusal;

namespace {

/// Cells with one to five bones, and turned bones, opposite signs of quaternions among them.
template <class N, class S>
struct Cells {
    BlendedRotations<S> blended;
    std::vector<Quaternion<S>> bones;
    Matrix9X<N> Q;

    explicit Cells(Index count) : blended(random_weights(count)), Q(9, count) {
        RandomGenerator random(2);
        for (int b = 0; b < 5; ++b) {
            Quaternion<S> q(S(random.normal()), S(random.normal()), S(random.normal()), S(random.normal()));
            bones.push_back(q / std::sqrt(q.squaredNorm()));
        }
        for (N& entry : Q.reshaped()) {
            entry = N(0.5 * random.normal());
        }
        if (count > 3) {
            Q.col(1).setZero();
            Q.col(3) *= N(20);  // a large one, which needs squarings
        }
    }

    static SkinningWeights<S> random_weights(Index count) {
        RandomGenerator random(1);
        MatrixX<S> weights = MatrixX<S>::Zero(count, 5);
        for (Index c = 0; c < count; ++c) {
            for (Index b = 0; b <= c % 5; ++b) {
                weights(c, b) = S(random.uniform(0.1, 1));
            }
            weights.row(c) /= weights.row(c).sum();
        }
        return SkinningWeights<S>(weights);
    }
};

template <class N, class S>
void check_against_steps(Index count) {
    const Cells<N, S> cells(count);
    Matrix9X<N> F(9, count), expected_F(9, count);
    Matrix3X<S> T, expected;
    rotated_exponentials_into<N, S>(cells.Q, cells.blended, cells.bones, F, T);
    matrix_exponentials_into<N>(cells.Q, expected_F);
    std::vector<Matrix3<S>> R(size_t(count), Matrix3<S>::Identity());
    cells.blended.rotations_into(cells.bones, R);
    target_gradients_into<N, S>(expected_F, R, expected);
    CHECK(F == expected_F);
    REQUIRE(T.cols() == 3 * count);
    for (Index c = 0; c < count; ++c) {
        CHECK((T.template middleCols<3>(3 * c) - expected.template middleCols<3>(3 * c)).cwiseAbs().maxCoeff() <=
              S(8) * std::numeric_limits<S>::epsilon() * expected.template middleCols<3>(3 * c).norm());
    }
    for (const int threads : {2, 3}) {
        Matrix3X<S> again;
        rotated_exponentials_into<N, S>(cells.Q, cells.blended, cells.bones, F, again, ThreadExecutor(threads));
        CHECK(again == T);
    }
}

}  // namespace

TEST_CASE("one pass gives what exponentials, rotations and products give one after the other") {
    for (const Index count : {1, 15, 16, 17, 100}) {
        check_against_steps<float, float>(count);
        check_against_steps<double, double>(count);
        check_against_steps<float, double>(count);
    }
}

TEST_CASE("arrays of other sizes are refused") {
    const Cells<float, float> cells(20);
    Matrix9X<float> F(9, 20), few(9, 19);
    Matrix3X<float> T;
    CHECK(refusal([&] { rotated_exponentials_into<float, float>(cells.Q, cells.blended, cells.bones, few, T); }) ==
          "rotated exponentials: 20 matrices and room for 19, expected 20");
    CHECK(refusal([&] {
              rotated_exponentials_into<float, float>(cells.Q, cells.blended, std::span(cells.bones).first(4), F, T);
          }) == "rotated exponentials: 4 bones, expected 5");
}
