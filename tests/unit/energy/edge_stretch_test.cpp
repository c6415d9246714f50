// SPDX-License-Identifier: MIT
#include <softtissue/energy/edge_stretch.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/energy/concepts.hpp>
#include <softtissue/solver/objective.hpp>
#include <softtissue/testing/taylor_rate.hpp>

#include <support/skin_sheet.hpp>
#include <support/solid_block.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace softtissue;
using namespace softtissue_test;

static_assert(EnergyTerm<EdgeStretch<float>>);
static_assert(EnergyTerm<EdgeStretch<double>>);

namespace {

/// A single edge of rest length 1 along x (its triangle's other edges carry no stiffness), `length` long.
struct OneEdge {
    SkinSheet<double> sheet = single_hinge(0.0);
    VectorX<double> stiffnesses = VectorX<double>::Zero(5);
    Matrix3X<double> d = Matrix3X<double>::Zero(3, 4);

    explicit OneEdge(double length) {
        for (size_t e = 0; e < 5; ++e) {
            if (!sheet.surface.edges()[e].is_boundary()) {
                stiffnesses(Index(e)) = 3.0;
            }
        }
        d(0, 1) = length - 1.0;
    }

    Eigen::Matrix<double, 6, 6> hessian(PsdFilter filter, bool tension_only = false) {
        EdgeStretch<double> stretch(sheet.surface, sheet.positions, stiffnesses);
        stretch.set_tension_only_hessian(tension_only);
        const SequentialExecutor executor;
        Objective objective(PrescribedVertices(4, {}), executor, stretch);
        return objective.hessian(d, filter).matrix().toDense().topLeftCorner<6, 6>();
    }
};

}  // namespace

TEST_CASE_TEMPLATE("the laws of an energy: derivatives, invariance, rest", S, float, double) {
    const SkinSheet<S> sheet = bumpy_sheet<S>(3, 1.0);
    const Index n = sheet.positions.cols();
    RandomGenerator random(5);
    EdgeStretch<S> stretch(sheet.surface, sheet.positions, S(0.7));
    const SequentialExecutor executor;
    Objective objective(PrescribedVertices(n, {}), executor, stretch);
    const S epsilon = std::numeric_limits<S>::epsilon();

    const Matrix3X<S> zero = Matrix3X<S>::Zero(3, n);
    CHECK(objective.energy(zero) == S(0));
    CHECK(objective.full_gradient(zero).norm() == S(0));

    const Matrix3X<S> d = random_displacement<S>(n, 0.15, random);
    for (int sample = 0; sample < 3; ++sample) {
        const Matrix3X<S> D = random_displacement<S>(n, 0.3, random);
        const S slope = objective.full_gradient(d).cwiseProduct(D).sum();
        CHECK(taylor_rate([&](S h) { return objective.energy(d + h * D); }, slope).is_at_least(2));
        const VectorX<S> product = objective.hessian(d, PsdFilter::none).matrix() * VectorX<S>(D.reshaped());
        const Matrix3X<S> change = product.reshaped(3, n);
        CHECK(taylor_rate([&](S h) -> Matrix3X<S> { return objective.full_gradient(d + h * D); }, change).is_at_least(2));
    }

    const Matrix3<S> R = random_rotation<S>(random);
    const Matrix3X<S> moved = ((R * (sheet.positions + d)).colwise() + Vector3<S>(1, 2, 3)) - sheet.positions;
    CHECK(std::abs(objective.energy(moved) / objective.energy(d) - S(1)) < 64 * epsilon);
    const Matrix3X<S> forces = objective.full_gradient(d);
    CHECK(forces.rowwise().sum().norm() < 64 * epsilon * forces.cwiseAbs().sum());
}

TEST_CASE("the energy of one edge is that of the source") {
    OneEdge edge(1.3);
    EdgeStretch<double> stretch(edge.sheet.surface, 2.0 * edge.sheet.positions, edge.stiffnesses);
    edge.d(0, 1) = 0.6;  // from 2 to 2.6
    CHECK(stretch.energy(edge.d, SequentialExecutor{}) == doctest::Approx(0.5 * 3.0 * 0.3 * 0.3).epsilon(1e-14));
}

TEST_CASE("filters are exact in closed form") {
    for (const double length : {0.3, 0.9, 1.0, 1.4}) {
        OneEdge edge(length);
        const Eigen::Matrix<double, 6, 6> H = edge.hessian(PsdFilter::none);
        for (const PsdFilter filter : {PsdFilter::clamp, PsdFilter::absolute}) {
            CHECK((edge.hessian(filter) - filtered(H, filter)).norm() < 1e-13 * H.norm());
        }
        CHECK(edge.hessian(PsdFilter::none, true) == edge.hessian(PsdFilter::clamp));
        CHECK(edge.hessian(PsdFilter::absolute, true) == edge.hessian(PsdFilter::absolute));
        CHECK((H == edge.hessian(PsdFilter::clamp)) == (length >= 1.0));
    }
}

TEST_CASE("a collapsed edge stays finite") {
    OneEdge edge(0.0);
    EdgeStretch<double> stretch(edge.sheet.surface, edge.sheet.positions, edge.stiffnesses);
    const SequentialExecutor executor;
    Matrix3X<double> gradient = Matrix3X<double>::Zero(3, 4);
    stretch.add_gradient(edge.d, gradient, executor);
    CHECK(gradient.norm() == 0.0);
    CHECK(edge.hessian(PsdFilter::none).norm() == doctest::Approx(3.0 * std::sqrt(12.0)));
    CHECK(stretch.energy(edge.d, executor) == doctest::Approx(1.5));
}

TEST_CASE("the stiffness of a membrane does not depend on the mesh") {
    const double modulus = 40.0;
    // strain (e11, e22, e12) of the plane; Poisson's ratio 1/3, mu = lambda = 3/8 of the modulus
    const Vector3<double> strain(3e-4, -1e-4, 2e-4);
    Matrix3<double> G = Matrix3<double>::Zero();
    G.topLeftCorner<2, 2>() << strain(0), strain(2), strain(2), strain(1);
    const double mu = 0.375 * modulus;
    const double density = mu * G.squaredNorm() + 0.5 * mu * G.trace() * G.trace();
    for (const int n : {4, 16}) {
        const SkinSheet<double> sheet = equilateral_sheet(n, 0.5 / n);
        EdgeStretch<double> stretch(sheet.surface, sheet.positions,
                                    membrane_edge_stiffnesses(sheet.surface, sheet.positions, modulus));
        const Matrix3X<double> d = G * sheet.positions;
        const double area = triangle_areas<double>(sheet.positions, sheet.surface.triangles()).sum();
        // half the stiffness on the boundary makes it exact but for (Green's) terms of the order of the strain
        CHECK(stretch.energy(d, SequentialExecutor{}) == doctest::Approx(density * area).epsilon(1e-3));
    }
}

TEST_CASE("the same bits for any number of threads") {
    const SkinSheet<double> sheet = bumpy_sheet(12, 0.02);
    RandomGenerator random(6);
    const Index n = sheet.positions.cols();
    const Matrix3X<double> d = random_displacement<double>(n, 0.003, random);
    EdgeStretch<double> stretch(sheet.surface, sheet.positions, 0.03);
    const SequentialExecutor one;
    const ThreadExecutor three(3);
    Objective sequential(PrescribedVertices(n, {}), one, stretch);
    Objective parallel(PrescribedVertices(n, {}), three, stretch);
    CHECK(sequential.energy(d) == parallel.energy(d));
    CHECK(sequential.full_gradient(d) == parallel.full_gradient(d));
    CHECK(sequential.hessian(d, PsdFilter::clamp).matrix().toDense() == parallel.hessian(d, PsdFilter::clamp).matrix().toDense());
}

TEST_CASE("what does not fit is refused") {
    SkinSheet<double> sheet = single_hinge(0.0);
    CHECK_THROWS_WITH_AS(EdgeStretch<double>(sheet.surface, sheet.positions, -1.0),
                         "edge stretch: stiffness of edge 0 = -1 J, expected >= 0", InvalidInput);
    CHECK_THROWS_WITH_AS(EdgeStretch<double>(sheet.surface, sheet.positions, VectorX<double>(VectorX<double>::Ones(3))),
                         "edge stretch: number of stiffnesses = 3, expected one for each of 5 edges", InvalidInput);
    CHECK_THROWS_WITH_AS(EdgeStretch<double>(sheet.surface, Matrix3X<double>(Matrix3X<double>::Ones(3, 7)), 1.0),
                         "edge stretch: number of rest positions = 7, expected 4", InvalidInput);
    sheet.positions.col(2) = sheet.positions.col(0);
    CHECK_THROWS_WITH_AS(EdgeStretch<double>(sheet.surface, sheet.positions, 1.0),
                         "edge stretch: edge (2, 0) has rest length 0 m, expected > 0", InvalidInput);
}
