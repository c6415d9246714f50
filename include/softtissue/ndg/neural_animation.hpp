// SPDX-License-Identifier: MIT
/// @file
/// A trained model on one body: positions of all vertices in a pose, without a simulation.
///
/// What        pose_into(): bone wrap and cuts by linear blend skinning, everything else by the model.
/// Equation    gradient models: Poisson reconstruction with the targets T_p = R_p F_p^res, R_p the blended rotation of the
///             bones (without that option: the root's); vertex models: x_v = LBS(X_v + d_v)
/// Shapes      x 3 x mesh vertices [m]
/// Valid       the root's rotation and the translation carry over exactly; the network does not see them. Poisson
///             reconstruction may still invert cells although no predicted gradient is inverted.
/// Refuses     a body, skeleton or joint order other than the model's; a pose that is not finite; a Poisson reconstruction of
///             another body (InvalidInput)
/// Source      Nolte et al. 2026, sec. 4.2 to 4.4, eq. (21)
/// Weights     those of the model, or in fewer bytes: a QuantizedMlp of its network
/// Cost        gradient models: network, exponentials, two triangular solves, and no allocation after the first pose; vertex
///             models: network and skinning
/// Tests       tests/unit/ndg/neural_animation_test.cpp
#pragma once

#include <softtissue/anatomy/layered_body.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/ndg/body_identity.hpp>
#include <softtissue/ndg/gradient_network.hpp>
#include <softtissue/ndg/network_input.hpp>
#include <softtissue/ndg/neural_model.hpp>
#include <softtissue/ndg/residual_gradients.hpp>
#include <softtissue/ndg/rest_offsets.hpp>
#include <softtissue/ndg/vertex_network.hpp>
#include <softtissue/nn/quantized_mlp.hpp>
#include <softtissue/skinning/affine_transform.hpp>
#include <softtissue/skinning/blended_rotation.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/skinning/pose.hpp>
#include <softtissue/skinning/skin_points.hpp>
#include <softtissue/solver/gradient_skinning.hpp>
#include <softtissue/solver/poisson_reconstruction.hpp>

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace softtissue {

template <RealScalar S, Executor ExecutorType, RealScalar N = float>
class NeuralAnimation {
public:
    using Scalar = S;
    using Transforms = std::span<const AffineTransform<S>>;

    /// Everything but the tree and the names must outlive this; joint names may be empty. `small` takes the place of the
    /// model's network if it is there.
    NeuralAnimation(const NeuralModel<N>& model, const LayeredBody<S>& body, const KinematicTree& tree,
                    const std::vector<std::string>& joint_names, PoissonReconstruction<Prism6, S>& poisson,
                    const ExecutorType& executor, const QuantizedMlp<N>* small = nullptr)
        : model_(&model), body_(&body), tree_(tree), poisson_(&poisson), executor_(&executor) {
        model.validate("neural model '" + model.name + "'");
        model.body.require_same(body_identity(body, tree, joint_names), "neural model '" + model.name + "'");
        require(poisson.num_cells() == body.mesh.num_cells() && poisson.num_vertices() == body.mesh.num_vertices(),
                "neural animation: Poisson reconstruction of ", poisson.num_cells(), " cells, expected ",
                body.mesh.num_cells());
        input_.resize(model.mlp.sizes().inputs);
        shape_ = shape_input(model, body.mesh.rest_positions);
        if (model.options.kind == NetworkKind::vertex) {
            vertices_.emplace(model.mlp, small);
            require(vertices_->num_vertices() == poisson.prescribed().num_free(), "neural model '", model.name,
                    "': offsets of ", vertices_->num_vertices(), " vertices, expected those of ",
                    poisson.prescribed().num_free(), " free ones");
        } else {
            gradients_.emplace(model.mlp, model.options.exponential, small);
            skinning_.emplace(poisson, body.mesh, body.weights);
        }
    }

    NeuralAnimation(const NeuralAnimation&) = delete;
    NeuralAnimation& operator=(const NeuralAnimation&) = delete;

    const NeuralModel<N>& model() const { return *model_; }

    /// Writes all vertices; `joint_transforms` are those of the pose.
    void pose_into(const Pose<S>& pose, Transforms joint_transforms, Matrix3X<S>& x) {
        require(Index(joint_transforms.size()) == tree_.num_joints(), "neural animation: ", joint_transforms.size(),
                " joint transforms, expected ", tree_.num_joints());
        network_input_into<N, S>(*model_, tree_, pose, shape_, input_);
        skin_points_into(LinearBlend<S>(), joint_transforms, body_->weights, body_->mesh.rest_positions,
                         prepared_joints_, x, *executor_);
        if (vertices_) {
            move_by_rest_offsets<N, S>(*body_, poisson_->prescribed(), joint_transforms,
                                       vertices_->predict(input_, *executor_), x, *executor_);
            return;
        }
        if (model_->options.rotation && model_->options.exponential) {
            bone_quaternions_into<S>(joint_transforms, bones_);
            gradients_->template predict_rotated_into<S>(input_, skinning_->blended(), bones_, targets_, *executor_);
        } else {
            const MatrixX<N>& residuals = gradients_->predict(input_, *executor_);
            target_gradients_into<N, S>(residuals, rotations(joint_transforms), targets_, *executor_);
        }
        poisson_->solve_into(targets_, x, *executor_);
    }

    /// F_p^res of the last pose, 9 x cells, 3x3 row after row; gradient models only.
    const MatrixX<N>& residual_gradients() const {
        require(gradients_.has_value(), "neural model '", model_->name, "' predicts offsets, not gradients");
        return gradients_->residuals();
    }

    /// Over the gradients that were predicted for the last pose.
    N smallest_determinant() const {
        require(gradients_.has_value(), "neural model '", model_->name, "' predicts offsets, not gradients");
        return gradients_->smallest_determinant();
    }

private:
    std::span<const Matrix3<S>> rotations(Transforms joint_transforms) {
        if (model_->options.rotation) {
            bone_quaternions_into<S>(joint_transforms, bones_);
            return skinning_->rotations(bones_, *executor_);
        }
        root_rotations_.assign(size_t(body_->mesh.num_cells()), joint_transforms[size_t(tree_.root())].linear);
        return root_rotations_;
    }

    const NeuralModel<N>* model_;
    const LayeredBody<S>* body_;
    KinematicTree tree_;
    PoissonReconstruction<Prism6, S>* poisson_;
    const ExecutorType* executor_;
    std::optional<GradientNetwork<N>> gradients_;
    std::optional<VertexNetwork<N>> vertices_;
    std::optional<GradientSkinning<Prism6, S>> skinning_;
    VectorX<N> shape_, input_;
    MatrixX<S> prepared_joints_;
    std::vector<Quaternion<S>> bones_;
    std::vector<Matrix3<S>> root_rotations_;
    Matrix3X<S> targets_;
};

}  // namespace softtissue
