// SPDX-License-Identifier: MIT
#include <softtissue/energy/stencil_assembly.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

using namespace softtissue;

namespace {

constexpr int num_nodes = 4;
using Assembly = StencilAssembly<num_nodes, double>;

/// Random stencils over `num_vertices` vertices with a random energy, gradient and symmetric Hessian each.
struct Stencils {
    Connectivity<num_nodes> vertices;
    VectorX<double> energies;
    Matrix3X<double> gradients;
    std::vector<Eigen::Matrix<double, 12, 12>> hessians;

    Stencils(Index count, Index num_vertices, RandomGenerator& random) : vertices(num_nodes, count) {
        energies.resize(count);
        gradients.resize(3, num_nodes * count);
        for (Index s = 0; s < count; ++s) {
            energies(s) = random.normal();
            gradients.middleCols<num_nodes>(num_nodes * s) = random_normal<Eigen::Matrix<double, 3, num_nodes>>(random);
            const Eigen::Matrix<double, 12, 12> A = random_normal<Eigen::Matrix<double, 12, 12>>(random);
            hessians.push_back(A + A.transpose());
            for (int a = 0; a < num_nodes; ++a) {
                bool is_new = false;
                while (!is_new) {
                    vertices(a, s) = std::int32_t(random.index(num_vertices));
                    is_new = (vertices.col(s).head(a).array() != vertices(a, s)).all();
                }
            }
        }
    }

    auto energy_of() const {
        return [this](Index s) { return energies(s); };
    }
    auto gradient_of() const {
        return [this](Index s) -> Eigen::Matrix<double, 3, num_nodes> {
            return gradients.middleCols<num_nodes>(num_nodes * s);
        };
    }
    auto hessian_of() const {
        return [this](Index s, auto blocks) {
            for (int b = 0; b < num_nodes; ++b) {
                for (int a = 0; a <= b; ++a) {
                    blocks.template middleCols<3>(3 * Assembly::Tiles::pair_index(a, b)) =
                        hessians[size_t(s)].template block<3, 3>(3 * a, 3 * b);
                }
            }
        };
    }
};

constexpr Index num_vertices = 9;
constexpr Index many = 1501;  // the Hessians of so many stencils fill more than two tiles
const std::array<std::int32_t, 2> held{4, 0};

/// Largest difference between a matrix of the free vertices and their part of one of all vertices.
double largest_difference(const MatrixX<double>& assembled, const MatrixX<double>& dense,
                          const PrescribedVertices& prescribed) {
    double worst = 0;
    for (Index i = 0; i < prescribed.num_free(); ++i) {
        for (Index j = 0; j < prescribed.num_free(); ++j) {
            const Index row = prescribed.free_vertices()[size_t(i)], column = prescribed.free_vertices()[size_t(j)];
            worst = std::max(
                worst,
                (assembled.block<3, 3>(3 * i, 3 * j) - dense.block<3, 3>(3 * row, 3 * column)).cwiseAbs().maxCoeff());
        }
    }
    return worst;
}

}  // namespace

TEST_CASE("energies, gradients and Hessians are added as a naive loop adds them") {
    RandomGenerator random(1);
    const Stencils stencils(20, num_vertices, random);
    Assembly assembly(stencils.vertices, num_vertices);
    CHECK(assembly.num_stencils() == 20);
    CHECK(assembly.num_vertices() == num_vertices);

    const SequentialExecutor executor;
    CHECK(assembly.sum_energy(executor, stencils.energy_of()) ==
          doctest::Approx(stencils.energies.sum()).epsilon(1e-14));

    Matrix3X<double> gradient = Matrix3X<double>::Ones(3, num_vertices), expected = gradient;
    MatrixX<double> dense = MatrixX<double>::Zero(3 * num_vertices, 3 * num_vertices);
    for (Index s = 0; s < 20; ++s) {
        for (int a = 0; a < num_nodes; ++a) {
            expected.col(stencils.vertices(a, s)) += stencils.gradients.col(num_nodes * s + a);
            for (int b = 0; b < num_nodes; ++b) {
                dense.block<3, 3>(3 * stencils.vertices(a, s), 3 * stencils.vertices(b, s)) +=
                    stencils.hessians[size_t(s)].block<3, 3>(3 * a, 3 * b);
            }
        }
    }
    assembly.add_gradient(executor, stencils.gradient_of(), gradient);
    CHECK((gradient - expected).cwiseAbs().maxCoeff() < 1e-13);

    const PrescribedVertices prescribed(num_vertices, held);
    std::vector<std::vector<std::int32_t>> neighbours(size_t(prescribed.num_free()));
    assembly.add_neighbours(prescribed, neighbours);
    BlockMatrix<double> hessian{BlockPattern(std::move(neighbours))};
    assembly.bind(prescribed, hessian.pattern());
    assembly.add_hessian(executor, stencils.hessian_of(), hessian);
    const MatrixX<double> assembled = hessian.matrix().toDense();
    CHECK(largest_difference(assembled, dense, prescribed) < 1e-13);
    CHECK((assembled - assembled.transpose()).cwiseAbs().maxCoeff() == 0.0);
}

TEST_CASE("the bits do not depend on the executor") {
    RandomGenerator random(2);
    const Stencils stencils(200, 40, random);
    const PrescribedVertices prescribed(40, held);
    const auto assemble = [&](const auto& executor) {
        Assembly assembly(stencils.vertices, 40);
        std::vector<std::vector<std::int32_t>> neighbours(size_t(prescribed.num_free()));
        assembly.add_neighbours(prescribed, neighbours);
        BlockMatrix<double> hessian{BlockPattern(std::move(neighbours))};
        assembly.bind(prescribed, hessian.pattern());
        assembly.add_hessian(executor, stencils.hessian_of(), hessian);
        Matrix3X<double> gradient = Matrix3X<double>::Zero(3, 40);
        assembly.add_gradient(executor, stencils.gradient_of(), gradient);
        const Index num_entries = hessian.matrix().nonZeros();
        VectorX<double> all(1 + gradient.size() + num_entries);
        all << assembly.sum_energy(executor, stencils.energy_of()), gradient.reshaped(),
            Eigen::Map<const VectorX<double>>(hessian.matrix().valuePtr(), num_entries);
        return all;
    };
    const VectorX<double> sequential = assemble(SequentialExecutor{});
    CHECK(assemble(ThreadExecutor(2)) == sequential);
    CHECK(assemble(ThreadExecutor(7)) == sequential);
}

TEST_CASE("more stencils than a tile holds, several at a time, are added as one by one") {
    RandomGenerator random(3);
    constexpr Index count = many, vertices = 60;
    const Stencils stencils(count, vertices, random);
    const PrescribedVertices prescribed(vertices, held);
    Assembly assembly(stencils.vertices, vertices);
    std::vector<std::vector<std::int32_t>> neighbours{size_t(prescribed.num_free())};
    assembly.add_neighbours(prescribed, neighbours);
    const BlockPattern pattern(std::move(neighbours));
    assembly.bind(prescribed, pattern);

    constexpr Index N = 4;
    const auto each = [](Index pack, const auto& write) {
        for (Index s = N * pack; s < std::min(N * pack + N, many); ++s) {
            write(s, s - N * pack);
        }
    };
    const auto energies = [&](Index pack, double* slots) {
        std::fill_n(slots, N, 1e9);  // beyond the last stencil it must not count
        each(pack, [&](Index s, Index lane) { slots[lane] = stencils.energies(s); });
    };
    const auto gradients = [&](Index pack, double* slots) {
        each(pack, [&](Index s, Index lane) {
            Assembly::Gradients::gradient_in<N>(slots, int(lane)) = stencils.gradient_of()(s);
        });
    };
    const auto hessians = [&](Index pack, double* slots) {
        each(pack, [&](Index s, Index lane) {
            Eigen::Matrix<double, 3, 3 * Assembly::num_block_pairs> blocks;
            stencils.hessian_of()(s, Eigen::Map<decltype(blocks)>(blocks.data()));
            for (int pair = 0; pair < Assembly::num_block_pairs; ++pair) {
                Eigen::Map<Matrix3<double>>(slots + Assembly::Tiles::block_offset<N>(pair, int(lane))) =
                    blocks.block<3, 3>(0, 3 * pair);
            }
        });
    };
    const ThreadExecutor executor(3);
    CHECK(assembly.sum_packed_energy<N>(executor, energies) ==
          assembly.sum_energy(SequentialExecutor{}, stencils.energy_of()));
    Matrix3X<double> gradient = Matrix3X<double>::Zero(3, vertices), packed_gradient = gradient;
    assembly.add_gradient(SequentialExecutor{}, stencils.gradient_of(), gradient);
    assembly.add_packed_gradient<N>(executor, gradients, packed_gradient);
    CHECK(packed_gradient == gradient);

    BlockMatrix<double> packed(pattern);
    assembly.add_packed_hessian<N>(executor, hessians, packed);
    MatrixX<double> dense = MatrixX<double>::Zero(3 * vertices, 3 * vertices);
    for (Index s = 0; s < count; ++s) {
        for (int a = 0; a < num_nodes; ++a) {
            for (int b = 0; b < num_nodes; ++b) {
                dense.block<3, 3>(3 * stencils.vertices(a, s), 3 * stencils.vertices(b, s)) +=
                    stencils.hessians[size_t(s)].block<3, 3>(3 * a, 3 * b);
            }
        }
    }
    const MatrixX<double> assembled = packed.matrix().toDense();
    CHECK(largest_difference(assembled, dense, prescribed) < 1e-11);
}
