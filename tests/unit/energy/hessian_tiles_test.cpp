// SPDX-License-Identifier: MIT
#include <softtissue/energy/hessian_tiles.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <array>
#include <utility>
#include <vector>

using namespace softtissue;

namespace {

constexpr int num_nodes = 3;
constexpr Index num_vertices = 50;
template <class S>
using Tiles = HessianTiles<num_nodes, S>;

/// Triples of vertices and a random symmetric matrix for each.
template <class S>
struct Triples {
    // The last tile and its last pack are not full.
    Connectivity<num_nodes> vertices{num_nodes, 3 * Tiles<S>::tile - 10};
    std::vector<Eigen::Matrix<S, 9, 9>> hessians;
    MatrixX<S> dense = MatrixX<S>::Zero(3 * num_vertices, 3 * num_vertices);

    Triples() {
        RandomGenerator random(2);
        for (Index s = 0; s < vertices.cols(); ++s) {
            const auto first = std::int32_t(random.index(num_vertices));
            const auto step = std::int32_t(1 + random.index(20));
            for (int a = 0; a < num_nodes; ++a) {
                vertices(a, s) = (first + a * step) % std::int32_t(num_vertices);
            }
            const auto A = random_normal<Eigen::Matrix<S, 9, 9>>(random);
            hessians.push_back(A + A.transpose());
            for (int a = 0; a < num_nodes; ++a) {
                for (int b = 0; b < num_nodes; ++b) {
                    dense.template block<3, 3>(3 * vertices(a, s), 3 * vertices(b, s)) +=
                        hessians.back().template block<3, 3>(3 * a, 3 * b);
                }
            }
        }
    }

    /// Of the free vertices, filled N by N.
    template <int N>
    BlockMatrix<S> matrix(const PrescribedVertices& prescribed, int num_threads) const {
        std::vector<std::vector<std::int32_t>> neighbours(size_t(prescribed.num_free()));
        for (auto& rows : neighbours) {
            for (Index i = 0; i < prescribed.num_free(); ++i) {
                rows.push_back(std::int32_t(i));
            }
        }
        BlockMatrix<S> result{BlockPattern(std::move(neighbours))};
        Tiles<S> tiles;
        tiles.bind(vertices, prescribed, result.pattern());
        tiles.template add<N>(
            ThreadExecutor(num_threads),
            [&](Index first, Index count, S* slots) {
                for (Index i = 0; i < count; ++i) {
                    S* const pack = slots + Tiles<S>::slot_size * (i / N * N);
                    for (int b = 0; b < num_nodes; ++b) {
                        for (int a = 0; a <= b; ++a) {
                            const Index place =
                                Tiles<S>::template block_offset<N>(Tiles<S>::pair_index(a, b), int(i % N));
                            Eigen::Map<Matrix3<S>>(pack + place) =
                                hessians[size_t(first + i)].template block<3, 3>(3 * a, 3 * b);
                        }
                    }
                }
            },
            result);
        return result;
    }
};

}  // namespace

TEST_CASE_TEMPLATE("Hessians land where they belong, one by one or in packs, with the same bits for any threads", S,
                   float, double) {
    const Triples<S> triples;
    const std::array<std::int32_t, 3> held{7, 0, 49};
    const PrescribedVertices prescribed(num_vertices, held);
    const MatrixX<S> one = triples.template matrix<1>(prescribed, 1).matrix().toDense();
    for (Index i = 0; i < prescribed.num_free(); ++i) {
        for (Index j = 0; j < prescribed.num_free(); ++j) {
            const Index row = 3 * prescribed.free_vertices()[size_t(i)],
                        column = 3 * prescribed.free_vertices()[size_t(j)];
            CHECK(one.template block<3, 3>(3 * i, 3 * j) == triples.dense.template block<3, 3>(row, column));
        }
    }
    CHECK(triples.template matrix<1>(prescribed, 3).matrix().toDense() == one);
    CHECK(triples.template matrix<4>(prescribed, 1).matrix().toDense() == one);
    CHECK(triples.template matrix<16>(prescribed, 2).matrix().toDense() == one);
}

TEST_CASE("pairs of nodes fill their slots without gap") {
    using Pairs = HessianTiles<4, double>;
    int expected = 0;
    for (int b = 0; b < 4; ++b) {
        for (int a = 0; a <= b; ++a) {
            CHECK(Pairs::pair_index(a, b) == expected++);
        }
    }
    CHECK(expected == Pairs::num_block_pairs);
}
