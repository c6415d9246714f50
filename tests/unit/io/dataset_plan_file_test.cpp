// SPDX-License-Identifier: MIT
#include <softtissue/io/dataset_plan_file.hpp>

#include "io_test_support.hpp"

#include <support/limb_dataset.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <span>
#include <vector>

using namespace softtissue;
using namespace softtissue_test;
using namespace io_test;

TEST_CASE("a plan comes back as it was written") {
    const TemporaryFolder folder;
    const DatasetPlan plan = limb_plan();
    write_dataset_plan(folder / "plan.npz", plan);
    const DatasetPlan read = read_dataset_plan(folder / "plan.npz");
    CHECK(read.clips == plan.clips);
    REQUIRE(read.bodies.size() == plan.bodies.size());
    for (size_t b = 0; b < plan.bodies.size(); ++b) {
        CHECK(read.bodies[b].split == plan.bodies[b].split);
        CHECK(read.bodies[b].betas == plan.bodies[b].betas);
    }
    REQUIRE(read.poses.size() == plan.poses.size());
    for (size_t p = 0; p < plan.poses.size(); ++p) {
        CHECK(read.poses[p].split == plan.poses[p].split);
        CHECK(read.poses[p].pose.rotation_vectors == plan.poses[p].pose.rotation_vectors);
        CHECK(read.poses[p].source == plan.poses[p].source);
        CHECK(read.poses[p].noise == plan.poses[p].noise);
    }
    REQUIRE(read.samples.size() == plan.samples.size());
    for (size_t i = 0; i < plan.samples.size(); ++i) {
        CHECK(read.samples[i].split == plan.samples[i].split);
        CHECK(read.samples[i].body == plan.samples[i].body);
        CHECK(read.samples[i].pose == plan.samples[i].pose);
    }
    write_dataset_plan(folder / "again.npz", read);
    CHECK(read_bytes(folder / "again.npz") == read_bytes(folder / "plan.npz"));
}

TEST_CASE("arrays that do not fit together are refused, and an empty plan") {
    const TemporaryFolder folder;
    const auto refused = [&](const char* name, const NpyArray& replacement) {
        write_dataset_plan(folder / "plan.npz", limb_plan());
        NpyArrays arrays = read_npz(folder / "plan.npz").arrays();
        arrays[name] = replacement;
        write_npz(folder / "bad.npz", arrays);
        const std::string text = refusal([&] { static_cast<void>(read_dataset_plan(folder / "bad.npz")); });
        INFO(name);
        CHECK(text.find((folder / "bad.npz").string()) == 0);
    };
    refused("sample_body", detail::index_array(std::vector<std::int32_t>(24, 12)));
    refused("sample_pose", detail::index_array(std::vector<std::int32_t>(23, 0)));
    refused("sample_split", detail::index_array(std::vector<std::int32_t>(24, 4)));
    refused("body_split", detail::index_array({0}));
    refused("pose_noise", NpyArray::from_scalar(0.0));
    const DatasetPlan plan = limb_plan();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    refused("pose_noise", detail::vector_array<double>(VectorX<double>::Constant(Index(plan.poses.size()), nan)));
    refused("body_betas", NpyArray::from_columns(MatrixX<double>::Constant(2, plan.num_bodies(), nan).eval()));
    const std::vector<double> rotations(6 * plan.poses.size(), nan);
    refused("poses", NpyArray::from_values(std::span<const double>(rotations), {Index(plan.poses.size()), 2, 3}));
    std::vector<std::int32_t> descending(24, 1);
    descending.back() = 0;
    refused("sample_body", detail::index_array(descending));
    CHECK_THROWS_AS(write_dataset_plan(folder / "plan.npz", {}), InvalidInput);
}
