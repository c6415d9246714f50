// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/posed_wrap.hpp>

#include <softtissue/testing/random_states.hpp>

#include "../mesh/small_meshes.hpp"
#include <support/capsule_body.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace softtissue;

namespace {

/// A flat square of 4 x 4 cells; vertex (i, j) is i + 5 j.
template <class S>
struct PosedSquare {
    softtissue_test::SquareMesh square = softtissue_test::make_square(4);
    TriangleMesh mesh{square.triangles, square.positions.cols()};
    Matrix3X<S> rest = square.positions.cast<S>();
    Matrix3X<S> posed = rest;
    std::vector<Matrix3<S>> rotations = std::vector<Matrix3<S>>(size_t(mesh.num_triangles()), Matrix3<S>::Identity());

    PosedWrapReport<S> examine() const { return examine_posed_wrap<S>(mesh, rest, posed, rotations); }
};

}  // namespace

TEST_CASE_TEMPLATE("a rigid motion folds nothing; against another rotation everything is folded", S, float, double) {
    PosedSquare<S> square;
    RandomGenerator random(9);
    const Matrix3<S> R = random_rotation<S>(random);
    square.posed = (R * square.rest).colwise() + Vector3<S>(S(1), S(2), S(3));
    square.rotations.assign(square.rotations.size(), R);
    const PosedWrapReport<S> report = square.examine();
    CHECK(report.folded_triangles == 0);
    CHECK(report.infeasible_vertices == 0);
    CHECK(report.crossings == 0);
    CHECK(report.smallest_cosine == doctest::Approx(1));
    CHECK(report.smallest_area_ratio == doctest::Approx(1).epsilon(1e-4));
    const Matrix3<S> half_turn = Vector3<S>(S(1), S(-1), S(-1)).asDiagonal();
    square.rotations.assign(square.rotations.size(), R * half_turn);
    CHECK(square.examine().folded_triangles == square.mesh.num_triangles());
}

TEST_CASE_TEMPLATE("a vertex drawn over its neighbours folds triangles and leaves no direction", S, float, double) {
    PosedSquare<S> square;
    square.posed.col(12) = square.rest.col(12) + Vector3<S>(S(0.4), S(0), S(0));  // beyond its neighbour at 0.25
    const PosedWrapReport<S> report = square.examine();
    CHECK(report.folded_triangles == 2);     // on the one side those right of it
    CHECK(report.infeasible_vertices == 4);  // the corners of both
    CHECK(report.smallest_cosine <= S(0));
    CHECK(report.smallest_area_ratio < S(0.7));
}

TEST_CASE_TEMPLATE("a crease without overlap is no fold; a fold to the back is feasible nowhere along it", S, float,
                   double) {
    PosedSquare<S> square;
    const auto fold = [&](double degrees) {
        const double angle = degrees * 3.14159265358979 / 180;
        for (Index v = 0; v < square.rest.cols(); ++v) {
            const double beyond = std::max(double(square.rest(0, v)) - 0.5, 0.0);
            square.posed.col(v) << S(std::min(double(square.rest(0, v)), 0.5) + beyond * std::cos(angle)),
                square.rest(1, v), S(beyond * std::sin(angle));
        }
    };
    fold(80);
    CHECK(square.examine().folded_triangles == 0);
    CHECK(square.examine().infeasible_vertices == 0);
    CHECK(square.examine().smallest_cosine == doctest::Approx(std::cos(40 * 3.14159265358979 / 180)).epsilon(1e-4));
    fold(120);
    CHECK(square.examine().folded_triangles == 16);
    CHECK(square.examine().infeasible_vertices == 0);
}

TEST_CASE("of a layered body: the blended rotations of its weights") {
    const CapsuleBody<double> capsule;
    LayeredBody<double> body;
    RegionOptions options;
    options.extremities = JointGroups{};
    body.region = make_simulated_region(capsule.positions, TriangleMesh(capsule.faces, capsule.positions.cols()),
                                        capsule.weights, options);
    body.layers = {capsule.positions.cols(), 2};
    body.mesh.cells = body.layers.prisms(capsule.faces);
    for (Index t = 0; t < capsule.faces.cols(); ++t) {  // muscle first
        body.mesh.cells.col(t) = body.layers.prisms(capsule.faces).col(2 * t);
    }
    body.mesh.rest_positions.resize(3, body.layers.num_vertices());
    MatrixX<double> dense(body.layers.num_vertices(), 3);
    for (Index v = 0; v < body.layers.num_vertices(); ++v) {
        body.mesh.rest_positions.col(v) = capsule.positions.col(body.layers.column(v));
        const double bent = std::clamp((capsule.positions(1, body.layers.column(v)) - 0.4) / 0.2, 0.0, 1.0);
        dense.row(v) << 1 - bent, bent, 0;
    }
    body.weights = SkinningWeights<double>(dense);
    const Matrix3X<double> rest = body.level_positions(0);
    std::vector<AffineTransform<double>> transforms(3, {Matrix3<double>::Identity(), Vector3<double>::Zero()});
    CHECK(examine_posed_wrap<double>(body, rest, transforms).folded_triangles == 0);
    CHECK(examine_posed_wrap<double>(body, rest, transforms).smallest_area_ratio == doctest::Approx(1));

    const Matrix3<double> R = Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Vector3<double> elbow(0, 0.5, 0);
    transforms[1] = {R, elbow - R * elbow};
    Matrix3X<double> posed = rest;
    for (Index v = 0; v < rest.cols(); ++v) {
        const double bent = dense(3 * v, 1);
        posed.col(v) = (1 - bent) * rest.col(v) + bent * transforms[1](rest.col(v));
    }
    CHECK(examine_posed_wrap<double>(body, posed, transforms).folded_triangles == 0);
    // The other way round every moved triangle still faces its rotation's way only up to a turn of 90 degrees.
    transforms[1].linear = Eigen::AngleAxisd(-2.4, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    CHECK(examine_posed_wrap<double>(body, posed, transforms).folded_triangles > 100);
}

TEST_CASE("sizes that do not fit are refused") {
    PosedSquare<double> square;
    const auto message = [&] {
        try {
            static_cast<void>(square.examine());
        } catch (const InvalidInput& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    SUBCASE("vertices") {
        square.posed = square.posed.leftCols(7).eval();
        CHECK(message() == "posed wrap: 25 rest and 7 posed vertices, expected 25");
    }
    SUBCASE("rotations") {
        square.rotations.pop_back();
        CHECK(message() == "posed wrap: 31 rotations, expected one for each of the 32 triangles");
    }
}
