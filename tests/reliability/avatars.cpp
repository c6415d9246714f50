// SPDX-License-Identifier: MIT
#include "doors.hpp"
#include "kinds.hpp"
#include "random_pose.hpp"

#include <softtissue/avatar/soft_tissue_avatar.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/skinning/dual_quaternion.hpp>

#include <support/rigged_bar.hpp>

#include <string>

namespace reliability {

namespace {

using softtissue_test::RiggedBar;

const SequentialExecutor executor;

template <class S>
using Field = UniformField<StableNeoHookean<S>>;

template <class S>
Field<S> field() {
    return {StableNeoHookean<S>::from_young_poisson({S(2e5), S(0.45)})};
}

/// A step into a random pose at once, one half of the way to another, and steps at rest.
template <class ElementType, class S, class Frame, class Policy>
void throw_avatars(Ledger& ledger, const char* what, long count, std::uint64_t seed) {
    const RiggedBar<ElementType, S> bar(2);
    Tally& tally = ledger.begin(std::string("avatar, ") + what);
    tally.rest_tolerance = 1e-3;
    SoftTissueAvatar<ElementType, Field<S>, Frame, Policy> avatar(VolumetricSmpl<S, Policy>(bar.body), bar.mesh,
                                                                  bar.prescribed, field<S>(), executor);
    for (long k = 0; k < count; ++k) {
        RandomGenerator random(seed + std::uint64_t(k));
        const Pose<S> rest = Pose<S>::rest(3), pose = random_pose<S>(3, random), other = random_pose<S>(3, random);
        avatar.start(rest);
        for (const Pose<S>& next : {pose, between(pose, other, random.uniform(0, 0.02)), rest}) {
            tally.attempt([&] {
                Outcome outcome = outcome_of(avatar.step(next), avatar.positions());
                outcome.is_finite =
                    outcome.is_finite && avatar.velocities().allFinite() && avatar.displacement().allFinite();
                return outcome;
            });
        }
    }
    ledger.print_last();
}

void open_doors(Ledger& ledger) {
    using Avatar = SoftTissueAvatar<Prism6, Field<double>>;
    const RiggedBar<Prism6, double> bar(2);
    const VolumetricSmpl<double> model(bar.body);
    const Pose<double> rest = Pose<double>::rest(3);
    const auto step = [&](Avatar& avatar, const Pose<double>& pose) {
        const SolveReport<double> report = avatar.step(pose);
        Outcome outcome = outcome_of(report, avatar.positions());
        outcome.is_finite = outcome.is_finite && avatar.velocities().allFinite();
        return outcome;
    };
    const auto rest_step = [&](const SmplBody<double>& body, const CellMesh<Prism6, double>& mesh,
                               const AvatarOptions<double>& options) {
        Avatar avatar(VolumetricSmpl<double>(body), mesh, bar.prescribed, field<double>(), executor, options);
        return step(avatar, rest);
    };
    Doors<double> doors(ledger, "avatar");
    doors.open("rotation of a joint", "joint 1", [&](double x) {
        Avatar avatar(model, bar.mesh, bar.prescribed, field<double>(), executor);
        Pose<double> pose = rest;
        pose.rotation_vectors(2, 1) = x;
        return step(avatar, pose);
    });
    doors.open("translation of a pose", "translation", [&](double x) {
        Avatar avatar(model, bar.mesh, bar.prescribed, field<double>(), executor);
        Pose<double> pose = rest;
        pose.translation(1) = x;
        return step(avatar, pose);
    });
    doors.open("translation of a pose to settle in", "translation", [&](double x) {
        Avatar avatar(model, bar.mesh, bar.prescribed, field<double>(), executor);
        Pose<double> pose = rest;
        pose.translation(1) = x;
        return outcome_of(avatar.settle(pose), avatar.positions());
    });
    doors.open("shape", "coefficient 1", [&](double x) {
        VolumetricSmpl<double> shaped = model;
        shaped.set_shape(Eigen::Vector2d(0.5, x));
        return Doors<double>::finite(shaped.pose(rest).positions.allFinite());
    });
    doors.open("time step", "time step",
               [&](double x) { return rest_step(bar.body, bar.mesh, AvatarOptions<double>{.time_step = x}); });
    doors.open("density", "density",
               [&](double x) { return rest_step(bar.body, bar.mesh, AvatarOptions<double>{.density = x}); });
    doors.open("position of the body", "vertex 4", [&](double x) {
        SmplBody<double> body = bar.body;
        CellMesh<Prism6, double> mesh = bar.mesh;
        body.template_vertices(1, 4) = mesh.rest_positions(1, 4) = x;
        return rest_step(body, mesh, {});
    });
    doors.open("position of the mesh", "mesh", [&](double x) {
        CellMesh<Prism6, double> mesh = bar.mesh;
        mesh.rest_positions(1, 4) = x;
        return rest_step(bar.body, mesh, {});
    });
    doors.open("shape direction", "vertex 3", [&](double x) {
        SmplBody<double> body = bar.body;
        body.shape_directions(10, 1) = x;
        return rest_step(body, bar.mesh, {});
    });
}

}  // namespace

void run_avatars(Ledger& ledger, long count, std::uint64_t seed) {
    open_doors(ledger);
    throw_avatars<Prism6, double, UnposedFrame, LinearBlend<double>>(ledger, "unposed, prisms, linear blend", count,
                                                                     seed);
    throw_avatars<Tet4, float, RestRetargetedFrame, DualQuaternion<float>>(
        ledger, "retargeted, tets, dual quaternions, float", count, seed);
}

}  // namespace reliability
