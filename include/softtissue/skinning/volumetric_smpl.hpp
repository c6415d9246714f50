// SPDX-License-Identifier: MIT
/// @file
/// The SMPL function on any set of vertices: a skin, or a volume it was carried into.
///
/// What        shaped rest vertices and joints, pose blend shapes, posed body with per-vertex transforms.
/// Equation    x(beta) = T + S beta,  c(beta) = regressor (T + S beta)_surface,  delta(theta) = P vec(R_j - I),
///             p_i = A_i (x_i + delta_i) + t_i with (A_i, t_i) = the policy's blend of the joint transforms
/// Shapes      vertices 3 x n [m]; joints 3 x num_joints [m]; beta up to num_shapes entries [standard deviations];
///             pose blend shapes see skinning/smpl_body.hpp.
/// Refuses     a body that SmplBody::validate refuses, more shape coefficients than directions, a pose of another
///             skeleton, vertex matches out of range or twice, interpolated values that are not finite (InvalidInput).
/// Source      Romero et al. 2020, eq. (1)-(2), sec. 3.4; Loper et al. 2015 (SMPL)
/// Departs     joints are always regressed from the surface, also for a volume. Carried weights: cotangent
///             interpolation may give small negative ones; these and those below smallest_weight are dropped and
///             the rest is normalised.
/// Cost        per pose and vertex: its entries of P, the policy's blend, one 3x3 product with a vector
/// Tests       tests/unit/skinning/volumetric_smpl_test.cpp
#pragma once

#include <softtissue/skinning/concepts.hpp>

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/skinning/joint_transforms.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/skinning/posed_body.hpp>
#include <softtissue/skinning/smpl_body.hpp>

#include <concepts>
#include <span>
#include <utility>
#include <vector>

namespace softtissue {

struct VolumetricSmplOptions {
    bool pose_correctives = true;  ///< false: plain skinning of the shaped rest vertices
};

/// A vertex of a volume that is a vertex of the surface.
struct VertexMatch {
    std::int32_t volume;
    std::int32_t surface;
};

/// What carried_into() leaves out of interpolated rows to keep them sparse; zero keeps everything positive.
template <RealScalar S>
struct CarryOptions {
    S smallest_weight = S(1e-4);          ///< weights; a dropped one moves a vertex by at most 1e-4 of the joints' motion
    S smallest_pose_direction = S(1e-6);  ///< [m]; entries of R - I are at most 2
};

/// Extends values known at some vertices (one row each) to all vertices of a volume.
template <class I, class S>
concept FieldInterpolator = requires(const I& interpolate, const MatrixX<S>& known) {
    { interpolate(known) } -> std::convertible_to<MatrixX<S>>;
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
        const SparseMatrix regressor = body.joint_regressor;
        joint_template_ = (regressor * template_.transpose()).transpose();
        joint_directions_.resize(3 * num_joints(), num_shapes());
        for (Index s = 0; s < num_shapes(); ++s) {
            const Eigen::Map<const Matrix3X<S>> direction(shape_directions_.col(s).data(), 3, num_vertices());
            Eigen::Map<Matrix3X<S>>(joint_directions_.col(s).data(), 3, num_joints()) =
                (regressor * direction.transpose()).transpose();
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
            offsets.col(v) = pose_offset(v, features);
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
                    offset = pose_offset(v, result.pose_features);
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
        require_matches(volume_vertices.cols(), matches);
        const Carrier<Interpolator> carrier{volume_vertices.cols(), matches, interpolate};
        VolumetricSmpl result(*this);
        result.weights_ = carried_weights(carrier, options.smallest_weight);
        result.shape_directions_ = carried_shape_directions(carrier);
        result.pose_directions_ = carried_pose_directions(carrier, options.smallest_pose_direction);
        const Matrix3X<S> no_vertices = Matrix3X<S>::Zero(3, volume_vertices.cols());
        result.template_ = volume_vertices - shaped(no_vertices, result.shape_directions_, shape_);
        result.rest_vertices_ = volume_vertices;
        return result;
    }

private:
    template <class Interpolator>
    struct Carrier {
        Index num_vertices;
        std::span<const VertexMatch> matches;
        const Interpolator& interpolate;

        /// Rows of the surface to rows of the volume.
        MatrixX<S> operator()(const MatrixX<S>& surface) const {
            MatrixX<S> known(Index(matches.size()), surface.cols());
            for (size_t m = 0; m < matches.size(); ++m) {
                known.row(Index(m)) = surface.row(matches[m].surface);
            }
            MatrixX<S> result = interpolate(known);
            require(result.rows() == num_vertices && result.cols() == surface.cols(), "carried_into: interpolation is ",
                    result.rows(), " x ", result.cols(), ", expected ", num_vertices, " x ", surface.cols());
            for (Index v = 0; v < result.rows(); ++v) {
                require(result.row(v).allFinite(), "carried_into: interpolation at volume vertex ", v,
                        " is not finite");
            }
            for (const VertexMatch& match : matches) {
                result.row(match.volume) = surface.row(match.surface);
            }
            return result;
        }

        std::vector<bool> is_matched() const {
            std::vector<bool> matched(size_t(num_vertices), false);
            for (const VertexMatch& match : matches) {
                matched[size_t(match.volume)] = true;
            }
            return matched;
        }
    };

    static Matrix3X<S> shaped(const Matrix3X<S>& mean, const MatrixX<S>& directions, const VectorX<S>& betas) {
        require(betas.size() <= directions.cols(), "shape has ", betas.size(), " coefficients, expected at most ",
                directions.cols());
        Matrix3X<S> result = mean;
        Eigen::Map<VectorX<S>>(result.data(), result.size()).noalias() +=
            directions.leftCols(betas.size()) * betas;
        return result;
    }

    void require_pose(const Pose<S>& pose) const {
        require(pose.rotation_vectors.cols() == num_joints(), "pose has ", pose.rotation_vectors.cols(),
                " joints, expected ", num_joints());
    }

    void pose_features_into(const Pose<S>& pose, VectorX<S>& features) const {
        for (Index j = 1; j < num_joints(); ++j) {
            const Matrix3<S> transposed = local_rotation(pose, j).transpose() - Matrix3<S>::Identity();
            features.template segment<9>(9 * (j - 1)) = vec(transposed);  // row by row: 3 a + b
        }
    }

    Vector3<S> pose_offset(Index vertex, const VectorX<S>& features) const {
        Vector3<S> offset = Vector3<S>::Zero();
        for (int d = 0; d < 3; ++d) {
            for (typename SparseMatrix::InnerIterator entry(pose_directions_, 3 * vertex + d); entry; ++entry) {
                offset(d) += entry.value() * features(entry.col());
            }
        }
        return offset;
    }

    void require_matches(Index num_volume_vertices, std::span<const VertexMatch> matches) const {
        std::vector<bool> seen(size_t(num_volume_vertices), false);
        for (const VertexMatch& match : matches) {
            require(match.volume >= 0 && match.volume < num_volume_vertices && match.surface >= 0 &&
                        match.surface < num_vertices(),
                    "carried_into: match of volume vertex ", match.volume, " with surface vertex ", match.surface,
                    ", expected below ", num_volume_vertices, " and ", num_vertices());
            require(!seen[size_t(match.volume)], "carried_into: volume vertex ", match.volume, " is matched twice");
            seen[size_t(match.volume)] = true;
        }
    }

    template <class Interpolator>
    SkinningWeights<S> carried_weights(const Carrier<Interpolator>& carrier, S smallest) const {
        MatrixX<S> dense = carrier(weights_.dense());
        const std::vector<bool> matched = carrier.is_matched();
        for (Index v = 0; v < dense.rows(); ++v) {
            if (!matched[size_t(v)]) {
                dense.row(v) = (dense.row(v).array() > S(0) && dense.row(v).array() >= smallest)
                                   .select(dense.row(v).array(), S(0));
                const S sum = dense.row(v).sum();
                require(sum > S(0), "carried_into: interpolated weights of volume vertex ", v, " sum to ", sum,
                        ", expected > 0");
                dense.row(v) /= sum;
            }
        }
        return SkinningWeights<S>(dense);
    }

    template <class Interpolator>
    MatrixX<S> carried_shape_directions(const Carrier<Interpolator>& carrier) const {
        const Index shapes = num_shapes();
        MatrixX<S> values(num_vertices(), 3 * shapes);  // one row per vertex: column 3 s + d
        for (Index s = 0; s < shapes; ++s) {
            const Eigen::Map<const Matrix3X<S>> direction(shape_directions_.col(s).data(), 3, num_vertices());
            values.middleCols(3 * s, 3) = direction.transpose();
        }
        const MatrixX<S> carried = carrier(values);
        MatrixX<S> result(3 * carrier.num_vertices, shapes);
        for (Index s = 0; s < shapes; ++s) {
            Eigen::Map<Matrix3X<S>>(result.col(s).data(), 3, carrier.num_vertices) =
                carried.middleCols(3 * s, 3).transpose();
        }
        return result;
    }

    /// One joint at a time: 27 dense columns instead of 27 (joints - 1).
    template <class Interpolator>
    SparseMatrix carried_pose_directions(const Carrier<Interpolator>& carrier, S smallest) const {
        const Eigen::SparseMatrix<S, Eigen::ColMajor> by_column = pose_directions_;
        const std::vector<bool> matched = carrier.is_matched();
        std::vector<Eigen::Triplet<S>> entries;
        for (Index block = 0; block < by_column.cols(); block += 9) {
            MatrixX<S> values = MatrixX<S>::Zero(num_vertices(), 27);  // column 3 k + d
            for (Index k = 0; k < 9; ++k) {
                for (typename Eigen::SparseMatrix<S>::InnerIterator entry(by_column, block + k); entry; ++entry) {
                    values(entry.row() / 3, 3 * k + entry.row() % 3) = entry.value();
                }
            }
            const MatrixX<S> carried = carrier(values);
            for (Index v = 0; v < carried.rows(); ++v) {
                for (Index c = 0; c < 27; ++c) {
                    const S value = carried(v, c);
                    if (value != S(0) && (matched[size_t(v)] || std::abs(value) >= smallest)) {
                        entries.emplace_back(int(3 * v + c % 3), int(block + c / 3), value);
                    }
                }
            }
        }
        SparseMatrix result(3 * carrier.num_vertices, by_column.cols());
        result.setFromTriplets(entries.begin(), entries.end());
        return result;
    }

    KinematicTree tree_;
    Policy policy_;
    VolumetricSmplOptions options_;
    Matrix3X<S> template_;
    SkinningWeights<S> weights_;
    MatrixX<S> shape_directions_;
    SparseMatrix pose_directions_;
    Matrix3X<S> joint_template_;
    MatrixX<S> joint_directions_;  // 3 joints x shapes
    VectorX<S> shape_;
    Matrix3X<S> rest_vertices_;
    Matrix3X<S> rest_joints_;
};

}  // namespace softtissue
