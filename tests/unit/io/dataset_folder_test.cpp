// SPDX-License-Identifier: MIT
#include <softtissue/io/dataset_folder.hpp>

#include "io_test_support.hpp"

#include <support/limb_dataset.hpp>

#include <doctest/doctest.h>

using namespace softtissue;
using namespace softtissue_test;
using namespace io_test;

namespace {

DatasetSample sample_of(const DatasetFolder& folder, Index index) {
    const PlannedSample& planned = folder.plan().samples[size_t(index)];
    DatasetSample sample;
    sample.sample = index;
    sample.split = planned.split;
    sample.body = planned.body;
    sample.pose_index = planned.pose;
    sample.pose = folder.plan().poses[size_t(planned.pose)].pose;
    sample.betas = folder.plan().bodies[size_t(planned.body)].betas;
    sample.positions = folder.mean_body().mesh.rest_positions;
    sample.status = "converged";
    return sample;
}

}  // namespace

TEST_CASE("a folder gives back plan, bodies, samples and failures") {
    const TemporaryFolder temporary;
    create_limb_dataset(temporary / "data");
    const DatasetFolder folder(temporary / "data");
    CHECK(folder.plan().num_samples() == 24);
    CHECK(folder.tree() == limb_tree());
    CHECK(folder.joint_names() == std::vector<std::string>{"upper", "lower"});
    CHECK(folder.definition()["kind"] == "limbs");
    CHECK(folder.finished(DatasetSplit::train).empty());

    const PlannedSample& first = folder.plan().samples[0];
    folder.write(sample_of(folder, 0));
    CHECK(folder.is_finished(0));
    CHECK(folder.finished(first.split) == std::vector<Index>{0});
    CHECK(folder.sample(0).pose.rotation_vectors == folder.plan().poses[size_t(first.pose)].pose.rotation_vectors);

    const ShapedBody<double> body = LimbMaker()(folder.plan().bodies[0].betas);
    folder.write_body(0, body);
    CHECK(folder.body(0).layered.mesh.rest_positions == body.layered.mesh.rest_positions);

    folder.write_failure(3, {{"reason", "no equilibrium"}});
    CHECK(folder.is_failed(3));
    CHECK(!folder.is_finished(3));
    CHECK(folder.failed() == std::vector<Index>{3});
    CHECK(folder.failure(3) == "no equilibrium");
}

TEST_CASE("a data set that is there is not made again, and not mixed with another") {
    const TemporaryFolder temporary;
    create_limb_dataset(temporary / "data");
    const std::string plan = read_bytes(temporary / "data/plan.npz");
    create_limb_dataset(temporary / "data", {});  // the same definition: nothing is touched
    CHECK(read_bytes(temporary / "data/plan.npz") == plan);
    const SkeletalLayers<double> mean{LimbMaker()(VectorX<double>::Zero(2)), limb_tree(), {"upper", "lower"}};
    const std::string text = refusal([&] {
        DatasetFolder::create(temporary / "data", {{"kind", "limbs"}, {"seed", 2}}, limb_plan(), mean);
    });
    CHECK(contains(text, "data: belongs to another data set: seed is 1, expected 2; choose another folder"));
    CHECK(read_bytes(temporary / "data/plan.npz") == plan);
}

TEST_CASE("a folder without plan, of another definition or format is refused") {
    const TemporaryFolder temporary;
    const auto refused = [&] { return refusal([&] { const DatasetFolder folder(temporary / "data"); }); };
    CHECK(refused().find("no data set") != std::string::npos);
    create_limb_dataset(temporary / "data");
    CHECK(refused().empty());
    const DatasetFolder folder(temporary / "data");
    CHECK_NOTHROW(folder.require_definition({{"kind", "limbs"}, {"seed", 1}}));
    const std::string other = refusal([&] { folder.require_definition({{"kind", "limbs"}, {"seed", 2}}); });
    CHECK(other.find("seed is 1, expected 2") != std::string::npos);
    CHECK(!refusal([&] { folder.require_definition({{"kind", "limbs"}}); }).empty());
    CHECK(!refusal([&] { folder.require_definition({{"kind", "limbs"}, {"seed", 1}, {"more", 0}}); }).empty());

    write_bytes(temporary / "data" / "plan.json", "{\"format\": 2}");
    CHECK(refused().find("format") != std::string::npos);
    write_bytes(temporary / "data" / "plan.json", "{\"for");
    CHECK(refused().find("damaged") != std::string::npos);
    const std::string deep = "{\"format\": " + std::string(100000, '[');
    write_bytes(temporary / "data" / "plan.json", deep + std::string(100000, ']') + "}");
    CHECK(refused().find("nested too deeply") != std::string::npos);
}

TEST_CASE("a sample of another number, body or mesh is refused, and one that is not there") {
    const TemporaryFolder temporary;
    create_limb_dataset(temporary / "data");
    const DatasetFolder folder(temporary / "data");
    const auto refused = [&](const DatasetSample& sample) {
        write_sample(folder.sample_path(0), sample);
        return !refusal([&] { static_cast<void>(folder.sample(0)); }).empty();
    };
    CHECK(!refused(sample_of(folder, 0)));
    CHECK(refused(sample_of(folder, 1)));
    DatasetSample sample = sample_of(folder, 0);
    sample.body = 5;
    CHECK(refused(sample));
    sample = sample_of(folder, 0);
    sample.positions.conservativeResize(3, 299);
    CHECK(refused(sample));
    CHECK_THROWS_AS(static_cast<void>(folder.sample(1)), InvalidInput);
    CHECK_THROWS_AS(static_cast<void>(folder.sample(24)), InvalidInput);
    CHECK_THROWS_AS(static_cast<void>(folder.body(1)), InvalidInput);
    CHECK_THROWS_AS(static_cast<void>(folder.body(12)), InvalidInput);
}
