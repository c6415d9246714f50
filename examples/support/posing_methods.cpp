// SPDX-License-Identifier: MIT
#include "posing_methods.hpp"

#include "progress.hpp"

#include <algorithm>

namespace examples {

AnimationMethod method_of(const std::string& name) {
    return *std::find_if(all_animation_methods.begin(), all_animation_methods.end(),
                         [&](AnimationMethod method) { return name == to_string(method); });
}

Poisson make_poisson(const LayeredBody<Scalar>& body) {
    return Poisson(body.mesh, PrescribedVertices(body.mesh.num_vertices(), body.prescribed));
}

PosingMethods::PosingMethods(const LayeredBody<Scalar>& body, const FleshParameters<Scalar>& flesh, int threads)
    : executor_(threads),
      animation_(std::make_unique<LayeredAnimation<Scalar, ThreadExecutor, DirectCholesky>>(body, flesh, executor_)) {}

PosingMethods::~PosingMethods() = default;

Poisson& PosingMethods::poisson() {
    return animation_->poisson();
}

SolveReport<Scalar> PosingMethods::pose_into(AnimationMethod method, JointTransforms transforms, Matrix3X<Scalar>& x) {
    return animation_->pose_into(method, transforms, x, quasi_static_options<Scalar>(),
                                 [](const NewtonProgress<Scalar>&) { return !is_interrupted(); });
}

Scalar PosingMethods::start_dependence(JointTransforms transforms, const Matrix3X<Scalar>& x) {
    return animation_->start_dependence(transforms, x);
}

PosingNetwork::PosingNetwork(const NeuralModel<float>& model, const LayeredBody<Scalar>& body,
                             const KinematicTree& tree, const std::vector<std::string>& joint_names, Poisson& poisson,
                             int threads, const QuantizedMlp<float>* small)
    : executor_(threads),
      animation_(std::make_unique<NeuralAnimation<Scalar, ThreadExecutor>>(model, body, tree, joint_names, poisson,
                                                                           executor_, small)) {}

PosingNetwork::~PosingNetwork() = default;

void PosingNetwork::pose_into(const Pose<Scalar>& pose, JointTransforms transforms, Matrix3X<Scalar>& x) {
    animation_->pose_into(pose, transforms, x);
}

float PosingNetwork::smallest_determinant() const {
    return animation_->smallest_determinant();
}

}  // namespace examples
