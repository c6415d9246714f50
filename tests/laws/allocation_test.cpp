// SPDX-License-Identifier: MIT
// Nothing is allocated per frame.
#include <support/allocation_counter.hpp>

#include <softtissue/skinning/blended_rotation.hpp>
#include <softtissue/skinning/dual_quaternion.hpp>
#include <softtissue/skinning/inverse.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/skinning/volumetric_smpl.hpp>
#include <softtissue/solver/gradient_skinning.hpp>
#include <softtissue/solver/local_global.hpp>
#include <softtissue/solver/poisson_reconstruction.hpp>

#include "../unit/skinning/arm_body.hpp"
#include <support/rigged_bar.hpp>

#include <doctest/doctest.h>

#include <vector>

using namespace softtissue;
using namespace softtissue_test;

TEST_CASE_TEMPLATE("posing, unposing and blending rotations again allocates nothing", Policy, LinearBlend<double>,
                   DualQuaternion<double>) {
    const VolumetricSmpl<double, Policy> model(arm_body<double>());
    const BlendedRotations<double> blended(model.weights());
    const Pose<double> first = random_pose<double>(4, 1), second = random_pose<double>(4, 2);
    PosedBody<double> posed = model.pose(first);
    const std::vector<Quaternion<double>> bones = bone_quaternions<double>(posed.joint_transforms);
    std::vector<Matrix3<double>> rotations(size_t(blended.num_rows()), Matrix3<double>::Zero());
    Matrix3X<double> u = posed.positions;

    {
        const AllocationCounter counter;
        model.pose_into(second, posed);
        unposed_into(posed, posed.positions, u);
        blended.rotations_into(bones, rotations);
        CHECK(counter.count() == 0);
    }
    PosedBody<double> fresh;
    const std::size_t before = num_allocations;
    model.pose_into(second, fresh);
    CHECK(num_allocations > before);
    CHECK(fresh.positions == posed.positions);
}

TEST_CASE("reconstructing a pose again allocates nothing") {
    const RiggedBar<Prism6> bar(2);
    const Matrix3X<double>& X = bar.mesh.rest_positions;
    const VolumetricSmpl<double, LinearBlend<double>> model(bar.body);
    PoissonReconstruction<Prism6, double> poisson(bar.mesh, PrescribedVertices(X.cols(), bar.prescribed));
    GradientSkinning<Prism6, double> gradient_skinning(poisson, bar.mesh, model.weights());
    LocalGlobal<Prism6, double> local_global(poisson);
    PosedBody<double> posed = model.pose(RiggedBar<Prism6>::swing(1));
    const auto bones = bone_quaternions<double>(posed.joint_transforms);
    Matrix3X<double> x = posed.positions, F;
    const auto frame = [&] {
        gradient_skinning.solve_into(bones, x);
        poisson.gradients_into(x, F);
        poisson.solve_into(F, x);
        (void)local_global.solve_into(x);
    };
    frame();
    const AllocationCounter counter;
    frame();
    CHECK(counter.count() == 0);
}
