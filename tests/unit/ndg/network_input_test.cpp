// SPDX-License-Identifier: MIT
#include <softtissue/ndg/network_input.hpp>

#include <support/limb_model.hpp>
#include <support/refusal.hpp>

#include <doctest/doctest.h>

#include <vector>

using namespace softtissue;
using namespace softtissue_test;

namespace {

std::vector<Pose<double>> bent_poses() {
    std::vector<Pose<double>> poses(3, Pose<double>::rest(2));
    poses[1].rotation_vectors.col(1) << 0.2, -0.1, 0.9;
    poses[2].rotation_vectors.col(1) << 0.0, 0.4, -0.3;
    return poses;
}

}  // namespace

TEST_CASE("an input is the pose's features, then the shape's coefficients") {
    const NeuralModel<float> model = random_limb_model<float>({}, 1.0);
    const Matrix3X<double> rest = LayeredLimb<double>().body.mesh.rest_positions;
    const VectorX<float> shape = shape_input(model, rest);
    CHECK(shape == model.shape_space.encode(rest).cast<float>());
    const auto poses = bent_poses();
    const MatrixX<float> inputs = network_inputs<float, double>(model, two_joint_tree(), poses, shape);
    CHECK(inputs.cols() == 3);
    for (Index k = 0; k < 3; ++k) {
        VectorX<float> features(9);
        pose_features_into<float>(two_joint_tree(), poses[size_t(k)], features);
        CHECK(inputs.col(k).head(9) == features);
        CHECK(inputs.col(k).tail(2) == shape);
    }
}

TEST_CASE("a model that does not see shapes has no coefficients, and others are refused") {
    const NeuralModel<float> model = random_limb_model<float>({.shape_input = false}, 1.0);
    CHECK(shape_input(model, LayeredLimb<double>().body.mesh.rest_positions).size() == 0);
    VectorX<float> input(9);
    const Pose<double> pose = bent_poses()[1];
    network_input_into<float, double>(model, two_joint_tree(), pose, VectorX<float>(0), input);
    CHECK(refusal([&] {
              network_input_into<float, double>(model, two_joint_tree(), pose, VectorX<float>::Zero(2), input);
          }) == "network input: 2 numbers of the shape and room for 9, expected 0 and 9");
}
