// SPDX-License-Identifier: MIT
#include <softtissue/avatar/tissue_model.hpp>

#include <support/rigged_bar.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace softtissue;
using namespace softtissue_test;

namespace {

/// The bar's surface as the skin: its tets are the volume.
struct Bar {
    RiggedBar<Tet4> whole{4};
    std::vector<VertexMatch> matches;
    SmplBody<double> skin;

    Bar() {
        const auto surface = solid_block<Tet4>({.n = 4}).surface;
        const Index n = Index(surface.size());
        const SmplBody<double>& body = whole.body;
        skin.tree = body.tree;
        skin.template_vertices.resize(3, n);
        MatrixX<double> weights(n, 3);
        MatrixX<double> shapes(3 * n, 2), correctives(3 * n, 18), regressor(3, n);
        const MatrixX<double> all_weights = body.weights.dense(), all_correctives = body.pose_directions.toDense(),
                              all_regressor = body.joint_regressor.toDense();
        for (Index s = 0; s < n; ++s) {
            const std::int32_t v = surface[size_t(s)];
            matches.push_back({v, std::int32_t(s)});
            skin.template_vertices.col(s) = body.template_vertices.col(v);
            weights.row(s) = all_weights.row(v);
            regressor.col(s) = all_regressor.col(v);
            shapes.middleRows<3>(3 * s) = body.shape_directions.middleRows<3>(3 * v);
            correctives.middleRows<3>(3 * s) = all_correctives.middleRows<3>(3 * v);
        }
        skin.weights = SkinningWeights<double>(weights);
        skin.joint_regressor = regressor.sparseView();
        skin.shape_directions = shapes;
        skin.pose_directions = correctives.sparseView();
    }
};

}  // namespace

TEST_CASE("surface vertices keep what the skin says; inner ones lie between") {
    const Bar bar;
    const VolumetricSmpl<double> skin(bar.skin);
    const VolumetricSmpl<double> tissue = make_tissue_model(skin, bar.whole.mesh, std::span<const VertexMatch>(bar.matches));
    CHECK(tissue.num_vertices() == bar.whole.mesh.num_vertices());
    CHECK((tissue.rest_vertices() - bar.whole.mesh.rest_positions).norm() == 0.0);
    const Pose<double> pose = RiggedBar<Tet4>::pose(0.7);
    const PosedBody<double> posed_skin = skin.pose(pose), posed = tissue.pose(pose);
    double worst = 0;
    std::vector<bool> is_skin(size_t(tissue.num_vertices()), false);
    for (const VertexMatch& match : bar.matches) {
        worst = std::max(worst, (posed.positions.col(match.volume) - posed_skin.positions.col(match.surface)).norm());
        is_skin[size_t(match.volume)] = true;
    }
    CHECK(worst < 1e-14);
    const MatrixX<double> weights = tissue.weights().dense(), on_skin = skin.weights().dense();
    int num_inner = 0;
    for (Index v = 0; v < tissue.num_vertices(); ++v) {
        CHECK(std::abs(weights.row(v).sum() - 1) < 1e-14);
        if (!is_skin[size_t(v)]) {
            ++num_inner;
            for (Index j = 0; j < 3; ++j) {
                CHECK(weights(v, j) > on_skin.col(j).minCoeff());
                CHECK(weights(v, j) < on_skin.col(j).maxCoeff());
            }
            const double x = bar.whole.mesh.rest_positions(0, v) / 0.6;
            if (std::abs(x - 0.5) > 0.1) {
                CHECK((weights(v, 0) > weights(v, 2)) == (x < 0.5));
            }
        }
    }
    CHECK(num_inner == 27);
}

TEST_CASE("an affine shape direction is carried exactly") {
    Bar bar;
    RandomGenerator random(2);
    const Matrix3<double> G = random_normal<Matrix3<double>>(random);
    const Matrix3X<double> direction = G * bar.skin.template_vertices;
    bar.skin.shape_directions.col(0) = direction.reshaped();
    const VolumetricSmpl<double> skin(bar.skin);
    const VolumetricSmpl<double> tissue = make_tissue_model(skin, bar.whole.mesh, std::span<const VertexMatch>(bar.matches));
    const VectorX<double> betas = VectorX<double>::Constant(1, 0.5);
    const Matrix3X<double> expected = bar.whole.mesh.rest_positions + 0.5 * G * bar.whole.mesh.rest_positions;
    CHECK((tissue.rest_shape(betas) - expected).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("a volume vertex that no cell joins to the skin is refused") {
    const Bar bar;
    CellMesh<Tet4, double> mesh = bar.whole.mesh;
    const Index n = mesh.num_vertices();
    mesh.rest_positions.conservativeResize(Eigen::NoChange, n + 1);
    mesh.rest_positions.col(n).setZero();
    const VolumetricSmpl<double> skin(bar.skin);
    std::string text;
    try {
        static_cast<void>(make_tissue_model(skin, mesh, std::span<const VertexMatch>(bar.matches)));
    } catch (const InvalidInput& error) {
        text = error.what();
    }
    CAPTURE(text);
    CHECK(text.find(std::to_string(n)) != std::string::npos);
}
