// SPDX-License-Identifier: MIT
// The same bits for any number of threads, and from run to run.
#include <softtissue/avatar/soft_tissue_avatar.hpp>
#include <softtissue/core/thread_executor.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>

#include <support/avatar_crowd.hpp>
#include <support/catch.hpp>
#include <support/rigged_bar.hpp>

#include <vector>

using namespace softtissue;
using namespace softtissue_test;

namespace {

using Field = UniformField<StableNeoHookean<double>>;

/// Positions and velocities after each of 20 steps.
template <class ExecutorType>
std::vector<Matrix3X<double>> trajectory(const ExecutorType& executor) {
    const RiggedBar<Tet4> bar(4);
    const Field field{StableNeoHookean<double>::from_young_poisson({2e4, 0.45})};
    SoftTissueAvatar<Tet4, Field, WorldFrame, LinearBlend<double>, ExecutorType> avatar(
        VolumetricSmpl<double>(bar.body), bar.mesh, bar.prescribed, field, executor);
    std::vector<Matrix3X<double>> result;
    for (int step = 1; step <= 20; ++step) {
        REQUIRE(avatar.step(RiggedBar<Tet4>::swing(step)).succeeded());
        result.push_back(avatar.positions());
        result.push_back(avatar.velocities());
    }
    REQUIRE((result[38] - avatar.skinned()).norm() > 1e-3);
    return result;
}

}  // namespace

TEST_CASE("threads do not change a bit", "[determinism]") {
    const std::vector<Matrix3X<double>> sequential = trajectory(SequentialExecutor{});
    CHECK(trajectory(SequentialExecutor{}) == sequential);
    for (const int threads : {1, 2, 7}) {
        const ThreadExecutor executor(threads);
        INFO(threads << " threads");
        CHECK(trajectory(executor) == sequential);
        CHECK(trajectory(executor) == sequential);
    }
}

TEST_CASE("64 avatars stepped by 8 threads have the bits of one thread", "[determinism]") {
    const std::vector<Matrix3X<double>> alone = crowd_positions(64, 5, 1);
    for (size_t i = 0; i < alone.size(); ++i) {
        REQUIRE(alone[i].cols() > 0);
        REQUIRE((i < 40 || alone[i] == alone[i - 40]));  // the swing has 40 steps
        REQUIRE((i == 0 || alone[i] != alone[i - 1]));
    }
    CHECK(crowd_positions(64, 5, 8) == alone);
    const ThreadExecutor shared(2);
    CHECK(crowd_positions(64, 5, 8, shared) == alone);
}
