// SPDX-License-Identifier: MIT
/// @file
/// Plans a data set from a seed, before anything is computed.
///
/// What        make_dataset_plan(): bodies, poses and their pairs for train, validation, test and outlier.
/// Poses       A clip is cut into blocks of time, 80 % for training, then 10 % each for validation and test, with a gap
///             between; clips that are held out belong to the test as a whole and make half of it. Candidates are frames of
///             the split's blocks, a part of them with the legs of another frame; farthest_poses() chooses among them, then
///             noise is added, the deviations of the options in turn. The root is not turned and not moved: everything is
///             equivariant.
/// Bodies      coefficients are normal numbers, clipped; bodies are shuffled over the splits
/// Samples     numbered body by body, so that the first part of a data set is a smaller data set. Each pair is unique; the
///             poses of a split are used equally often, as far as that allows.
/// Valid       The same bits for every executor.
/// Refuses     no motion, counts that leave a split without body, pose or frame, too few pairs (InvalidInput)
/// Source      Nolte et al. 2026, sec. 4.1
/// Departs     shapes are drawn from a normal distribution instead of scans; legs are mixed and noise is added, because few
///             clips hold few poses
/// Tests       tests/unit/ndg/make_dataset_plan_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/random.hpp>
#include <softtissue/ndg/dataset_plan.hpp>
#include <softtissue/ndg/pose_sampling.hpp>
#include <softtissue/skinning/pose.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace softtissue {

namespace detail {

/// A frame of a clip.
using ClipFrame = std::array<std::int32_t, 2>;

class DatasetPlanner {
public:
    DatasetPlanner(const std::vector<DatasetClip>& clips, Index num_shapes, const DatasetOptions& options)
        : clips_(clips), num_shapes_(num_shapes), options_(options) {}

    template <Executor E>
    DatasetPlan plan(const E& executor) {
        validate();
        for (const DatasetClip& clip : clips_) {
            plan_.clips.push_back(clip.name);
        }
        const Index poses = options_.poses == 0 ? options_.samples : options_.poses;
        for (int split = 0; split < 3; ++split) {
            add_poses(DatasetSplit(split), count(poses, split), executor);
        }
        add_bodies();
        add_samples();
        return std::move(plan_);
    }

private:
    /// Its own numbers for each purpose.
    RandomGenerator random(std::uint64_t purpose) const { return RandomGenerator(options_.seed + (purpose << 32U)); }

    /// The part of `all` of a split.
    static Index count(Index all, int split) {
        const Index tenth = (all + 5) / 10;
        return split == 0 ? all - 2 * tenth : tenth;
    }

    void validate() const {
        require(!clips_.empty(), "data set: no motion");
        for (const auto& [value, name] :
             {std::pair(options_.samples, "samples"), std::pair(options_.bodies, "bodies"),
              std::pair(options_.poses == 0 ? options_.samples : options_.poses, "poses")}) {
            require(value >= 5, "data set: ", value, " ", name, ", expected at least 5, for three splits");
        }
        require(options_.bodies <= options_.samples, "data set: ", options_.bodies, " bodies for ", options_.samples,
                " samples, expected at most as many");
        require(options_.outlier_samples >= 0 && options_.outlier_bodies >= 0 &&
                    options_.outlier_bodies <= options_.outlier_samples &&
                    (options_.outlier_bodies > 0 || options_.outlier_samples == 0),
                "data set: ", options_.outlier_bodies, " outlier bodies for ", options_.outlier_samples, " samples");
        require(num_shapes_ > 0, "data set: the body has no shapes");
        require(!options_.noise.empty(), "data set: no deviation of noise given, expected at least one (0: none)");
        require(options_.candidates_per_pose >= 1, "data set: ", options_.candidates_per_pose, " candidates per pose");
        const Index joints =
            clips_.front().motion.poses.empty() ? 0 : clips_.front().motion.poses[0].rotation_vectors.cols();
        for (const DatasetClip& clip : clips_) {
            clip.motion.validate(clip.name, joints);
        }
    }

    /// Frames for a split from the clips that are held out or from the others.
    std::vector<ClipFrame> frames(DatasetSplit split, bool held_out) const {
        constexpr std::array<double, 4> cuts{0.0, 0.8, 0.9, 1.0};
        std::vector<ClipFrame> result;
        for (size_t c = 0; c < clips_.size(); ++c) {
            const double length = double(clips_[c].motion.num_frames());
            Index begin = 0, end = clips_[c].motion.num_frames();
            if (!clips_[c].held_out) {
                const double gap = split == DatasetSplit::test ? 0.0 : options_.gap * clips_[c].motion.frame_rate;
                begin = Index(std::floor(cuts[size_t(split)] * length));
                end = Index(std::floor(cuts[size_t(split) + 1] * length - gap));
            }
            for (Index frame = begin; frame < end && clips_[c].held_out == held_out; ++frame) {
                result.push_back({std::int32_t(c), std::int32_t(frame)});
            }
        }
        return result;
    }

    Pose<double> pose_at(const ClipFrame& frame) const {
        Pose<double> pose = clips_[size_t(frame[0])].motion.poses[size_t(frame[1])];
        pose.rotation_vectors.col(0).setZero();
        pose.translation.setZero();
        return pose;
    }

    template <Executor E>
    void add_poses(DatasetSplit split, Index number, const E& executor) {
        const std::vector<ClipFrame> seen = frames(split, false);
        const std::vector<ClipFrame> held_out =
            split == DatasetSplit::test ? frames(split, true) : std::vector<ClipFrame>();
        require(!seen.empty() || !held_out.empty(), "data set: the motions have no frame for the split ",
                to_string(split));
        RandomGenerator numbers = random(1 + std::uint64_t(split));
        const auto draw = [&](const std::vector<ClipFrame>& from) {
            return from[size_t(numbers.index(Index(from.size())))];
        };
        std::vector<PlannedPose> candidates;
        std::vector<Pose<double>> poses;
        for (Index k = 0; k < number * options_.candidates_per_pose; ++k) {
            const bool from_held_out = !held_out.empty() && (seen.empty() || k % 2 == 0);
            const std::vector<ClipFrame>& pool = from_held_out ? held_out : seen;
            const ClipFrame body = draw(pool);
            const ClipFrame legs = numbers.uniform() < options_.mixed_share ? draw(pool) : body;
            poses.push_back(with_joints_of<double>(pose_at(body), pose_at(legs), options_.leg_joints));
            candidates.push_back({split, poses.back(), {body[0], body[1], legs[0], legs[1]}, 0.0});
        }
        std::vector<Index> chosen = farthest_poses<double>(poses, number, executor);
        numbers.shuffle(std::span<Index>(chosen));
        for (size_t k = 0; k < chosen.size(); ++k) {
            PlannedPose& pose = candidates[size_t(chosen[k])];
            pose.noise = options_.noise[k % options_.noise.size()];
            pose.pose = with_noise(std::move(pose.pose), pose.noise, numbers);
            plan_.poses.push_back(std::move(pose));
        }
    }

    void add_bodies() {
        for (const DatasetSplit split : all_dataset_splits) {
            const Index number =
                split == DatasetSplit::outlier ? options_.outlier_bodies : count(options_.bodies, int(split));
            plan_.bodies.insert(plan_.bodies.end(), size_t(number), PlannedBody{split, VectorX<double>()});
        }
        RandomGenerator numbers = random(5);
        numbers.shuffle(std::span<PlannedBody>(plan_.bodies));
        for (PlannedBody& body : plan_.bodies) {
            const bool is_outlier = body.split == DatasetSplit::outlier;
            const double deviation = is_outlier ? options_.outlier_deviation : options_.shape_deviation;
            const double limit = is_outlier ? options_.outlier_limit : options_.shape_limit;
            body.betas.resize(num_shapes_);
            for (double& beta : body.betas) {
                beta = std::clamp(deviation * numbers.normal(), -limit, limit);
            }
        }
    }

    void add_samples() {
        for (const DatasetSplit split : all_dataset_splits) {
            std::vector<std::int32_t> bodies, poses;
            for (size_t b = 0; b < plan_.bodies.size(); ++b) {
                if (plan_.bodies[b].split == split) {
                    bodies.push_back(std::int32_t(b));
                }
            }
            const bool is_outlier = split == DatasetSplit::outlier;
            for (size_t p = 0; p < plan_.poses.size(); ++p) {
                if (plan_.poses[p].split == (is_outlier ? DatasetSplit::test : split)) {
                    poses.push_back(std::int32_t(p));
                }
            }
            const Index number = is_outlier ? options_.outlier_samples : count(options_.samples, int(split));
            require(number <= Index(bodies.size() * poses.size()), "data set: ", number, " samples of the split ",
                    to_string(split), " from ", bodies.size(), " bodies and ", poses.size(),
                    " poses, expected unique pairs");
            pair(split, bodies, poses, number);
        }
        std::stable_sort(plan_.samples.begin(), plan_.samples.end(),
                         [](const PlannedSample& a, const PlannedSample& b) { return a.body < b.body; });
    }

    /// Bodies and poses in turn; where the pair exists already, the next pose that is new to the body.
    void pair(DatasetSplit split, const std::vector<std::int32_t>& bodies, const std::vector<std::int32_t>& poses,
              Index number) {
        std::set<std::array<std::int32_t, 2>> pairs;
        size_t next = 0;
        for (Index k = 0; k < number; ++k) {
            const std::int32_t body = bodies[size_t(k) % bodies.size()];
            while (!pairs.insert({body, poses[next % poses.size()]}).second) {
                ++next;
            }
            plan_.samples.push_back({split, body, poses[next++ % poses.size()]});
        }
    }

    const std::vector<DatasetClip>& clips_;
    Index num_shapes_;
    const DatasetOptions& options_;
    DatasetPlan plan_;
};

}  // namespace detail

/// The plan for bodies of `num_shapes` coefficients; the same bits for every executor.
template <Executor E = SequentialExecutor>
DatasetPlan make_dataset_plan(const std::vector<DatasetClip>& clips, Index num_shapes, const DatasetOptions& options,
                              const E& executor = {}) {
    return detail::DatasetPlanner(clips, num_shapes, options).plan(executor);
}

}  // namespace softtissue
