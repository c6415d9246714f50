// SPDX-License-Identifier: MIT
#include <softtissue/io/dataset_generation.hpp>

#include "io_test_support.hpp"

#include <support/limb_dataset.hpp>

#include <doctest/doctest.h>

#include <map>

using namespace softtissue;
using namespace softtissue_test;
using namespace io_test;

namespace {

/// The bytes of all files below a folder, by their relative names.
std::map<std::string, std::string> all_files(const std::filesystem::path& path) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path)) {
        if (entry.is_regular_file()) {
            files[std::filesystem::relative(entry.path(), path).string()] = read_bytes(entry.path());
        }
    }
    return files;
}

GenerationProgress run(const std::filesystem::path& path, const GenerationOptions& options = {}, Index limit = -1) {
    const DatasetFolder folder(path);
    return generate_dataset(folder, LimbMaker(), options,
                            [&](const GenerationProgress& progress) { return progress.newly_done != limit; });
}

/// A plan in which one limb is too thin to exist.
DatasetPlan plan_with_failure() {
    DatasetPlan plan = limb_plan();
    for (PlannedBody& body : plan.bodies) {
        body.betas(0) = std::max(body.betas(0), -1.4);
    }
    plan.bodies[4].betas(0) = -1.6;
    return plan;
}

}  // namespace

TEST_CASE("all samples are computed or failed with a reason; the same bytes for any threads, shards and stops") {
    const TemporaryFolder temporary;
    create_limb_dataset(temporary / "whole", plan_with_failure());
    const GenerationProgress progress = run(temporary / "whole");
    CHECK(progress.total == 24);
    CHECK(progress.failed == 2);
    CHECK(progress.finished == 22);
    CHECK(progress.newly_done == 24);
    CHECK(progress.remaining() == 0);
    const DatasetFolder folder(temporary / "whole");
    for (const Index i : folder.failed()) {
        CHECK(folder.plan().samples[size_t(i)].body == 4);
        CHECK(folder.failure(i).find("no layered body: limb: thickness -1.6") == 0);
    }
    for (const DatasetSplit split : all_dataset_splits) {
        for (const Index i : folder.finished(split)) {
            const DatasetSample sample = folder.sample(i);
            CHECK(sample.split == split);
            CHECK(sample.status == "converged");
            CHECK(sample.energy >= sample.rest_energy);
            CHECK(sample.positions.cols() == folder.body(sample.body).layered.mesh.num_vertices());
        }
    }
    const auto whole = all_files(temporary / "whole");
    CHECK(whole.size() == 3 + 11 + 24);

    create_limb_dataset(temporary / "threads", plan_with_failure());
    CHECK(run(temporary / "threads", {.threads = 3}).newly_done == 24);
    CHECK(all_files(temporary / "threads") == whole);

    create_limb_dataset(temporary / "shards", plan_with_failure());
    Index done = 0;
    for (const Index shard : {2, 0, 1}) {
        done += run(temporary / "shards", {.shard = shard, .num_shards = 3}).newly_done;
    }
    CHECK(done == 24);
    CHECK(all_files(temporary / "shards") == whole);

    create_limb_dataset(temporary / "stops", plan_with_failure());
    CHECK(run(temporary / "stops", {}, 3).newly_done == 3);
    const std::filesystem::path stale = temporary / "stops" / "samples" / "000005.npz.part0";
    write_bytes(stale, "half a sample");
    write_bytes(temporary / "stops" / "bodies" / "000001.npz.part1", "half a body");
    CHECK(run(temporary / "stops", {}, 5).newly_done == 5);
    CHECK(!std::filesystem::exists(stale));
    CHECK(run(temporary / "stops").newly_done == 16);
    CHECK(run(temporary / "stops").newly_done == 0);
    CHECK(all_files(temporary / "stops") == whole);
}

TEST_CASE("files that another process is writing are left alone, whatever its shard") {
    const TemporaryFolder temporary;
    create_limb_dataset(temporary / "data");
    const DatasetFolder folder(temporary / "data");
    for (const Index body : {0, 1}) {
        AtomicFile other(folder.body_path(body));
        other.write("a body");
        run(temporary / "data", {.shard = 0, .num_shards = 2}, 1);
        CHECK(std::filesystem::exists(other.temporary_path()));
    }
}

TEST_CASE("shards that do not exist, no thread, and layers with other cells are refused") {
    const TemporaryFolder temporary;
    create_limb_dataset(temporary / "data");
    CHECK_THROWS_AS(run(temporary / "data", {.shard = 2, .num_shards = 2}), InvalidInput);
    CHECK_THROWS_AS(run(temporary / "data", {.shard = -1}), InvalidInput);
    CHECK_THROWS_AS(run(temporary / "data", {.threads = 0}), InvalidInput);
    const auto other_maker = [](const VectorX<double>& betas) {
        ShapedBody<double> limb = LimbMaker()(betas);
        limb.layered.mesh.cells.col(0).swap(limb.layered.mesh.cells.col(1));
        return limb;
    };
    const DatasetFolder folder(temporary / "data");
    const auto go_on = [](const GenerationProgress&) { return true; };
    CHECK_THROWS_AS(static_cast<void>(generate_dataset(folder, other_maker, {.threads = 2}, go_on)), InvalidInput);
}
