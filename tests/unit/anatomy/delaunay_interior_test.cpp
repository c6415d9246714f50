// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/delaunay_interior.hpp>

#include <softtissue/mesh/surface_normals.hpp>
#include <softtissue/model/human_mesh.hpp>
#include <softtissue/testing/random_states.hpp>

#include <support/capsule_body.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace softtissue;

static_assert(Tetrahedraliser<DelaunayInterior, float>);
static_assert(Tetrahedraliser<DelaunayInterior, double>);

namespace {

/// By the solid angles of the triangles seen from p (van Oosterom, Strackee 1983), independent of rays.
double winding_by_solid_angle(const Matrix3X<double>& x, const Triangles& triangles, const Vector3<double>& p) {
    double angle = 0;
    for (Index t = 0; t < triangles.cols(); ++t) {
        const Vector3<double> a = x.col(triangles(0, t)) - p;
        const Vector3<double> b = x.col(triangles(1, t)) - p;
        const Vector3<double> c = x.col(triangles(2, t)) - p;
        const double la = a.norm();
        const double lb = b.norm();
        const double lc = c.norm();
        angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return angle / (4 * std::numbers::pi);
}

/// Tets that hold p, barycentric coordinates down to -tolerance.
template <class S>
Index count_holding(const Tetrahedralisation<S>& volume, const Vector3<S>& p, S tolerance) {
    Index count = 0;
    for (Index c = 0; c < volume.tets.cols(); ++c) {
        const NodePositions<Tet4, S> x = CellMesh<Tet4, S>::gather(volume.positions, volume.tets.col(c));
        if ((x.rowwise().minCoeff().array() <= p.array()).all() &&
            (x.rowwise().maxCoeff().array() >= p.array()).all()) {
            const Vector3<S> xi = Tet4::natural_coordinates<S>(x, p).coordinates;
            count += xi.minCoeff() >= -tolerance && xi.sum() <= S(1) + tolerance ? 1 : 0;
        }
    }
    return count;
}

template <class S>
S sum_of_volumes(const Tetrahedralisation<S>& volume) {
    S sum(0);
    for (Index c = 0; c < volume.tets.cols(); ++c) {
        sum += Tet4::rest_volume(CellMesh<Tet4, S>::gather(volume.positions, volume.tets.col(c)));
    }
    return sum;
}

template <class S>
void check_covered(const Matrix3X<S>& positions, const Triangles& triangles, int trials) {
    const Tetrahedralisation<S> volume = DelaunayInterior{}(positions, triangles);
    CHECK(volume.positions == positions);
    const CellMesh<Tet4, S> mesh{volume.positions, volume.tets};
    CHECK_NOTHROW(mesh.validate());
    const Vector3<S> lower = positions.rowwise().minCoeff();
    const Vector3<S> upper = positions.rowwise().maxCoeff();
    const Matrix3X<double> x = positions.template cast<double>();
    RandomGenerator random(5);
    int num_inside = 0;
    Index uncovered = 0;
    Index overlapping = 0;
    for (int trial = 0; trial < trials; ++trial) {
        Vector3<S> p;
        for (int i = 0; i < 3; ++i) {
            p(i) = S(random.uniform(double(lower(i)), double(upper(i))));
        }
        if (winding_by_solid_angle(x, triangles, p.template cast<double>()) > 0.5) {
            ++num_inside;
            uncovered += count_holding(volume, p, S(1e-4)) == 0 ? 1 : 0;
            overlapping += count_holding(volume, p, S(-1e-4)) > 1 ? 1 : 0;
        }
    }
    CHECK(num_inside > trials / 20);
    CHECK(uncovered == 0);
    CHECK(overlapping == 0);
}

}  // namespace

TEST_CASE_TEMPLATE("a convex surface is filled exactly", S, float, double) {
    const CapsuleBody<S> body;
    check_covered(body.positions, body.faces, 2000);
    const S expected = enclosed_volume(body.positions, body.faces);
    CHECK(sum_of_volumes(DelaunayInterior{}(body.positions, body.faces)) ==
          doctest::Approx(double(expected)).epsilon(1e-5));
}

TEST_CASE_TEMPLATE("a coarse surface with a tight waist is covered", S, float, double) {
    CapsuleBody<S> body;
    body.tie(0.15);
    check_covered(body.positions, body.faces, 4000);
}

TEST_CASE("a bent capsule is not bridged where its surface is resolved") {
    CapsuleBody<double> body;
    for (Index v = 0; v < body.positions.cols(); ++v) {  // around an arc of radius 0.2: nearly closed
        const Vector3<double> p = body.positions.col(v);
        const double angle = p(1) / 0.2;
        body.positions.col(v) << (0.2 + p(0)) * std::cos(angle), (0.2 + p(0)) * std::sin(angle), p(2);
    }
    check_covered(body.positions, body.faces, 4000);
    const Tetrahedralisation<double> volume = DelaunayInterior{}(body.positions, body.faces);
    const double expected = enclosed_volume(body.positions, body.faces);
    CHECK(sum_of_volumes(volume) >= expected * (1 - 1e-9));
    CHECK(sum_of_volumes(volume) < 1.05 * expected);
}

TEST_CASE("a human surface is covered, and little beyond it") {
    const HumanMesh human = make_human_mesh();
    check_covered(human.vertices, human.faces, 1500);
    const Tetrahedralisation<double> volume = DelaunayInterior{}(human.vertices, human.faces);
    const double expected = enclosed_volume(human.vertices, human.faces);
    CHECK(sum_of_volumes(volume) >= expected * (1 - 1e-9));
    CHECK(sum_of_volumes(volume) < 1.02 * expected);
    CHECK(volume.tets == DelaunayInterior{}(human.vertices, human.faces).tets);
}

TEST_CASE("surfaces that are open or leave a vertex out are refused") {
    const CapsuleBody<double> body;
    const Triangles open = body.faces.leftCols(body.faces.cols() - 1);
    CHECK_THROWS_AS(DelaunayInterior{}(body.positions, open), InvalidInput);
    Matrix3X<double> positions(3, body.positions.cols() + 1);
    positions << body.positions, Vector3<double>(0.01, 0.5, 0.0);
    CHECK_THROWS_WITH_AS(DelaunayInterior{}(positions, body.faces), "surface: vertex 498 is in no triangle",
                         InvalidInput);
}
