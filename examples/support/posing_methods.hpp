// SPDX-License-Identifier: MIT
/// @file
/// Everything that poses a layered body, compiled once for all examples.
#pragma once

#include "direct_cholesky.hpp"
#include "layered_scene.hpp"

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/ndg/layered_animation.hpp>
#include <softtissue/ndg/neural_animation.hpp>
#include <softtissue/nn/quantized_mlp.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace examples {

using JointTransforms = std::span<const AffineTransform<Scalar>>;
using Poisson = PoissonReconstruction<Prism6, Scalar>;

/// The method of that name.
AnimationMethod method_of(const std::string& name);

/// Of the layers, with bone wrap and cuts prescribed.
Poisson make_poisson(const LayeredBody<Scalar>& body);

/// LayeredAnimation with the fastest factorisation. Ctrl-C cancels a solve.
class PosingMethods {
public:
    /// The body must outlive this.
    PosingMethods(const LayeredBody<Scalar>& body, const FleshParameters<Scalar>& flesh, int threads);
    ~PosingMethods();

    Poisson& poisson();
    SolveReport<Scalar> pose_into(AnimationMethod method, JointTransforms transforms, Matrix3X<Scalar>& x);
    Scalar start_dependence(JointTransforms transforms, const Matrix3X<Scalar>& x);

private:
    ThreadExecutor executor_;
    std::unique_ptr<LayeredAnimation<Scalar, ThreadExecutor, DirectCholesky>> animation_;
};

/// NeuralAnimation of a model in single precision.
class PosingNetwork {
public:
    /// Model, body, reconstruction and `small`, the model's network in fewer bytes, if it is there, must outlive this.
    PosingNetwork(const NeuralModel<float>& model, const LayeredBody<Scalar>& body, const KinematicTree& tree,
                  const std::vector<std::string>& joint_names, Poisson& poisson, int threads,
                  const QuantizedMlp<float>* small = nullptr);
    ~PosingNetwork();

    void pose_into(const Pose<Scalar>& pose, JointTransforms transforms, Matrix3X<Scalar>& x);
    float smallest_determinant() const;

private:
    ThreadExecutor executor_;
    std::unique_ptr<NeuralAnimation<Scalar, ThreadExecutor>> animation_;
};

}  // namespace examples
