// SPDX-License-Identifier: MIT
// Nothing is allocated per frame: counted by operator new, and by Eigen itself, which calls malloc.
#define EIGEN_RUNTIME_NO_MALLOC

#include <softtissue/skinning/blended_rotation.hpp>
#include <softtissue/skinning/dual_quaternion.hpp>
#include <softtissue/skinning/inverse.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/skinning/volumetric_smpl.hpp>

#include "../unit/skinning/arm_body.hpp"

#include <doctest/doctest.h>

#include <cstdlib>
#include <new>
#include <vector>

using namespace softtissue;
using softtissue_test::arm_body;
using softtissue_test::random_pose;

namespace {
std::size_t num_allocations = 0;
}

// Not inlined: the compiler would see malloc and free in pairs with new and delete, and warn.
[[gnu::noinline]] void* operator new(std::size_t size) {
    ++num_allocations;
    if (void* const memory = std::malloc(size)) {
        return memory;
    }
    throw std::bad_alloc{};
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

TEST_CASE_TEMPLATE("posing, unposing and blending rotations again allocates nothing", Policy, LinearBlend<double>,
                   DualQuaternion<double>) {
    const VolumetricSmpl<double, Policy> model(arm_body<double>());
    const BlendedRotations<double> blended(model.weights());
    const Pose<double> first = random_pose<double>(4, 1), second = random_pose<double>(4, 2);
    PosedBody<double> posed = model.pose(first);
    const std::vector<Quaternion<double>> bones = bone_quaternions<double>(posed.joint_transforms);
    std::vector<Matrix3<double>> rotations(size_t(blended.num_rows()), Matrix3<double>::Zero());
    Matrix3X<double> u = posed.positions;

    const std::size_t before = num_allocations;
    Eigen::internal::set_is_malloc_allowed(false);
    model.pose_into(second, posed);
    unposed_into(posed, posed.positions, u);
    blended.rotations_into(bones, rotations);
    Eigen::internal::set_is_malloc_allowed(true);
    CHECK(num_allocations == before);

    PosedBody<double> fresh;
    model.pose_into(second, fresh);
    CHECK(num_allocations > before);
    CHECK(fresh.positions == posed.positions);
}
