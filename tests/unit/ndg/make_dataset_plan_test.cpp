// SPDX-License-Identifier: MIT
#include <softtissue/ndg/make_dataset_plan.hpp>

#include <softtissue/core/thread_executor.hpp>

#include <support/limb_dataset.hpp>

#include <doctest/doctest.h>

#include <map>
#include <set>

using namespace softtissue;
using namespace softtissue_test;

namespace {

std::map<DatasetSplit, Index> counts(const auto& list) {
    std::map<DatasetSplit, Index> result;
    for (const auto& entry : list) {
        ++result[entry.split];
    }
    return result;
}

bool same(const DatasetPlan& a, const DatasetPlan& b) {
    bool equal = a.clips == b.clips && a.bodies.size() == b.bodies.size() && a.poses.size() == b.poses.size() &&
                 a.samples.size() == b.samples.size();
    for (size_t i = 0; equal && i < a.bodies.size(); ++i) {
        equal = a.bodies[i].betas == b.bodies[i].betas && a.bodies[i].split == b.bodies[i].split;
    }
    for (size_t i = 0; equal && i < a.poses.size(); ++i) {
        equal = a.poses[i].pose.rotation_vectors == b.poses[i].pose.rotation_vectors &&
                a.poses[i].source == b.poses[i].source;
    }
    for (size_t i = 0; equal && i < a.samples.size(); ++i) {
        equal = a.samples[i].body == b.samples[i].body && a.samples[i].pose == b.samples[i].pose;
    }
    return equal;
}

}  // namespace

TEST_CASE("a plan has the counts asked for, and no body or pose in two splits") {
    DatasetOptions options = limb_options();
    options.samples = 100;
    options.bodies = 20;
    options.poses = 50;
    const DatasetPlan plan = limb_plan(options);
    using enum DatasetSplit;
    CHECK(counts(plan.samples) ==
          std::map<DatasetSplit, Index>{{train, 80}, {validation, 10}, {test, 10}, {outlier, 4}});
    CHECK(counts(plan.bodies) == std::map<DatasetSplit, Index>{{train, 16}, {validation, 2}, {test, 2}, {outlier, 2}});
    CHECK(counts(plan.poses) == std::map<DatasetSplit, Index>{{train, 40}, {validation, 5}, {test, 5}});

    std::set<std::pair<std::int32_t, std::int32_t>> pairs;
    std::map<std::int32_t, int> uses_of_pose, uses_of_body;
    for (size_t i = 0; i < plan.samples.size(); ++i) {
        const PlannedSample& sample = plan.samples[i];
        CHECK(plan.bodies[size_t(sample.body)].split == sample.split);
        CHECK(plan.poses[size_t(sample.pose)].split == (sample.split == outlier ? test : sample.split));
        CHECK(pairs.insert({sample.body, sample.pose}).second);
        ++uses_of_body[sample.body];
        uses_of_pose[sample.pose] += sample.split == train ? 1 : 0;
        CHECK((i == 0 || plan.samples[i - 1].body <= sample.body));
    }
    CHECK(uses_of_body.size() == plan.bodies.size());
    for (const auto& [pose, uses] : uses_of_pose) {
        CHECK(uses == (plan.poses[size_t(pose)].split == train ? 2 : 0));
    }
    // The splits are mixed, so that the first part of the samples is a data set.
    CHECK(counts(std::vector<PlannedSample>(plan.samples.begin(), plan.samples.begin() + 60)).size() >= 3);
}

TEST_CASE("poses come from their split's block of time, without root, and shapes from their range") {
    const DatasetOptions options = limb_options();
    const DatasetPlan plan = limb_plan(options);
    Index held_out = 0;
    std::map<double, int> noise;
    for (const PlannedPose& pose : plan.poses) {
        CHECK(pose.pose.rotation_vectors.col(0).isZero(0));
        CHECK(pose.pose.translation.isZero(0));
        ++noise[pose.noise];
        if (pose.noise == 0.0) {
            const Pose<double> frame = limb_clips()[size_t(pose.source[0])].motion.poses[size_t(pose.source[1])];
            CHECK(pose.pose.rotation_vectors.col(1) == frame.rotation_vectors.col(1));
        }
        for (const size_t from : {0U, 2U}) {
            const std::int32_t frame = pose.source[from + 1];
            if (pose.source[from] == 1) {
                CHECK(pose.split == DatasetSplit::test);
                held_out += from == 0 ? 1 : 0;
            } else if (pose.split == DatasetSplit::train) {
                CHECK((frame >= 0 && frame < 45));  // 48 less a gap of 3
            } else if (pose.split == DatasetSplit::validation) {
                CHECK((frame >= 48 && frame < 51));
            } else {
                CHECK((frame >= 54 && frame < 60));
            }
        }
    }
    CHECK(held_out >= 1);
    CHECK(noise.size() == 3);
    for (const PlannedBody& body : plan.bodies) {
        CHECK(body.betas.size() == 2);
        CHECK(body.betas.cwiseAbs().maxCoeff() <=
              (body.split == DatasetSplit::outlier ? options.outlier_limit : options.shape_limit));
    }
}

TEST_CASE("legs are those of another frame in the share asked for") {
    DatasetOptions options = limb_options();
    options.leg_joints = {1};
    options.noise = {0.0};
    options.mixed_share = 1.0;
    for (const PlannedPose& pose : limb_plan(options).poses) {
        const Pose<double> legs = limb_clips()[size_t(pose.source[2])].motion.poses[size_t(pose.source[3])];
        CHECK(pose.pose.rotation_vectors.col(1) == legs.rotation_vectors.col(1));
    }
    options.mixed_share = 0.0;
    for (const PlannedPose& pose : limb_plan(options).poses) {
        CHECK(pose.source[1] == pose.source[3]);
    }
}

TEST_CASE("equal seeds give equal plans for any number of threads, others give others") {
    const DatasetPlan plan = limb_plan();
    CHECK(same(plan, make_dataset_plan(limb_clips(), 2, limb_options(), ThreadExecutor(3))));
    DatasetOptions options = limb_options();
    options.seed = 2;
    CHECK(!same(plan, limb_plan(options)));
}

TEST_CASE("plans that cannot be are refused") {
    const auto refused = [](auto change) {
        DatasetOptions options = limb_options();
        change(options);
        CHECK_THROWS_AS(static_cast<void>(limb_plan(options)), InvalidInput);
    };
    refused([](DatasetOptions& o) { o.samples = 4; });
    refused([](DatasetOptions& o) { o.bodies = 4; });
    refused([](DatasetOptions& o) { o.bodies = 21; });
    refused([](DatasetOptions& o) { o.outlier_bodies = 0; });
    refused([](DatasetOptions& o) { o.noise.clear(); });
    refused([](DatasetOptions& o) { o.candidates_per_pose = 0; });
    refused([](DatasetOptions& o) { o.samples = 1000, o.poses = 5; });  // more than pairs
    refused([](DatasetOptions& o) { o.gap = 1.0; });                    // no frame is left for validation
    CHECK_THROWS_AS(static_cast<void>(make_dataset_plan({}, 2, limb_options())), InvalidInput);
}
