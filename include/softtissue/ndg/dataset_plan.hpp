// SPDX-License-Identifier: MIT
/// @file
/// Which bodies take which poses: the list of all samples of a data set, and the options that decide about it.
///
/// What        DatasetPlan as make_dataset_plan() returns it: bodies (shape coefficients), poses, and the pairs of both that
///             are samples, ascending in body.
/// Splits      train, validation, test; outlier: shapes far outside those, in the poses of the test. No body, and no pose
///             except the outliers', belongs to two splits.
/// Units       rad, s; shape coefficients in standard deviations
/// Source      Nolte et al. 2026, sec. 4.1, 5.2.1
/// Tests       tests/unit/ndg/dataset_plan_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/skinning/motion.hpp>
#include <softtissue/skinning/pose.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace softtissue {

enum class DatasetSplit : std::uint8_t { train, validation, test, outlier };

inline constexpr std::array all_dataset_splits{DatasetSplit::train, DatasetSplit::validation, DatasetSplit::test,
                                               DatasetSplit::outlier};

/// The split's name, as in the enumeration.
constexpr const char* to_string(DatasetSplit split) {
    switch (split) {
        case DatasetSplit::train:
            return "train";
        case DatasetSplit::validation:
            return "validation";
        case DatasetSplit::test:
            return "test";
        case DatasetSplit::outlier:
            return "outlier";
    }
    return "unknown";
}

struct DatasetOptions {
    std::uint64_t seed = 1;
    Index samples = 600;  ///< of train, validation and test together, 80, 10 and 10 %; so bodies and poses
    Index bodies = 150;
    Index poses = 0;  ///< 0: one for each sample
    Index outlier_samples = 30;
    Index outlier_bodies = 15;
    double shape_deviation = 0.8;
    double shape_limit = 1.6;
    double outlier_deviation = 2.0;
    double outlier_limit = 3.0;
    std::vector<double> noise = {0.0, 0.05, 0.12};  ///< [rad]
    double mixed_share = 0.5;                       ///< of the candidates, with another frame's legs
    std::vector<std::int32_t> leg_joints = {1, 2, 4, 5, 7, 8, 10, 11};  ///< SMPL's hips, knees, ankles and feet
    Index candidates_per_pose = 4;
    double gap = 0.1;  ///< between blocks of time [s]
};

struct DatasetClip {
    std::string name;
    Motion<double> motion;
    bool held_out = false;  ///< for the test alone
};

struct PlannedBody {
    DatasetSplit split;
    VectorX<double> betas;
};

struct PlannedPose {
    DatasetSplit split;
    Pose<double> pose;
    std::array<std::int32_t, 4> source;  ///< clip, frame, and those of the legs
    double noise;
};

struct PlannedSample {
    DatasetSplit split;
    std::int32_t body;
    std::int32_t pose;
};

struct DatasetPlan {
    std::vector<std::string> clips;
    std::vector<PlannedBody> bodies;
    std::vector<PlannedPose> poses;
    std::vector<PlannedSample> samples;  // ascending in body

    Index num_samples() const { return Index(samples.size()); }
    Index num_bodies() const { return Index(bodies.size()); }

    /// The samples of a body: first, and one past the last.
    std::pair<Index, Index> samples_of(Index body) const {
        const auto before = [](const PlannedSample& sample, Index b) { return sample.body < b; };
        const auto first = std::lower_bound(samples.begin(), samples.end(), body, before);
        const auto last = std::lower_bound(first, samples.end(), body + 1, before);
        return {first - samples.begin(), last - samples.begin()};
    }
};

}  // namespace softtissue
