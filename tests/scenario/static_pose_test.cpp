// SPDX-License-Identifier: MIT
// A pose that is held until the tissue settles (Romero et al. 2020, fig. 4): in unposed space it ends on the skinned shape.
#include <softtissue/anatomy/make_soft_layer.hpp>
#include <softtissue/avatar/soft_tissue_avatar.hpp>
#include <softtissue/avatar/tissue_model.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/io/amass_file.hpp>
#include <softtissue/io/smpl_file.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/mesh/split_prisms.hpp>
#include <softtissue/skinning/dual_quaternion.hpp>

#include <support/catch.hpp>
#include <support/rigged_bar.hpp>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>

using namespace softtissue;
using namespace softtissue_test;

namespace {

using Field = UniformField<StableNeoHookean<double>>;
const Field field{StableNeoHookean<double>::from_young_poisson({2e5, 0.4})};
const SequentialExecutor executor;

struct Settled {
    double start = 0;  ///< farthest from the skinned shape on the way [m]
    double error = 0;  ///< at rest [m]
    int steps = 0;
    int not_converged = 0;
};

/// Arrives in `pose` from `before` with the velocity that this takes, then holds it.
template <class Avatar>
Settled hold(Avatar& avatar, const Pose<double>& before, const Pose<double>& pose, int most_steps) {
    avatar.start(before, pose);
    Settled result;
    const auto error = [&] { return (avatar.positions() - avatar.skinned()).colwise().norm().maxCoeff(); };
    for (bool is_still = false; !is_still && result.steps < most_steps; ++result.steps) {
        result.not_converged += avatar.step(pose).succeeded() ? 0 : 1;
        result.start = std::max(result.start, error());
        is_still = avatar.velocities().cwiseAbs().maxCoeff() * avatar.options().time_step < 1e-10;
    }
    result.error = error();
    return result;
}

template <class Frame, class Policy>
Settled hold_bar(bool correctives) {
    const RiggedBar<Tet4> bar;
    SoftTissueAvatar<Tet4, Field, Frame, Policy> avatar(
        VolumetricSmpl<double, Policy>(bar.body, Policy{}, {.pose_correctives = correctives}), bar.mesh, bar.prescribed, field,
        executor);
    return hold(avatar, RiggedBar<Tet4>::pose(0.8), RiggedBar<Tet4>::pose(0.85), 3000);
}

void check_unposed(const char* what, const Settled& settled) {
    WARN(what << ", unposed: " << 1e3 * settled.start << " mm away on the way, " << settled.error << " m after "
              << settled.steps << " steps");
    CHECK(settled.not_converged == 0);
    CHECK(settled.start > 1e-3);
    CHECK(settled.error < 1e-8);
}

/// The pose farthest from rest, turns of the whole body aside, and the one before it.
size_t strongest_pose(const Motion<double>& motion) {
    size_t best = 1;
    double largest = 0;
    for (size_t t = 1; t < motion.poses.size(); ++t) {
        const auto& rotations = motion.poses[t].rotation_vectors;
        const double strength = rotations.rightCols(rotations.cols() - 1).squaredNorm();
        if (strength > largest) {
            largest = strength;
            best = t;
        }
    }
    return best;
}

}  // namespace

TEST_CASE("a limb held in a pose settles on the skinned shape in unposed space", "[static pose]") {
    check_unposed("linear blend", hold_bar<UnposedFrame, LinearBlend<double>>(false));
    check_unposed("dual quaternions", hold_bar<UnposedFrame, DualQuaternion<double>>(false));
    check_unposed("SMPL", hold_bar<UnposedFrame, LinearBlend<double>>(true));
}

TEST_CASE("in the world frame it settles elsewhere", "[static pose]") {
    for (const bool correctives : {false, true}) {
        const Settled settled = hold_bar<WorldFrame, LinearBlend<double>>(correctives);
        WARN("world: " << 1e3 * settled.error << " mm from the skinned shape after " << settled.steps << " steps");
        CHECK(settled.not_converged == 0);
        CHECK(settled.error > 1e-4);
    }
}

TEST_CASE("a body held in the strongest pose of every clip settles on the skinned shape", "[static pose]") {
    namespace fs = std::filesystem;
    const fs::path shared = SOFTTISSUE_SHARED_DIR;
    if (!fs::exists(shared / "data/body/body_small.npz") || !fs::exists(shared / "data/motion")) {
        WARN("skipped: no bodies and motions in " << shared.string());
        return;
    }
    const SmplBody<double> body = read_smpl_body<double>(shared / "data/body/body_small.npz");
    const SoftLayer<double> layer = make_soft_layer(body);
    const CellMesh<Tet4, double> mesh = split_prisms(layer.mesh);
    std::vector<fs::path> clips;
    for (const auto& entry : fs::directory_iterator(shared / "data/motion")) {
        if (entry.path().extension() == ".npz") {
            clips.push_back(entry.path());
        }
    }
    std::sort(clips.begin(), clips.end());
    REQUIRE_FALSE(clips.empty());
    const auto hold_all = [&](const char* what, const auto& skin, auto frame) {
        using Policy = std::remove_cvref_t<decltype(skin.policy())>;
        SoftTissueAvatar<Tet4, Field, decltype(frame), Policy> avatar(make_tissue_model(skin, layer), mesh,
                                                                      layer.prescribed_vertices, field, executor);
        for (const fs::path& clip : clips) {
            INFO(what << ", " << clip.filename().string());
            const Motion<double> motion = read_amass_motion<double>(clip, body.num_joints());
            const size_t t = strongest_pose(motion);
            const Settled settled = hold(avatar, motion.poses[t - 1], motion.poses[t], decltype(frame)::is_unposed ? 60 : 20);
            WARN(what << ", " << clip.filename().string() << ": " << 1e3 * settled.start << " mm away on the way, "
                      << settled.error << " m after " << settled.steps << " steps");
            CHECK(settled.not_converged == 0);
            if (decltype(frame)::is_unposed) {
                CHECK(settled.error < 1e-8);
            } else {
                CHECK(settled.error > 1e-4);
                return;  // one clip says it
            }
        }
    };
    hold_all("SMPL, unposed", VolumetricSmpl<double>(body), UnposedFrame{});
    hold_all("linear blend, unposed", VolumetricSmpl<double>(body, {}, {.pose_correctives = false}), UnposedFrame{});
    hold_all("dual quaternions, unposed",
             VolumetricSmpl<double, DualQuaternion<double>>(body, {}, {.pose_correctives = false}), UnposedFrame{});
    hold_all("SMPL, world", VolumetricSmpl<double>(body), WorldFrame{});
}
