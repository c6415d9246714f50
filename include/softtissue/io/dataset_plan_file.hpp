// SPDX-License-Identifier: MIT
/// @file
/// The plan of a data set in a file (.npz).
///
/// What        clips (names); body_split (B), body_betas (B, k); pose_split (P), poses (P, J, 3) [rad], pose_source (P, 4),
///             pose_noise (P) [rad]; sample_split, sample_body, sample_pose (N). The same plan gives the same bytes.
/// Refuses     what write_npz() and read_npz() refuse; arrays that do not fit together (InvalidInput names file and array)
/// Tests       tests/unit/io/dataset_plan_file_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/io/layered_body_file.hpp>
#include <softtissue/io/npz.hpp>
#include <softtissue/ndg/dataset_plan.hpp>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace softtissue {

inline void write_dataset_plan(const std::filesystem::path& path, const DatasetPlan& plan) {
    require(!plan.bodies.empty() && !plan.poses.empty() && !plan.samples.empty(), path.string(), ": the plan is empty");
    MatrixX<double> betas(plan.bodies.front().betas.size(), plan.num_bodies());
    std::vector<std::int32_t> body_split, pose_split, sample_split, sample_body, sample_pose, source;
    for (size_t b = 0; b < plan.bodies.size(); ++b) {
        body_split.push_back(std::int32_t(plan.bodies[b].split));
        betas.col(Index(b)) = plan.bodies[b].betas;
    }
    std::vector<double> rotations, noise;
    for (const PlannedPose& pose : plan.poses) {
        pose_split.push_back(std::int32_t(pose.split));
        source.insert(source.end(), pose.source.begin(), pose.source.end());
        noise.push_back(pose.noise);
        const Matrix3X<double>& vectors = pose.pose.rotation_vectors;
        rotations.insert(rotations.end(), vectors.data(), vectors.data() + vectors.size());
    }
    for (const PlannedSample& sample : plan.samples) {
        sample_split.push_back(std::int32_t(sample.split));
        sample_body.push_back(sample.body);
        sample_pose.push_back(sample.pose);
    }
    const Index num_poses = Index(plan.poses.size());
    write_npz(path, {{"clips", NpyArray::from_strings(plan.clips, {Index(plan.clips.size())})},
                     {"body_split", detail::index_array(body_split)},
                     {"body_betas", NpyArray::from_columns(betas)},
                     {"pose_split", detail::index_array(pose_split)},
                     {"poses", NpyArray::from_values(std::span<const double>(rotations),
                                                     {num_poses, plan.poses.front().pose.rotation_vectors.cols(), 3})},
                     {"pose_source", NpyArray::from_values(std::span<const std::int32_t>(source), {num_poses, 4})},
                     {"pose_noise", NpyArray::from_values(std::span<const double>(noise), {num_poses})},
                     {"sample_split", detail::index_array(sample_split)},
                     {"sample_body", detail::index_array(sample_body)},
                     {"sample_pose", detail::index_array(sample_pose)}});
}

inline DatasetPlan read_dataset_plan(const std::filesystem::path& path) {
    const NpzFile file = read_npz(path);
    const auto splits = [&](const char* name) {
        return detail::read_indices(file.at(name), 0, Index(all_dataset_splits.size()) - 1);
    };
    DatasetPlan plan;
    plan.clips = file.at("clips").strings();
    const MatrixX<double> betas = file.at("body_betas").matrix<double>();
    require(betas.allFinite(), file.at("body_betas").source(), ": expected finite values");
    const std::vector<std::int32_t> body_split = splits("body_split");
    file.at("body_split").require_shape({betas.rows()});
    for (Index b = 0; b < betas.rows(); ++b) {
        plan.bodies.push_back({DatasetSplit(body_split[size_t(b)]), betas.row(b).transpose()});
    }
    file.at("poses").require_shape({NpyArray::any, NpyArray::any, 3});
    const Index num_poses = file.at("poses").shape()[0];
    const Index num_joints = file.at("poses").shape()[1];
    const std::vector<std::int32_t> pose_split = splits("pose_split");
    const std::vector<std::int32_t> source = file.at("pose_source").as<std::int32_t>();
    const std::vector<double> noise = file.at("pose_noise").as<double>();
    file.at("pose_split").require_shape({num_poses});
    file.at("pose_source").require_shape({num_poses, 4});
    file.at("pose_noise").require_shape({num_poses});
    for (Index p = 0; p < num_poses; ++p) {
        const size_t k = size_t(p);
        plan.poses.push_back({DatasetSplit(pose_split[k]),
                              Pose<double>::rest(num_joints),
                              {source[4 * k], source[4 * k + 1], source[4 * k + 2], source[4 * k + 3]},
                              noise[k]});
        require(std::isfinite(noise[k]), file.at("pose_noise").source(), ": element ", p, " is ", noise[k],
                ", expected a finite value");
    }
    file.at("poses").for_each<double>([&](Index i, double value) {
        require(std::isfinite(value), file.at("poses").source(), ": element ", i, " is ", value,
                ", expected a finite value");
        plan.poses[size_t(i / (3 * num_joints))].pose.rotation_vectors.data()[i % (3 * num_joints)] = value;
    });
    const std::vector<std::int32_t> sample_split = splits("sample_split");
    const Index num_samples = Index(sample_split.size());
    file.at("sample_body").require_shape({num_samples});
    file.at("sample_pose").require_shape({num_samples});
    const std::vector<std::int32_t> sample_body = detail::read_indices(file.at("sample_body"), 0, betas.rows() - 1);
    const std::vector<std::int32_t> sample_pose = detail::read_indices(file.at("sample_pose"), 0, num_poses - 1);
    for (size_t i = 0; i < sample_split.size(); ++i) {
        require(i == 0 || sample_body[i - 1] <= sample_body[i], file.at("sample_body").source(), ": element ", i,
                " is ", sample_body[i], ", expected ascending bodies");
        plan.samples.push_back({DatasetSplit(sample_split[i]), sample_body[i], sample_pose[i]});
    }
    return plan;
}

}  // namespace softtissue
