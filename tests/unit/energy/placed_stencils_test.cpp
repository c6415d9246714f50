// SPDX-License-Identifier: MIT
#include <softtissue/energy/placed_stencils.hpp>

#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

namespace {

constexpr Index n = 5;

/// E = sum over stencils of vec(edges)^T K vec(edges) / 2, K symmetric.
template <class S>
struct Quadratic {
    using K6 = Eigen::Matrix<S, 6, 6>;
    using Edges = typename PlacedStencils<3, S>::Edges;

    K6 K;

    explicit Quadratic(RandomGenerator& random) : K(random_normal<K6>(random)) { K = (K + K.transpose()).eval(); }

    S energy(const Edges& e) const { return S(0.5) * e.reshaped().dot(K * e.reshaped()); }
    Edges gradient(const Edges& e) const {
        const Eigen::Matrix<S, 6, 1> g = K * e.reshaped();
        return Eigen::Map<const Edges>(g.data());
    }
};

Connectivity<3> stencils() {
    Connectivity<3> result(3, 4);
    result << 0, 3, 4, 2, 1, 1, 0, 3, 2, 4, 2, 1;
    return result;
}

}  // namespace

TEST_CASE("energy, gradient and Hessian are those of the edges at p + A d") {
    RandomGenerator random(3);
    const Matrix3X<double> rest = random_normal<Eigen::Matrix<double, 3, n>>(random);
    const Matrix3X<double> d = random_normal<Eigen::Matrix<double, 3, n>>(random);
    const Placement<double> skinned{random_normal<Eigen::Matrix<double, 3, n>>(random),
                                    random_normal<Eigen::Matrix<double, 3, 3 * n>>(random)};
    const Placement<double> moved{skinned.origins, {}};
    const Placement<double> at_rest{rest, {}};
    const Quadratic<double> law(random);
    const SequentialExecutor executor;
    for (const Placement<double>* placement : {&at_rest, &moved, &skinned}) {
        PlacedStencils<3, double> placed(stencils(), rest);
        if (placement != &at_rest) {
            placed.set_placement(*placement);
        }
        // the whole energy as one quadratic form of d
        MatrixX<double> T = MatrixX<double>::Zero(6 * placed.num_stencils(), 3 * n);
        VectorX<double> constant(T.rows());
        for (Index s = 0; s < placed.num_stencils(); ++s) {
            for (int m = 0; m < 2; ++m) {
                const std::int32_t to = stencils()(m + 1, s), from = stencils()(0, s);
                const Index row = 6 * s + 3 * m;
                Matrix3<double> A_to = Matrix3<double>::Identity(), A_from = A_to;
                if (placement->has_maps()) {
                    A_to = placement->map(to);
                    A_from = placement->map(from);
                }
                T.block<3, 3>(row, 3 * to) += A_to;
                T.block<3, 3>(row, 3 * from) -= A_from;
                constant.segment<3>(row) = placement->origins.col(to) - placement->origins.col(from);
            }
        }
        MatrixX<double> K = MatrixX<double>::Zero(T.rows(), T.rows());
        for (Index s = 0; s < placed.num_stencils(); ++s) {
            K.block<6, 6>(6 * s, 6 * s) = law.K;
        }
        const VectorX<double> edges = constant + T * d.reshaped();
        for (Index s = 0; s < placed.num_stencils(); ++s) {
            CHECK((placed.edges(d, s).reshaped() - edges.segment<6>(6 * s)).norm() < 1e-13);
        }
        const double energy = placed.sum_energy(d, executor, [&](Index, const auto& e) { return law.energy(e); });
        CHECK(energy == doctest::Approx(0.5 * edges.dot(K * edges)).epsilon(1e-13));

        Matrix3X<double> gradient = Matrix3X<double>::Zero(3, n);
        placed.add_gradient(d, gradient, executor, [&](Index, const auto& e) { return law.gradient(e); });
        const VectorX<double> expected = T.transpose() * K * edges;
        CHECK((gradient.reshaped() - expected).norm() < 1e-13 * expected.norm());

        const PrescribedVertices none(n, {});
        std::vector<std::vector<std::int32_t>> neighbours(size_t(none.num_free()));
        placed.add_neighbours(none, neighbours);
        BlockMatrix<double> hessian{BlockPattern(std::move(neighbours))};
        placed.bind(none, hessian.pattern());
        placed.add_hessian(d, hessian, executor, [&](Index, const auto&) { return law.K; });
        const MatrixX<double> stiffness = T.transpose() * K * T;
        CHECK((hessian.matrix().toDense() - stiffness).norm() < 1e-13 * stiffness.norm());
    }
}

TEST_CASE("rest edges are those without displacement; a displacement keeps its digits far from the origin") {
    RandomGenerator random(4);
    Matrix3X<float> rest = random_normal<Eigen::Matrix<float, 3, n>>(random);
    rest.array() += 1000.0F;
    const PlacedStencils<3, float> placed(stencils(), rest);
    const Matrix3X<float> zero = Matrix3X<float>::Zero(3, n);
    const Matrix3X<float> d = 1e-6F * random_normal<Eigen::Matrix<float, 3, n>>(random);
    for (Index s = 0; s < placed.num_stencils(); ++s) {
        CHECK(placed.edges(zero, s) == placed.rest_edges(s));
        for (int m = 0; m < 2; ++m) {
            const Vector3<float> change = d.col(stencils()(m + 1, s)) - d.col(stencils()(0, s));
            const Vector3<float> seen = placed.edges(d, s).col(m) - placed.rest_edges(s).col(m);
            // an edge of length 3 rounds to 2.4e-7; the positions themselves round to 6e-5
            CHECK((seen - change).cwiseAbs().maxCoeff() < 3e-7F);
        }
    }
}

TEST_CASE("positions that are not finite are refused") {
    Matrix3X<double> rest = Matrix3X<double>::Zero(3, n);
    rest(1, 4) = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH_AS((PlacedStencils<3, double>(stencils(), rest)), "rest position of vertex 4 is not finite", InvalidInput);
}
