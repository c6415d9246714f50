// SPDX-License-Identifier: MIT
/// @file
/// What the network of an animation model is given: the pose, then the shape.
///
/// What        network_input_into() of one pose; network_inputs() of several, as typical inputs of QuantizedMlp for one
/// Shapes      pose features (pose_features.hpp), then the coefficients of the model's shape space, if it sees shapes;
///             several inputs one a column
/// Refuses     coefficients of another number (InvalidInput); what pose_features_into() refuses
/// Source      Nolte et al. 2026, sec. 4.4
/// Tests       tests/unit/ndg/network_input_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/ndg/neural_model.hpp>
#include <softtissue/ndg/pose_features.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>
#include <softtissue/skinning/pose.hpp>

#include <span>

namespace softtissue {

/// The shape's coefficients, none if the model does not see shapes; rest positions 3 x mesh vertices.
template <RealScalar N, RealScalar S>
VectorX<N> shape_input(const NeuralModel<N>& model, const Matrix3X<S>& rest_positions) {
    if (!model.options.shape_input) {
        return VectorX<N>(0);
    }
    return model.shape_space.encode(rest_positions.template cast<double>()).template cast<N>();
}

template <RealScalar N, RealScalar S>
void network_input_into(const NeuralModel<N>& model, const KinematicTree& tree, const Pose<S>& pose,
                        ConstRef<VectorX<N>> shape, Eigen::Ref<VectorX<N>> input) {
    require(shape.size() == model.num_shape_inputs() && input.size() == num_pose_features(tree) + shape.size(),
            "network input: ", shape.size(), " numbers of the shape and room for ", input.size(), ", expected ",
            model.num_shape_inputs(), " and ", num_pose_features(tree) + model.num_shape_inputs());
    pose_features_into<N>(tree, pose, input.head(num_pose_features(tree)));
    input.tail(shape.size()) = shape;
}

/// Of several poses of one shape.
template <RealScalar N, RealScalar S>
MatrixX<N> network_inputs(const NeuralModel<N>& model, const KinematicTree& tree, std::span<const Pose<S>> poses,
                          ConstRef<VectorX<N>> shape) {
    MatrixX<N> inputs(num_pose_features(tree) + shape.size(), Index(poses.size()));
    for (Index k = 0; k < inputs.cols(); ++k) {
        network_input_into<N, S>(model, tree, poses[size_t(k)], shape, inputs.col(k));
    }
    return inputs;
}

}  // namespace softtissue
