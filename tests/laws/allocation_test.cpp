// SPDX-License-Identifier: MIT
// Nothing is allocated per frame.
#include <support/allocation_counter.hpp>

#include <softtissue/avatar/soft_tissue_avatar.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/ndg/layered_flesh.hpp>
#include <softtissue/skinning/blended_rotation.hpp>
#include <softtissue/skinning/dual_quaternion.hpp>
#include <softtissue/skinning/inverse.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/skinning/volumetric_smpl.hpp>
#include <softtissue/solver/gradient_skinning.hpp>
#include <softtissue/solver/local_global.hpp>
#include <softtissue/solver/poisson_reconstruction.hpp>

#include <support/layered_limb.hpp>
#include <support/rigged_bar.hpp>
#include "../unit/skinning/arm_body.hpp"

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

TEST_CASE("quasi-static solves allocate in their first iteration only") {
    const LayeredLimb<double> limb;
    const SequentialExecutor executor;
    LayeredFlesh<double, SequentialExecutor> flesh(limb.body, {}, executor);
    Matrix3X<double> x = limb.bent(1.0);
    std::size_t last = 0;
    int watched = 0;
    const SolveReport<double> report =
        flesh.solve_into(x, quasi_static_options<double>(), [&](const NewtonProgress<double>& progress) {
            if (progress.iteration >= 1) {
                Eigen::internal::set_is_malloc_allowed(false);
                watched += progress.iteration >= 2 ? 1 : 0;
                CHECK((progress.iteration == 1 || num_allocations == last));
            }
            last = num_allocations;
            return true;
        });
    Eigen::internal::set_is_malloc_allowed(true);
    CHECK(report.succeeded());
    CHECK(watched > 0);
    CHECK(report.quasi_newton_steps > 0);

    x = limb.bent(0.8);
    const AllocationCounter counter;
    CHECK(flesh.solve_into(x).succeeded());
    CHECK(counter.count() == 0);
}

TEST_CASE_TEMPLATE("an avatar's steps allocate nothing after the first, by Newton's method neither", Frame,
                   UnposedFrame, WorldFrame) {
    using Field = UniformField<StableNeoHookean<double>>;
    const RiggedBar<Prism6> bar(2);
    const SequentialExecutor executor;
    const Field field{StableNeoHookean<double>::from_young_poisson({2e5, 0.3})};
    for (const int quasi_newton_steps : {30, 0}) {
        CAPTURE(quasi_newton_steps);
        SoftTissueAvatar<Prism6, Field, Frame> avatar(VolumetricSmpl<double>(bar.body), bar.mesh, bar.prescribed, field,
                                                      executor, {.quasi_newton = {.max_steps = quasi_newton_steps}});
        CHECK(avatar.step(RiggedBar<Prism6>::swing(1)).succeeded());
        std::vector<Pose<double>> poses;
        for (int k = 2; k < 8; ++k) {
            poses.push_back(RiggedBar<Prism6>::swing(k));
        }
        int steps = 0;
        const AllocationCounter counter;
        for (const Pose<double>& pose : poses) {
            const SolveReport<double> report = avatar.step(pose);
            steps += report.iterations + report.quasi_newton_steps;
        }
        CHECK(counter.count() == 0);
        CHECK(steps >= 6);
    }
}
