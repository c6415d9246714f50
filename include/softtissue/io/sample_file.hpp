// SPDX-License-Identifier: MIT
/// @file
/// One sample of a data set in a file (.npz): a pose, and where it takes all vertices of a layered body.
///
/// What        sample, split, body, pose_index (one number each), pose (J, 3), betas (k), positions (V, 3) of the equilibrium,
///             status (text), iterations, filtered_iterations, inverted, energy, rest_energy, decrement.
///             The same sample gives the same bytes.
/// Units       m, rad, J
/// Refuses     what write_npz() and read_npz() refuse, values that are not finite (InvalidInput names file and array)
/// Tests       tests/unit/io/sample_file_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/io/npz.hpp>
#include <softtissue/ndg/dataset_plan.hpp>
#include <softtissue/skinning/pose.hpp>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace softtissue {

/// A sample with all that it depends on, except the rest shape of its body.
struct DatasetSample {
    Index sample = 0;
    DatasetSplit split = DatasetSplit::train;
    Index body = 0;
    Index pose_index = 0;
    Pose<double> pose;
    VectorX<double> betas;
    Matrix3X<double> positions;
    std::string status;
    int iterations = 0;
    int filtered_iterations = 0;
    Index num_inverted = 0;
    double energy = 0.0;
    double rest_energy = 0.0;
    double decrement = 0.0;
};

inline void write_sample(const std::filesystem::path& path, const DatasetSample& sample) {
    const auto number = [](auto value) { return NpyArray::from_scalar(std::int32_t(value)); };
    write_npz(path, {{"sample", number(sample.sample)},
                     {"split", number(sample.split)},
                     {"body", number(sample.body)},
                     {"pose_index", number(sample.pose_index)},
                     {"pose", NpyArray::from_columns(sample.pose.rotation_vectors)},
                     {"betas",
                      NpyArray::from_values(std::span<const double>(sample.betas.data(), size_t(sample.betas.size())),
                                            {sample.betas.size()})},
                     {"positions", NpyArray::from_columns(sample.positions)},
                     {"status", NpyArray::from_strings({sample.status}, {})},
                     {"iterations", number(sample.iterations)},
                     {"filtered_iterations", number(sample.filtered_iterations)},
                     {"inverted", number(sample.num_inverted)},
                     {"energy", NpyArray::from_scalar(sample.energy)},
                     {"rest_energy", NpyArray::from_scalar(sample.rest_energy)},
                     {"decrement", NpyArray::from_scalar(sample.decrement)}});
}

inline DatasetSample read_sample(const std::filesystem::path& path) {
    const NpzFile file = read_npz(path);
    const auto number = [&](const char* name) { return file.at(name).scalar<std::int32_t>(); };
    const auto finite = [&](const char* name, const auto& values) {
        require(values.allFinite(), file.at(name).source(), ": expected finite values");
    };
    DatasetSample sample;
    sample.sample = number("sample");
    const std::int32_t split = number("split");
    require(split >= 0 && split < std::int32_t(all_dataset_splits.size()), file.at("split").source(), ": is ", split,
            ", expected 0 to ", all_dataset_splits.size() - 1);
    sample.split = DatasetSplit(split);
    sample.body = number("body");
    sample.pose_index = number("pose_index");
    sample.pose.rotation_vectors = file.at("pose").columns3<double>();
    finite("pose", sample.pose.rotation_vectors);
    sample.betas = file.at("betas").vector<double>();
    finite("betas", sample.betas);
    sample.positions = file.at("positions").columns3<double>();
    finite("positions", sample.positions);
    const std::vector<std::string> status = file.at("status").strings();
    require(status.size() == 1, file.at("status").source(), ": expected one text");
    sample.status = status.front();
    sample.iterations = number("iterations");
    sample.filtered_iterations = number("filtered_iterations");
    sample.num_inverted = number("inverted");
    sample.energy = file.at("energy").scalar<double>();
    sample.rest_energy = file.at("rest_energy").scalar<double>();
    sample.decrement = file.at("decrement").scalar<double>();
    return sample;
}

}  // namespace softtissue
