// SPDX-License-Identifier: MIT
#include <softtissue/model/procedural_human.hpp>

#include <softtissue/mesh/surface_normals.hpp>

#include <support/surface_topology.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <type_traits>
#include <vector>

using namespace softtissue;

static_assert(std::is_same_v<decltype(procedural_human<float>()), SmplBody<float>>);
static_assert(std::is_same_v<decltype(procedural_human<double>()), SmplBody<double>>);

namespace {

template <class S>
const SmplBody<S>& body() {
    static const SmplBody<S> result = procedural_human<S>();
    return result;
}

}  // namespace

TEST_CASE_TEMPLATE("procedural_human: a body in SMPL's form", S, float, double) {
    const SmplBody<S>& b = body<S>();
    b.validate("procedural human");
    CHECK(b.num_joints() == 24);
    CHECK(b.num_shapes() == 10);
    CHECK(b.tree.parents() == human_parents());
    CHECK(b.joint_names == human_joint_names());
    CHECK(b.pose_directions.nonZeros() > 10000);
    CHECK(b.shape_directions.cwiseAbs().maxCoeff() < S(0.1));
    const auto topology = softtissue_test::surface_topology(b.faces);
    CHECK(topology.is_closed());
    CHECK(topology.euler() == 2);
    for (Index v = 0; v < b.num_vertices(); ++v) {
        S sum(0);
        for (const auto& [joint, weight] : b.weights.row(v)) {
            sum += weight;
        }
        CHECK(std::abs(sum - S(1)) < S(4) * std::numeric_limits<S>::epsilon());
        CHECK(b.weights.row(v).size() <= 6);
    }
}

TEST_CASE_TEMPLATE("procedural_human: the regressor gives the designed joints", S, float, double) {
    const SmplBody<S>& b = body<S>();
    const Matrix3X<S> joints = (b.joint_regressor * b.template_vertices.transpose()).transpose();
    // Rounding: 48 products of weights below one with coordinates below two.
    const double rounding = 100.0 * double(std::numeric_limits<S>::epsilon());
    CHECK((joints.template cast<double>() - human_rest_joints()).cwiseAbs().maxCoeff() < rounding);
    const VectorX<S> ones = VectorX<S>::Ones(b.num_vertices());
    CHECK((b.joint_regressor * ones - VectorX<S>::Ones(24)).cwiseAbs().maxCoeff() < S(rounding));
}

TEST_CASE("procedural_human: regressed joints follow the shapes") {
    const SmplBody<double>& b = body<double>();
    const HumanBlendShapes shapes(human_rest_joints());
    for (Index k = 0; k < b.num_shapes(); ++k) {
        CAPTURE(k);
        const VectorX<double> d = b.shape_directions.col(k);
        const Matrix3X<double> displacement = Eigen::Map<const Matrix3X<double>>(d.data(), 3, b.num_vertices());
        const Matrix3X<double> moved = (b.joint_regressor * displacement.transpose()).transpose();
        CHECK((moved - shapes.joint_displacement(k)).colwise().norm().maxCoeff() < 0.004);
    }
}

TEST_CASE("procedural_human: two calls give the same bits, and float is the rounded double") {
    const SmplBody<double>& a = body<double>();
    const SmplBody<double> b = procedural_human<double>();
    CHECK(a.template_vertices == b.template_vertices);
    CHECK(a.faces == b.faces);
    CHECK(a.weights.dense() == b.weights.dense());
    CHECK(a.shape_directions == b.shape_directions);
    CHECK((a.pose_directions - b.pose_directions).norm() == 0.0);
    CHECK((a.joint_regressor - b.joint_regressor).norm() == 0.0);
    CHECK(body<float>().template_vertices == a.template_vertices.cast<float>());
}

TEST_CASE(
    "procedural_human: every vertex of torso and limbs has a direction that sees its triangles within 60 degrees") {
    const SmplBody<double>& b = body<double>();
    const MatrixX<double> w = b.weights.dense();
    const Matrix3X<double> normals = triangle_normals(b.template_vertices, b.faces);
    Matrix3X<double> directions = vertex_normals(b.template_vertices, b.faces);
    std::vector<std::vector<Index>> around(size_t(b.num_vertices()));
    for (Index f = 0; f < b.faces.cols(); ++f) {
        for (int k = 0; k < 3; ++k) {
            around[size_t(b.faces(k, f))].push_back(f);
        }
    }
    double worst = 1.0;
    for (Index v = 0; v < b.num_vertices(); ++v) {
        const double kept_out = w(v, 15) + w(v, 7) + w(v, 8) + w(v, 10) + w(v, 11) + w.row(v).tail<4>().sum();
        if (kept_out > 0.5) {
            continue;  // head, feet and hands are not simulated
        }
        for (const Index f : around[size_t(v)]) {
            worst = std::min(worst, normals.col(f).dot(directions.col(v)));
        }
    }
    CHECK(worst > 0.5);
}
