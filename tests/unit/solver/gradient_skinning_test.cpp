// SPDX-License-Identifier: MIT
#include <softtissue/solver/gradient_skinning.hpp>

#include <softtissue/skinning/joint_transforms.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/skinning/volumetric_smpl.hpp>

#include <support/rigged_bar.hpp>

#include <doctest/doctest.h>

using namespace softtissue;
using namespace softtissue_test;

TEST_CASE_TEMPLATE("a pose that turns all bones alike turns the body; bent, cells follow their bones", Bar,
                   RiggedBar<Tet4>, RiggedBar<Prism6>) {
    using E = typename decltype(Bar::mesh)::CellElement;
    const Bar bar(3);
    const Matrix3X<double>& X = bar.mesh.rest_positions;
    const VolumetricSmpl<double, LinearBlend<double>> model(bar.body);
    PoissonReconstruction<E, double> poisson(bar.mesh, PrescribedVertices(X.cols(), bar.prescribed));
    GradientSkinning<E, double> skinning(poisson, bar.mesh, model.weights());

    Pose<double> turned = Pose<double>::rest(3);
    turned.rotation_vectors.col(0) << 0.4, -1.1, 0.3;
    turned.translation << 1, 2, 3;
    const PosedBody<double> rigid = model.pose(turned);
    Matrix3X<double> x = rigid.positions;
    for (const std::int32_t v : poisson.prescribed().free_vertices()) {
        x.col(v).setZero();
    }
    const auto bones = bone_quaternions<double>(rigid.joint_transforms);
    skinning.solve_into(bones, x);
    CHECK((x - rigid.positions).cwiseAbs().maxCoeff() < 1e-12);

    const PosedBody<double> bent = model.pose(Bar::pose(0.6));
    x = bent.positions;
    const auto bent_bones = bone_quaternions<double>(bent.joint_transforms);
    skinning.solve_into(bent_bones, x);
    Matrix3X<double> F, F_lbs;
    poisson.gradients_into(x, F);
    poisson.gradients_into(bent.positions, F_lbs);
    double distance = 0, distance_lbs = 0;
    const auto& R = skinning.rotations(bent_bones);
    for (Index c = 0; c < bar.mesh.num_cells(); ++c) {
        distance += poisson.rest().volumes(c) * (F.template middleCols<3>(3 * c) - R[size_t(c)]).squaredNorm();
        distance_lbs += poisson.rest().volumes(c) * (F_lbs.template middleCols<3>(3 * c) - R[size_t(c)]).squaredNorm();
    }
    CHECK(distance > 0);
    CHECK(distance < distance_lbs);
}
