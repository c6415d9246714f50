// SPDX-License-Identifier: MIT
#include <softtissue/ndg/shaped_body.hpp>

#include <softtissue/model/procedural_human.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE("all shapes share cells, weights and prescribed vertices; the skin is that of the shape") {
    const ShapedBodyMaker<double> maker(procedural_human<double>());
    VectorX<double> betas(3);
    betas << 1.0, -0.8, 0.5;
    const ShapedBody<double> mean = maker(VectorX<double>());
    const ShapedBody<double> shaped = maker(betas);
    CHECK(shaped.layered.mesh.cells == mean.layered.mesh.cells);
    CHECK(shaped.layered.prescribed == mean.layered.prescribed);
    CHECK(shaped.layered.weights.dense() == mean.layered.weights.dense());

    const SmplBody<double>& body = maker.body();
    Matrix3X<double> skin = body.template_vertices;
    for (Index k = 0; k < betas.size(); ++k) {
        skin += betas(k) * Eigen::Map<const Matrix3X<double>>(body.shape_directions.col(k).data(), 3, skin.cols());
    }
    CHECK(
        (shaped.layered.level_positions(2) + shaped.layered.skin_offsets - shaped.layered.region.gather(skin)).norm() <
        1e-12);
    CHECK((shaped.joints - (body.joint_regressor * skin.transpose()).transpose()).norm() < 1e-12);
    CHECK((shaped.joints - mean.joints).norm() > 0.01);
}
