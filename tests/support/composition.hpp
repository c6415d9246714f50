// SPDX-License-Identifier: MIT
// One avatar of every strain frame and skinning for an element and a material: does it move?
#pragma once

#include <softtissue/avatar/soft_tissue_avatar.hpp>
#include <softtissue/skinning/dual_quaternion.hpp>
#include <softtissue/skinning/linear_blend.hpp>

#include <support/catch.hpp>
#include <support/rigged_bar.hpp>

namespace softtissue_test {

template <class ElementType, class Frame, class Policy, class Field>
void run_avatar(const char* what, const Field& field) {
    const RiggedBar<ElementType> bar(2);
    const SequentialExecutor executor;
    SoftTissueAvatar<ElementType, Field, Frame, Policy> avatar(VolumetricSmpl<double, Policy>(bar.body), bar.mesh,
                                                                bar.prescribed, field, executor);
    INFO(what);
    for (int step = 1; step <= 6; ++step) {
        const SolveReport<double> report = avatar.step(RiggedBar<ElementType>::swing(step));
        INFO("step " << step << ": " << to_string(report.status));
        CHECK(report.succeeded());
    }
    const double lag = (avatar.positions() - avatar.skinned()).colwise().norm().maxCoeff();
    CHECK(lag > 1e-5);
    CHECK(lag < 0.1);
    CHECK(avatar.count_inverted() == 0);
}

/// 6 avatars.
template <class ElementType, class Field>
void run_avatars(const Field& field) {
    run_avatar<ElementType, UnposedFrame, LinearBlend<double>>("unposed, linear blend", field);
    run_avatar<ElementType, WorldFrame, LinearBlend<double>>("world, linear blend", field);
    run_avatar<ElementType, RestRetargetedFrame, LinearBlend<double>>("retargeted, linear blend", field);
    run_avatar<ElementType, UnposedFrame, DualQuaternion<double>>("unposed, dual quaternions", field);
    run_avatar<ElementType, WorldFrame, DualQuaternion<double>>("world, dual quaternions", field);
    run_avatar<ElementType, RestRetargetedFrame, DualQuaternion<double>>("retargeted, dual quaternions", field);
}

}  // namespace softtissue_test
