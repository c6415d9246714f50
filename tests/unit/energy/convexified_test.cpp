// SPDX-License-Identifier: MIT
#include <softtissue/energy/convexified.hpp>

#include <softtissue/energy/edge_stretch.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>

using namespace softtissue;

static_assert(EnergyTerm<Convexified<EdgeStretch<double>>>);
static_assert(EnergyTerm<Convexified<EdgeStretch<float>>>);

namespace {

/// Says what it was asked for.
struct WithHessianOfItsOwn : EdgeStretch<double> {
    using EdgeStretch<double>::EdgeStretch;
    int asked = 0;

    template <Executor E>
    void add_convex_hessian(const Matrix3X<double>& d, BlockMatrix<double>& hessian, const E& executor) {
        ++asked;
        add_hessian(d, PsdFilter::clamp, hessian, executor);
    }
};

}  // namespace

TEST_CASE("energy and gradient are the term's, the exact Hessian is its clamped one") {
    Matrix3X<double> X(3, 3);
    X << 0, 1, 0, 0, 0, 1, 0, 0, 0;
    const TriangleMesh surface(Triangles(Vector3<std::int32_t>(0, 1, 2)), 3);
    EdgeStretch<double> term(surface, X, 2.0);
    Convexified<EdgeStretch<double>> convex(term);
    const Matrix3X<double> d = -0.3 * X;  // compressed: indefinite
    const SequentialExecutor executor;
    CHECK(convex.energy(d, executor) == term.energy(d, executor));
    Matrix3X<double> gradient = Matrix3X<double>::Zero(3, 3), expected = gradient;
    convex.add_gradient(d, gradient, executor);
    term.add_gradient(d, expected, executor);
    CHECK(gradient == expected);
    CHECK(convex.add_energy_and_gradient(d, gradient, executor) == term.energy(d, executor));
    CHECK((gradient - 2 * expected).norm() <= 1e-14 * expected.norm());

    const PrescribedVertices prescribed(3, {});
    std::vector<std::vector<std::int32_t>> neighbours(3);
    convex.add_neighbours(prescribed, neighbours);
    const BlockPattern pattern(neighbours);
    convex.bind(prescribed, pattern);
    const auto hessian = [&](auto& energy, PsdFilter filter) {
        BlockMatrix<double> H(pattern);
        energy.add_hessian(d, filter, H, executor);
        return MatrixX<double>(H.matrix());
    };
    const auto smallest = [](const MatrixX<double>& H) {
        return Eigen::SelfAdjointEigenSolver<MatrixX<double>>(H, Eigen::EigenvaluesOnly).eigenvalues()(0);
    };
    CHECK(smallest(hessian(term, PsdFilter::none)) < -0.1);
    CHECK(smallest(hessian(convex, PsdFilter::none)) > -1e-12);
    CHECK(hessian(convex, PsdFilter::none) == hessian(term, PsdFilter::clamp));
    CHECK(hessian(convex, PsdFilter::absolute) == hessian(term, PsdFilter::absolute));

    WithHessianOfItsOwn owner(surface, X, 2.0);
    Convexified<WithHessianOfItsOwn> own(owner);
    own.bind(prescribed, pattern);
    for (const PsdFilter filter : {PsdFilter::none, PsdFilter::clamp, PsdFilter::absolute}) {
        CHECK(hessian(own, filter) == hessian(term, PsdFilter::clamp));
    }
    CHECK(owner.asked == 3);
}
