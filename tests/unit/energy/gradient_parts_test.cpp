// SPDX-License-Identifier: MIT
#include <softtissue/energy/gradient_parts.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

constexpr int num_nodes = 3;
constexpr Index num_vertices = 70;
template <class S>
using Parts = GradientParts<num_nodes, S>;

/// Triples of vertices with whole numbers for gradients: sums are exact in any order.
template <class S>
struct Triples {
    Connectivity<num_nodes> vertices;
    Matrix3X<S> gradients;
    Matrix3X<S> sums = Matrix3X<S>::Constant(3, num_vertices, S(5));

    explicit Triples(Index count) : vertices(num_nodes, count), gradients(3, num_nodes * count) {
        RandomGenerator random(2);
        for (Index k = 0; k < vertices.size(); ++k) {
            vertices.data()[k] = std::int32_t(random.index(num_vertices - 1));  // the last vertex belongs to none
            gradients.col(k) = Vector3<S>(S(k % 17), S(k % 5) - S(2), S(k % 7));
            sums.col(vertices.data()[k]) += gradients.col(k);
        }
    }

    /// Added to fives, N by N.
    template <int N, Executor E>
    Matrix3X<S> added(const E& executor) const {
        Matrix3X<S> result = Matrix3X<S>::Constant(3, num_vertices, S(5));
        Parts<S> parts(vertices, num_vertices);
        CHECK(parts.num_stencils() == vertices.cols());
        CHECK(parts.num_vertices() == num_vertices);
        const auto fill = [&](Index pack, S* slots) {
            for (int lane = 0; lane < N; ++lane) {
                for (int a = 0; a < num_nodes; ++a) {
                    S* const column = slots + Parts<S>::template column_offset<N>(a, lane);
                    const Index s = N * pack + lane;
                    if (s < vertices.cols()) {
                        Eigen::Map<Vector3<S>>{column} = gradients.col(num_nodes * s + a);
                    } else {
                        Eigen::Map<Vector3<S>>{column}.setConstant(S(1e9));  // must not count
                    }
                    column[3] = S(1e9);
                }
            }
        };
        for (int repetition = 0; repetition < 2; ++repetition) {  // sums do not stay
            result.setConstant(S(5));
            parts.template add<N>(executor, fill, result);
        }
        return result;
    }
};

}  // namespace

TEST_CASE_TEMPLATE("gradients are added to their vertices, one by one or in packs, by any number of threads", S, float,
                   double) {
    for (const Index count : {Index(1), Index(37), 3 * Parts<S>::part - 10}) {
        const Triples<S> triples(count);
        CHECK(triples.template added<1>(SequentialExecutor{}) == triples.sums);
        CHECK(triples.template added<4>(SequentialExecutor{}) == triples.sums);
        CHECK(triples.template added<16>(SequentialExecutor{}) == triples.sums);
        CHECK(triples.template added<16>(ThreadExecutor(2)) == triples.sums);
        CHECK(triples.template added<4>(ThreadExecutor(7)) == triples.sums);
    }
}

TEST_CASE_TEMPLATE("sums have the same bits for packs of any width and any number of threads", S, float, double) {
    Triples<S> triples(3 * Parts<S>::part - 10);
    RandomGenerator random(3);
    for (Index k = 0; k < triples.gradients.cols(); ++k) {
        triples.gradients.col(k) = random_normal<Vector3<S>>(random);
    }
    const Matrix3X<S> one = triples.template added<1>(SequentialExecutor{});
    CHECK(triples.template added<16>(SequentialExecutor{}) == one);
    CHECK(triples.template added<8>(ThreadExecutor(2)) == one);
    CHECK(triples.template added<8>(ThreadExecutor(5)) == one);
}

TEST_CASE("no stencils, nothing added") {
    Parts<double> parts(Connectivity<num_nodes>(num_nodes, 0), 4);
    Matrix3X<double> gradient = Matrix3X<double>::Ones(3, 4);
    parts.add<4>(
        ThreadExecutor(2), [](Index, double*) { FAIL("nothing to fill"); }, gradient);
    CHECK(gradient == Matrix3X<double>::Ones(3, 4));
}
