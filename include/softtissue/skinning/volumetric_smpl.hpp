// SPDX-License-Identifier: MIT
/// @file
/// The SMPL function on any set of vertices: a skin, or a volume it was carried into.
///
/// What        shaped rest vertices and joints, pose blend shapes, posed body with per-vertex transforms.
/// Equation    x(beta) = T + S beta,  c(beta) = regressor (T + S beta)_surface,  delta(theta) = P vec(R_j - I),
///             p_i = A_i (x_i + delta_i) + t_i with (A_i, t_i) = the policy's blend of the joint transforms
/// Shapes      vertices 3 x n [m]; joints 3 x num_joints [m]; beta up to num_shapes entries [standard deviations];
///             pose blend shapes see skinning/smpl_body.hpp.
/// Refuses     a body that SmplBody::validate refuses, more shape coefficients than directions, a coefficient or pose that is
///             not finite, a pose of another skeleton, what SurfaceCarrier refuses (InvalidInput).
/// Source      Romero et al. 2020, eq. (1)-(2), sec. 3.4; Loper et al. 2015 (SMPL)
/// Departs     joints are always regressed from the surface, also for a volume
/// Cost        per pose and vertex: its entries of P, the policy's blend, one 3x3 product with a vector
/// Tests       tests/unit/skinning/volumetric_smpl_test.cpp
#pragma once

#include <softtissue/skinning/concepts.hpp>

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/skinning/joint_transforms.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/skinning/pose_blend_shapes.hpp>
#include <softtissue/skinning/posed_body.hpp>
#include <softtissue/skinning/smpl_body.hpp>
#include <softtissue/skinning/surface_carrier.hpp>

#include <cmath>
#include <concepts>
#include <span>
#include <utility>

namespace softtissue {

struct VolumetricSmplOptions {
    bool pose_correctives = true;  ///< false: plain skinning of the shaped rest vertices
};

template <RealScalar S, SkinningPolicy Policy = LinearBlend<S>>
class VolumetricSmpl {
public:
    using Scalar = S;
    using SparseMatrix = typename SmplBody<S>::SparseMatrix;
    static_assert(std::same_as<typename Policy::Scalar, S>,
                  "the skinning policy must have the scalar of the body (VolumetricSmpl<float, LinearBlend<float>>)");

    /// The skin itself, at the mean shape.
    explicit VolumetricSmpl(const SmplBody<S>& body, Policy policy = {}, VolumetricSmplOptions options = {})
        : tree_(body.tree),
          policy_(std::move(policy)),
          options_(options),
          template_(body.template_vertices),
          weights_(body.weights),
          shape_directions_(body.shape_directions),
          pose_directions_(body.pose_directions) {
        body.validate("VolumetricSmpl");
        pose_blend_shapes_ = PoseBlendShapes<S>(pose_directions_);
        joint_template_ = regressed(body.joint_regressor, template_);
        joint_directions_.resize(3 * num_joints(), num_shapes());
        for (Index s = 0; s < num_shapes(); ++s) {
            const Eigen::Map<const Matrix3X<S>> direction(shape_directions_.col(s).data(), 3, num_vertices());
            Eigen::Map<Matrix3X<S>>(joint_directions_.col(s).data(), 3, num_joints()) =
                regressed(body.joint_regressor, direction);
        }
        set_shape(VectorX<S>::Zero(num_shapes()));
    }

    Index num_vertices() const { return template_.cols(); }
    Index num_joints() const { return tree_.num_joints(); }
    Index num_shapes() const { return shape_directions_.cols(); }
    const KinematicTree& tree() const { return tree_; }
    const Policy& policy() const { return policy_; }
    const SkinningWeights<S>& weights() const { return weights_; }
    const Matrix3X<S>& template_vertices() const { return template_; }
    const SparseMatrix& pose_directions() const { return pose_directions_; }
    const PoseBlendShapes<S>& pose_blend_shapes() const { return pose_blend_shapes_; }

    /// Shaped rest vertices T + S beta.
    Matrix3X<S> rest_shape(const VectorX<S>& betas) const { return shaped(template_, shape_directions_, betas); }

    /// Shaped rest joints, regressed from the surface.
    Matrix3X<S> joints(const VectorX<S>& betas) const { return shaped(joint_template_, joint_directions_, betas); }

    /// Fixes the shape that pose() works on; missing coefficients are zero.
    void set_shape(const VectorX<S>& betas) {
        rest_vertices_ = rest_shape(betas);
        rest_joints_ = joints(betas);
        shape_ = betas;
    }
    const VectorX<S>& shape() const { return shape_; }
    const Matrix3X<S>& rest_vertices() const { return rest_vertices_; }
    const Matrix3X<S>& rest_joints() const { return rest_joints_; }

    /// Pose blend shapes delta(theta), 3 x n [m], whether or not pose() uses them.
    Matrix3X<S> pose_offsets(const Pose<S>& pose) const {
        require_pose(pose);
        VectorX<S> features(9 * (num_joints() - 1));
        pose_features_into(pose, features);
        Matrix3X<S> offsets(3, num_vertices());
        for (Index v = 0; v < num_vertices(); ++v) {
            offsets.col(v) = pose_blend_shapes_.offset(v, features);
        }
        return offsets;
    }

    /// The body in a pose.
    PosedBody<S> pose(const Pose<S>& pose) const {
        PosedBody<S> result;
        pose_into(pose, result);
        return result;
    }

    /// The body in a pose, into a result of an earlier call: then it allocates nothing. Same bits for every executor.
    template <Executor Exec = SequentialExecutor>
    void pose_into(const Pose<S>& pose, PosedBody<S>& result, const Exec& executor = {}) const {
        require_pose(pose);
        result.resize(num_vertices(), num_joints());
        joint_transforms_into<S>(tree_, rest_joints_, pose, result.joint_transforms);
        policy_.prepare_into(result.joint_transforms, result.prepared_joints);
        pose_features_into(pose, result.pose_features);
        executor.for_each_range(num_vertices(), [&](Index begin, Index end) {
            for (Index v = begin; v < end; ++v) {
                Vector3<S> offset = Vector3<S>::Zero();
                if (options_.pose_correctives) {
                    offset = pose_blend_shapes_.offset(v, result.pose_features);
                }
                AffineTransform<S>& T = result.transforms[size_t(v)];
                T = policy_.blend(result.prepared_joints, weights_.row(v));
                result.offsets.col(v) = offset;
                result.positions.col(v) = T(rest_vertices_.col(v) + offset);
            }
        });
    }

    /// This model on the vertices of a volume that share `matches` with the surface. Matched vertices take the
    /// surface's shape and pose blend shapes and weights exactly; the others what `interpolate` makes of the
    /// matched rows (in the order of `matches`). `volume_vertices` are given at the current shape().
    template <FieldInterpolator<S> Interpolator>
    VolumetricSmpl carried_into(ConstRef<Matrix3X<S>> volume_vertices, std::span<const VertexMatch> matches,
                                const Interpolator& interpolate, CarryOptions<S> options = {}) const {
        const SurfaceCarrier<S, Interpolator> carrier(num_vertices(), volume_vertices.cols(), matches, interpolate,
                                                      options);
        VolumetricSmpl result(*this);
        result.weights_ = carrier.weights(weights_);
        result.shape_directions_ = carrier.shape_directions(shape_directions_);
        result.pose_directions_ = carrier.pose_directions(pose_directions_);
        result.pose_blend_shapes_ = PoseBlendShapes<S>(result.pose_directions_);
        const Matrix3X<S> origin = Matrix3X<S>::Zero(3, volume_vertices.cols());
        result.template_ = volume_vertices - shaped(origin, result.shape_directions_, shape_);
        result.rest_vertices_ = volume_vertices;
        return result;
    }

    /// The same in another precision and at the same shape, blended by `policy` there: what was built in double runs in float.
    template <RealScalar To, SkinningPolicy ToPolicy = LinearBlend<To>>
    VolumetricSmpl<To, ToPolicy> cast(ToPolicy policy = {}) const {
        VolumetricSmpl<To, ToPolicy> result(tree_, std::move(policy), options_);
        result.template_ = template_.template cast<To>();
        result.weights_ = SkinningWeights<To>(weights_.dense().template cast<To>().eval());
        result.shape_directions_ = shape_directions_.template cast<To>();
        result.pose_directions_ = pose_directions_.template cast<To>();
        result.pose_blend_shapes_ = PoseBlendShapes<To>(result.pose_directions_);
        result.joint_template_ = joint_template_.template cast<To>();
        result.joint_directions_ = joint_directions_.template cast<To>();
        result.shape_ = shape_.template cast<To>();
        result.rest_vertices_ = rest_vertices_.template cast<To>();
        result.rest_joints_ = rest_joints_.template cast<To>();
        return result;
    }

private:
    template <RealScalar, SkinningPolicy>
    friend class VolumetricSmpl;

    VolumetricSmpl(const KinematicTree& tree, Policy policy, VolumetricSmplOptions options)
        : tree_(tree), policy_(std::move(policy)), options_(options) {}

    /// One column per joint: the regressor's combination of the columns of `vertices`.
    static Matrix3X<S> regressed(const SparseMatrix& regressor, ConstRef<Matrix3X<S>> vertices) {
        Matrix3X<S> joints = Matrix3X<S>::Zero(3, regressor.rows());
        for (Index j = 0; j < regressor.rows(); ++j) {
            for (typename SparseMatrix::InnerIterator entry(regressor, j); entry; ++entry) {
                joints.col(j) += entry.value() * vertices.col(entry.col());
            }
        }
        return joints;
    }

    static Matrix3X<S> shaped(const Matrix3X<S>& mean, const MatrixX<S>& directions, const VectorX<S>& betas) {
        require(betas.size() <= directions.cols(), "shape has ", betas.size(), " coefficients, expected at most ",
                directions.cols());
        Matrix3X<S> result = mean;
        for (Index s = 0; s < betas.size(); ++s) {
            require(std::isfinite(betas(s)), "shape: coefficient ", s, " = ", betas(s), ", expected a finite value");
            result += betas(s) * Eigen::Map<const Matrix3X<S>>(directions.col(s).data(), 3, mean.cols());
        }
        require(result.allFinite(), "shape: the coefficients move vertices out of the range of the numbers");
        return result;
    }

    void require_pose(const Pose<S>& pose) const {
        pose.require_finite("pose");
        require(pose.rotation_vectors.cols() == num_joints(), "pose has ", pose.rotation_vectors.cols(),
                " joints, expected ", num_joints());
    }

    void pose_features_into(const Pose<S>& pose, VectorX<S>& features) const {
        for (Index j = 1; j < num_joints(); ++j) {
            const Matrix3<S> transposed = local_rotation(pose, j).transpose() - Matrix3<S>::Identity();
            features.template segment<9>(9 * (j - 1)) = vec(transposed);  // row by row: 3 a + b
        }
    }

    KinematicTree tree_;
    Policy policy_;
    VolumetricSmplOptions options_;
    Matrix3X<S> template_;
    SkinningWeights<S> weights_;
    MatrixX<S> shape_directions_;
    SparseMatrix pose_directions_;
    PoseBlendShapes<S> pose_blend_shapes_;  // the same, as pose() reads them
    Matrix3X<S> joint_template_;
    MatrixX<S> joint_directions_;  // 3 joints x shapes
    VectorX<S> shape_;
    Matrix3X<S> rest_vertices_;
    Matrix3X<S> rest_joints_;
};

}  // namespace softtissue
