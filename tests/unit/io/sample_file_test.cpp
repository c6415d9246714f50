// SPDX-License-Identifier: MIT
#include <softtissue/io/sample_file.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;
using namespace io_test;

namespace {

DatasetSample some_sample() {
    DatasetSample sample;
    sample.sample = 123;
    sample.split = DatasetSplit::test;
    sample.body = 7;
    sample.pose_index = 45;
    sample.pose = Pose<double>::rest(2);
    sample.pose.rotation_vectors << 0, 0.1, 0, 0.2, 0, -0.3;
    sample.betas.resize(3);
    sample.betas << 1, -0.5, 1.0 / 3;
    sample.positions.resize(3, 4);
    sample.positions << 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 1e-17;
    sample.status = "converged";
    sample.iterations = 9;
    sample.filtered_iterations = 3;
    sample.num_inverted = 1;
    sample.energy = 23.6;
    sample.rest_energy = 17.5;
    sample.decrement = 2e-4;
    return sample;
}

}  // namespace

TEST_CASE("a sample comes back as it was written, and the same bytes at every writing") {
    const TemporaryFolder folder;
    const DatasetSample sample = some_sample();
    write_sample(folder / "a.npz", sample);
    write_sample(folder / "b.npz", sample);
    CHECK(read_bytes(folder / "a.npz") == read_bytes(folder / "b.npz"));
    const DatasetSample read = read_sample(folder / "a.npz");
    CHECK(read.sample == 123);
    CHECK(read.split == DatasetSplit::test);
    CHECK(read.body == 7);
    CHECK(read.pose_index == 45);
    CHECK(read.pose.rotation_vectors == sample.pose.rotation_vectors);
    CHECK(read.pose.translation.isZero(0));
    CHECK(read.betas == sample.betas);
    CHECK(read.positions == sample.positions);
    CHECK(read.status == "converged");
    CHECK(read.iterations == 9);
    CHECK(read.filtered_iterations == 3);
    CHECK(read.num_inverted == 1);
    CHECK(read.energy == 23.6);
    CHECK(read.rest_energy == 17.5);
    CHECK(read.decrement == 2e-4);
}

TEST_CASE("what is no sample is refused, with the file's name") {
    const TemporaryFolder folder;
    const auto refused = [&](const char* name, const NpyArray& replacement) {
        write_sample(folder / "a.npz", some_sample());
        NpyArrays arrays = read_npz(folder / "a.npz").arrays();
        arrays[name] = replacement;
        write_npz(folder / "bad.npz", arrays);
        const std::string text = refusal([&] { static_cast<void>(read_sample(folder / "bad.npz")); });
        INFO(name);
        CHECK(text.find((folder / "bad.npz").string()) == 0);
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    refused("split", NpyArray::from_scalar(std::int32_t(4)));
    refused("positions", NpyArray::from_columns(Matrix3X<double>::Constant(3, 4, nan).eval()));
    refused("pose", NpyArray::from_columns(Matrix3X<double>::Constant(3, 2, nan).eval()));
    refused("pose", NpyArray::from_columns(MatrixX<double>::Zero(4, 2).eval()));
    refused("betas", NpyArray::from_scalar(1.0));
    refused("status", NpyArray::from_scalar(1.0));
}
