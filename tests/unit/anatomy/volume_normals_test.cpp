// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/volume_normals.hpp>

#include <softtissue/anatomy/make_soft_layer.hpp>
#include <softtissue/anatomy/orthotropy_basis.hpp>
#include <softtissue/mesh/split_prisms.hpp>

#include <support/capsule_body.hpp>

#include <doctest/doctest.h>

#include <vector>

using namespace softtissue;

TEST_CASE_TEMPLATE("inside a capsule the normals stay radial and agree with the prisms' bases", S, float, double) {
    const CapsuleBody<S> body;
    SoftLayerOptions<S> options;
    options.region.extremities = JointGroups{{0}, {2}};
    const SoftLayer<S> layer =
        make_soft_layer(body.positions, body.faces, body.weights, body.tree, body.joints, options);
    const CellMesh<Tet4, S> tets = split_prisms(layer.mesh);
    std::vector<std::int32_t> skin;
    for (Index i = 0; i < layer.num_columns(); ++i) {
        skin.push_back(static_cast<std::int32_t>(layer.skin_vertex(i)));
    }
    const Matrix3X<S> skin_normals = vertex_normals(layer.skin_positions, layer.region.triangles);
    const Matrix3X<S> normals = interpolate_normals(tets, skin, skin_normals);
    for (Index v = 0; v < normals.cols(); ++v) {
        CHECK(normals.col(v).norm() == doctest::Approx(1.0));
        const Vector3<S> x = tets.rest_positions.col(v);
        CHECK(normals.col(v).dot(Vector3<S>(x(0), S(0), x(2)).normalized()) > S(0.98));
    }
    const auto of_tets = orthotropy_bases(tets.cells, normals);
    const auto of_prisms = orthotropy_bases(layer);
    for (size_t c = 0; c < of_tets.size(); ++c) {
        CHECK(of_tets[c].col(0).dot(of_prisms[c / 3].col(0)) > S(0.98));
    }
    CHECK_THROWS_WITH_AS(
        interpolate_normals<S>(tets, skin, skin_normals.leftCols(2)),
        ("normals: 2 for " + std::to_string(skin.size()) + " skin vertices, expected equal numbers").c_str(),
        InvalidInput);
}
