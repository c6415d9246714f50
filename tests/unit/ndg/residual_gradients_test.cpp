// SPDX-License-Identifier: MIT
#include <softtissue/ndg/residual_gradients.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/skinning/blended_rotation.hpp>
#include <softtissue/skinning/cell_weights.hpp>
#include <softtissue/solver/poisson_reconstruction.hpp>
#include <softtissue/testing/random_states.hpp>

#include <support/layered_limb.hpp>

#include <doctest/doctest.h>

using namespace softtissue;
using namespace softtissue_test;

namespace {

template <class S>
std::vector<Matrix3<S>> rotations_of(const LayeredLimb<S>& limb, const std::vector<AffineTransform<S>>& transforms) {
    return BlendedRotations<S>(cell_weights(limb.body.weights, limb.body.mesh.cells)).rotations(transforms);
}

}  // namespace

TEST_CASE_TEMPLATE("positions -> residuals -> targets -> positions", S, float, double) {
    const LayeredLimb<S> limb;
    const CellMesh<Prism6, S>& mesh = limb.body.mesh;
    const RestOperators<Prism6, S> rest = RestOperators<Prism6, S>::at(mesh, mesh.rest_positions);
    const std::vector<Matrix3<S>> rotations = rotations_of(limb, limb.transforms(0.9));
    const Matrix3X<S> x = limb.bent(0.9);
    MatrixX<S> residuals(9, mesh.num_cells());
    residual_gradients_into<S, Prism6, S>(mesh, rest, rotations, x, residuals);
    const S tolerance = S(100) * std::numeric_limits<S>::epsilon();

    SUBCASE("each column is R^T F, row after row") {
        for (Index c = 0; c < mesh.num_cells(); ++c) {
            const Matrix3<S> F = mesh.gather(x, mesh.cells.col(c)) * rest.cell_gradients(c).transpose();
            const Matrix3<S> expected = rotations[size_t(c)].transpose() * F;
            for (int row = 0; row < 3; ++row) {
                for (int column = 0; column < 3; ++column) {
                    CHECK(residuals(3 * row + column, c) == expected(row, column));
                }
            }
        }
    }
    SUBCASE("the way back ends where it began") {
        PoissonReconstruction<Prism6, S> poisson(mesh, PrescribedVertices(mesh.num_vertices(), limb.body.prescribed));
        Matrix3X<S> targets, gradients;
        target_gradients_into<S, S>(residuals, rotations, targets);
        poisson.gradients_into(x, gradients);
        // six products of a position and a shape gradient, rounded twice each, turned by R^T and back: three numbers to one
        const S rounding = S(2 * 6 * 3) * std::numeric_limits<S>::epsilon() * x.cwiseAbs().maxCoeff() *
                           rest.gradients.cwiseAbs().maxCoeff();
        CHECK((targets - gradients).cwiseAbs().maxCoeff() < rounding);
        Matrix3X<S> found = x;
        for (const std::int32_t v : poisson.prescribed().free_vertices()) {
            found.col(v) = mesh.rest_positions.col(v);
        }
        poisson.solve_into(targets, found);
        CHECK((found - x).cwiseAbs().maxCoeff() < tolerance);
    }
    SUBCASE("a rigid motion of everything leaves no residual") {
        std::vector<AffineTransform<S>> transforms(2);
        RandomGenerator random(7);
        transforms[0] = transforms[1] = {random_rotation<S>(random), Vector3<S>(1, -2, S(0.5))};
        const Matrix3X<S> moved = (transforms[0].linear * mesh.rest_positions).colwise() + transforms[0].translation;
        residual_gradients_into<S, Prism6, S>(mesh, rest, rotations_of(limb, transforms), moved, residuals);
        for (Index c = 0; c < mesh.num_cells(); ++c) {
            CHECK((residuals.col(c) - Matrix3<S>::Identity().reshaped()).cwiseAbs().maxCoeff() < 100 * tolerance);
        }
    }
    SUBCASE("threads change no bit") {
        const ThreadExecutor threads(3);
        MatrixX<S> again(9, mesh.num_cells());
        residual_gradients_into<S, Prism6, S>(mesh, rest, rotations, x, again, threads);
        CHECK(again == residuals);
        Matrix3X<S> targets, targets_again;
        target_gradients_into<S, S>(residuals, rotations, targets);
        target_gradients_into<S, S>(residuals, rotations, targets_again, threads);
        CHECK(targets == targets_again);
    }
}

TEST_CASE("an inverted cell keeps its negative determinant") {
    const LayeredLimb<double> limb;
    const CellMesh<Prism6, double>& mesh = limb.body.mesh;
    const RestOperators<Prism6, double> rest = RestOperators<Prism6, double>::at(mesh, mesh.rest_positions);
    Matrix3X<double> x = mesh.rest_positions;
    x.row(2) *= -1;
    const std::vector<Matrix3<double>> rotations = rotations_of(limb, limb.transforms(0.5));
    MatrixX<double> residuals(9, mesh.num_cells());
    residual_gradients_into<double, Prism6, double>(mesh, rest, rotations, x, residuals);
    for (Index c = 0; c < mesh.num_cells(); ++c) {
        CHECK(determinant<double>(residuals.col(c).reshaped(3, 3)) == doctest::Approx(-1));
    }
}

TEST_CASE("arrays of another body are refused") {
    const LayeredLimb<double> limb;
    const CellMesh<Prism6, double>& mesh = limb.body.mesh;
    const RestOperators<Prism6, double> rest = RestOperators<Prism6, double>::at(mesh, mesh.rest_positions);
    std::vector<Matrix3<double>> rotations(size_t(mesh.num_cells()), Matrix3<double>::Identity());
    MatrixX<double> residuals(9, mesh.num_cells()), small(9, 1);
    Matrix3X<double> targets;
    const Matrix3X<double> two = Matrix3X<double>::Zero(3, 2);
    const auto compute = [&](const Matrix3X<double>& x, MatrixX<double>& room) {
        residual_gradients_into<double, Prism6, double>(mesh, rest, rotations, x, room);
    };
    CHECK_THROWS_WITH_AS(compute(two, residuals), "residual gradients: 2 positions, expected 300", InvalidInput);
    CHECK_THROWS_WITH_AS(compute(mesh.rest_positions, small),
                         "residual gradients: room for 9 x 1 numbers, expected 9 x 360", InvalidInput);
    CHECK_THROWS_WITH_AS((target_gradients_into<double, double>(small, rotations, targets)),
                         "target gradients: residuals of 9 x 1, expected 9 x 360", InvalidInput);
    rotations.pop_back();
    CHECK_THROWS_WITH_AS(compute(mesh.rest_positions, residuals),
                         "residual gradients: operators of 360 cells and 359 rotations, expected 360", InvalidInput);
}
