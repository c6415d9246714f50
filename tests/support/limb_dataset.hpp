// SPDX-License-Identifier: MIT
// A data set of limbs: thicker and thinner, longer and shorter ones, bent; each sample takes some milliseconds.
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/io/dataset_folder.hpp>
#include <softtissue/ndg/make_dataset_plan.hpp>
#include <softtissue/ndg/shaped_body.hpp>
#include <support/layered_limb.hpp>

#include <cmath>
#include <filesystem>
#include <vector>

namespace softtissue_test {

/// Two coefficients: thickness and length. There is no limb thinner than -1.5.
struct LimbMaker {
    ShapedBody<double> operator()(const VectorX<double>& betas) const {
        require(betas(0) >= -1.5, "limb: thickness ", betas(0), ", expected >= -1.5");
        ShapedBody<double> limb{LayeredLimb<double>().body, Matrix3X<double>::Zero(3, 2)};
        const double thickness = 1 + 0.1 * betas(0), length = 1 + 0.1 * betas(1);
        limb.layered.mesh.rest_positions.array().colwise() *= Eigen::Array3d(length, thickness, thickness);
        limb.joints(0, 0) = -0.2 * length;
        limb.layered.region.cut_distance = VectorX<double>::Zero(limb.layered.num_columns());
        return limb;
    }
};

inline KinematicTree limb_tree() {
    return KinematicTree({KinematicTree::no_parent, 0});
}

/// Two clips in which the limb bends and twists, 60 frames each at 30 / s.
inline std::vector<DatasetClip> limb_clips() {
    std::vector<DatasetClip> clips{{"bend", {}, false}, {"twist", {}, true}};
    for (size_t c = 0; c < clips.size(); ++c) {
        clips[c].motion.frame_rate = 30;
        for (int frame = 0; frame < 60; ++frame) {
            Pose<double> pose = Pose<double>::rest(2);
            pose.translation << 0.1 * frame, 1, 0;
            pose.rotation_vectors.col(0) << 0, 0.1 * frame, 0;
            pose.rotation_vectors.col(1) << (c == 0 ? 0.0 : 0.4 * std::sin(0.2 * frame)), 0.1 * std::sin(0.7 * frame),
                0.8 * std::sin(0.05 * frame);
            clips[c].motion.poses.push_back(pose);
        }
    }
    return clips;
}

inline DatasetOptions limb_options() {
    DatasetOptions options;
    options.samples = 20;
    options.bodies = 10;
    options.outlier_samples = 4;
    options.outlier_bodies = 2;
    options.leg_joints = {};
    return options;
}

inline DatasetPlan limb_plan(const DatasetOptions& options = limb_options()) {
    return make_dataset_plan(limb_clips(), 2, options);
}

/// A new data set in `path`.
inline void create_limb_dataset(const std::filesystem::path& path, const DatasetPlan& plan = limb_plan()) {
    DatasetFolder::create(path, {{"kind", "limbs"}, {"seed", 1}}, plan,
                          {LimbMaker()(VectorX<double>::Zero(2)), limb_tree(), {"upper", "lower"}});
}

}  // namespace softtissue_test
