// SPDX-License-Identifier: MIT
#include <softtissue/avatar/soft_tissue_avatar.hpp>

#include <softtissue/element/prism6.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>

#include <reliability/random_pose.hpp>
#include <support/rigged_bar.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>

using namespace softtissue;
using namespace softtissue_test;

namespace {

using Bar = RiggedBar<Prism6>;
using Field = UniformField<StableNeoHookean<double>>;
template <class Frame>
using Avatar = SoftTissueAvatar<Prism6, Field, Frame>;

const SequentialExecutor executor;
const Field field{StableNeoHookean<double>::from_young_poisson({2e5, 0.3})};
const Pose<double> rest = Pose<double>::rest(3);

double largest_distance(const Matrix3X<double>& a, const Matrix3X<double>& b) { return (a - b).colwise().norm().maxCoeff(); }

}  // namespace

TEST_CASE_TEMPLATE("an avatar starts at rest and stays there", Frame, UnposedFrame, WorldFrame, RestRetargetedFrame) {
    const Bar bar;
    Avatar<Frame> avatar(VolumetricSmpl<double>(bar.body), bar.mesh, bar.prescribed, field, executor);
    CHECK(avatar.mesh().num_cells() == bar.mesh.num_cells());
    CHECK(avatar.model().num_joints() == 3);
    CHECK(avatar.options().time_step == 1.0 / 120.0);
    CHECK(avatar.prescribed().num_free() == bar.mesh.num_vertices() - Index(bar.prescribed.size()));
    for (int step = 0; step < 3; ++step) {
        CHECK(avatar.step(rest).succeeded());
    }
    CHECK(largest_distance(avatar.positions(), bar.mesh.rest_positions) < 1e-12);
    CHECK(avatar.velocities().norm() < 1e-9);
    CHECK(avatar.count_inverted() == 0);
}

TEST_CASE_TEMPLATE("in motion the prescribed vertices follow the skin, the tissue lags and comes to rest", Frame,
                   UnposedFrame, WorldFrame, RestRetargetedFrame) {
    const Bar bar(2);
    Avatar<Frame> avatar(VolumetricSmpl<double>(bar.body), bar.mesh, bar.prescribed, field, executor);
    double largest_lag = 0;
    for (int k = 1; k <= 20; ++k) {
        const SolveReport<double> report = avatar.step(Bar::swing(k));
        CHECK(report.succeeded());
        largest_lag = std::max(largest_lag, largest_distance(avatar.positions(), avatar.skinned()));
        for (const std::int32_t v : bar.prescribed) {
            CHECK((avatar.positions().col(v) - avatar.skinned().col(v)).norm() < 1e-14);
        }
        CHECK(largest_distance(avatar.skinned(), avatar.posed().positions) == 0.0);
    }
    CHECK(largest_lag > 1e-3);
    CHECK(largest_lag < 0.1);

    // held, and settled by statics: the same place, without velocity
    for (int k = 0; k < 300; ++k) {
        CHECK(avatar.step(Bar::swing(20)).succeeded());
    }
    const Matrix3X<double> held = avatar.positions();
    CHECK(avatar.settle(Bar::swing(20)).succeeded());
    CHECK(largest_distance(avatar.positions(), held) < 1e-7);
    CHECK(avatar.velocities().norm() == 0.0);
    const double distance = largest_distance(avatar.positions(), avatar.skinned());
    if (std::is_same_v<Frame, WorldFrame>) {
        CHECK(distance > 1e-4);
    } else {
        CHECK(distance < 1e-8);
    }
}

TEST_CASE("an avatar may start in motion") {
    const Bar bar;
    Avatar<UnposedFrame> avatar(VolumetricSmpl<double>(bar.body), bar.mesh, bar.prescribed, field, executor);
    const Pose<double> before = Bar::pose(0.4), now = Bar::pose(0.42);
    avatar.start(before, now);
    const VolumetricSmpl<double> model(bar.body);
    const Matrix3X<double> velocity = 120 * (model.pose(now).positions - model.pose(before).positions);
    CHECK(largest_distance(avatar.positions(), model.pose(now).positions) < 1e-14);
    CHECK(largest_distance(avatar.velocities(), velocity) < 1e-12 * velocity.norm() + 1e-11);
    // body and tissue go on together: in a step of uniform translation nothing is left behind
    Pose<double> first = rest, second = rest, third = rest;
    first.translation << 0.00, 0, 0;
    second.translation << 0.01, 0, 0;
    third.translation << 0.02, 0, 0;
    avatar.start(first, second);
    CHECK(avatar.step(third).succeeded());
    CHECK(largest_distance(avatar.positions(), avatar.skinned()) < 1e-12);
    // standing still at the start, it is left behind
    avatar.start(second);
    CHECK(avatar.velocities().norm() == 0.0);
    CHECK(avatar.step(third).succeeded());
    CHECK(largest_distance(avatar.positions(), avatar.skinned()) > 1e-3);
}

TEST_CASE("an observer cancels a step") {
    const Bar bar;
    Avatar<UnposedFrame> avatar(VolumetricSmpl<double>(bar.body), bar.mesh, bar.prescribed, field, executor);
    const SolveReport<double> report = avatar.step(Bar::pose(0.3), [](const NewtonProgress<double>&) { return false; });
    CHECK(report.status == SolveStatus::cancelled);
    CHECK(avatar.positions().allFinite());
    CHECK(avatar.step(Bar::pose(0.3)).succeeded());
}

TEST_CASE("what does not fit is refused") {
    const Bar bar;
    const VolumetricSmpl<double> model(bar.body);
    const auto refusal = [&](const CellMesh<Prism6, double>& mesh, const std::vector<std::int32_t>& prescribed,
                             const AvatarOptions<double>& options = {}) -> std::string {
        try {
            const Avatar<UnposedFrame> avatar(model, mesh, prescribed, field, executor, options);
            return "accepted";
        } catch (const InvalidInput& error) {
            return error.what();
        }
    };
    CHECK(refusal(bar.mesh, bar.prescribed) == "accepted");
    CHECK(refusal(Bar(2).mesh, bar.prescribed) == "soft-tissue avatar: mesh has 27 vertices, the skinned model 64");
    auto moved = bar.mesh;
    moved.rest_positions(1, 5) += 0.001;
    CHECK(refusal(moved, bar.prescribed) ==
          "soft-tissue avatar: rest positions of mesh and model differ by 0.001 m, expected the same shape");
    CHECK(refusal(bar.mesh, {64}) == "prescribed vertex 64, expected 0 to 63");
    CHECK(refusal(bar.mesh, bar.prescribed, {.density = 0}) == "density = 0 kg/m^3, expected > 0");
    CHECK(refusal(bar.mesh, bar.prescribed, {.time_step = -1}) == "time step = -1 s, expected > 0");
    auto inverted = bar.mesh;
    std::swap(inverted.cells(0, 7), inverted.cells(1, 7));
    std::swap(inverted.cells(3, 7), inverted.cells(4, 7));
    CHECK(refusal(inverted, bar.prescribed).starts_with("mesh: cell 7 has a rest Jacobian bound of -"));
    Avatar<UnposedFrame> avatar(model, bar.mesh, bar.prescribed, field, executor);
    CHECK_THROWS_WITH_AS(static_cast<void>(avatar.step(Pose<double>::rest(24))), "pose has 24 joints, expected 3",
                         InvalidInput);
}

TEST_CASE_TEMPLATE("thrown from pose to pose, far beyond what joints do, an avatar stays finite and says how it went", Frame,
                   UnposedFrame, WorldFrame, RestRetargetedFrame) {
    const Bar bar(2);
    Avatar<Frame> avatar(VolumetricSmpl<double>(bar.body), bar.mesh, bar.prescribed, field, executor);
    for (std::uint64_t k = 0; k < 15; ++k) {
        RandomGenerator random(k);
        avatar.start(rest);
        for (const Pose<double>& pose : {reliability::random_pose<double>(3, random), rest}) {
            const SolveReport<double> report = avatar.step(pose);
            CAPTURE(k);
            CAPTURE(to_string(report.status));
            CHECK(avatar.positions().allFinite());
            CHECK(avatar.velocities().allFinite());
            CHECK(report.iterations <= avatar.options().newton.max_iterations);
        }
    }
}

TEST_CASE("a pose that is not finite is refused, and the avatar goes on as if it had not been asked") {
    const Bar bar(2);
    const VolumetricSmpl<double> model(bar.body);
    Avatar<UnposedFrame> avatar(model, bar.mesh, bar.prescribed, field, executor);
    Avatar<UnposedFrame> other(model, bar.mesh, bar.prescribed, field, executor);
    CHECK(avatar.step(Bar::swing(1)).succeeded());
    CHECK(other.step(Bar::swing(1)).succeeded());
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e200}) {
        Pose<double> pose = Bar::swing(2);
        pose.rotation_vectors(0, 2) = bad;
        CHECK_THROWS_WITH_AS(static_cast<void>(avatar.step(pose)), "pose: joint 2: rotation is not finite", InvalidInput);
    }
    CHECK(avatar.step(Bar::swing(2)).succeeded());
    CHECK(other.step(Bar::swing(2)).succeeded());
    CHECK(avatar.positions() == other.positions());
    CHECK(avatar.velocities() == other.velocities());
}
