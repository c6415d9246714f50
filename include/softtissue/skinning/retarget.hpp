// SPDX-License-Identifier: MIT
/// @file
/// A motion of one skeleton on another one.
///
/// What        Retargeter: pose by pose; copies the rotations of mapped joints, then moves the legs so that the feet stand
///             where the source's feet stand.
/// Equation    A_j = C G_s(j) C^T B_j   global rotation of target joint j; G: of the source joint, relative to its rest pose
///             C     axis-aligned rotation from the source's axes to the target's, nearest to the mapped rest joints
///             B_j   turns the target's rest bone into the direction of the source's, by the shortest way; without a bone
///                   that of the parent
///             positions times scale = ratio of the lengths of the legs; the middle of the hips is where the source's is
///             then inverse kinematics of the legs alone: ankles at the source's places, A_j kept as far as lever asks
/// Valid       every pose on its own: no pose depends on another one. A skeleton's motion on itself returns that motion.
/// Refuses     a map with joints that a skeleton does not have, no legs, legs without length (InvalidInput).
/// Source      Nolte et al. 2026, sec. 4.1 (damped least squares)
/// Cost        per pose a few iterations of inverse_kinematics.hpp
/// Tests       tests/unit/skinning/retarget_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/skinning/inverse_kinematics.hpp>
#include <softtissue/skinning/joint_map.hpp>
#include <softtissue/skinning/joint_transforms.hpp>
#include <softtissue/skinning/motion.hpp>
#include <softtissue/skinning/skeleton.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace softtissue {

template <RealScalar S>
struct RetargetOptions {
    bool plants_feet = true;  ///< false: rotations only
    S lever = S(0.05);        ///< how far a rotation of 1 rad away from the copied one counts [m]
};

template <RealScalar S>
struct RetargetReport {
    Index poses = 0;
    Index not_converged = 0;      ///< poses whose inverse kinematics did not
    S largest_foot_error = S(0);  ///< of an ankle from its place [m]
};

namespace detail {

/// The rotation by the smallest angle that turns the direction of `from` into that of `to`.
template <RealScalar S>
Matrix3<S> shortest_rotation(const Vector3<S>& from, const Vector3<S>& to) {
    const Vector3<S> a = from.normalized(), b = to.normalized();
    const S w = S(1) + a.dot(b);
    if (w < S(8) * std::numeric_limits<S>::epsilon()) {  // opposite: half a turn about any perpendicular axis
        const Vector3<S> axis = a.unitOrthogonal();
        return S(2) * axis * axis.transpose() - Matrix3<S>::Identity();
    }
    const Vector3<S> v = a.cross(b);
    return rotation_matrix_from_quaternion<S>(Quaternion<S>(w, v(0), v(1), v(2)).normalized());
}

/// Of the 24 rotations that turn axes into axes the one C for which C source is nearest to target, both centred.
template <RealScalar S>
Matrix3<S> nearest_axis_rotation(const Matrix3X<S>& source, const Matrix3X<S>& target) {
    const Matrix3X<S> s = source.colwise() - source.rowwise().mean();
    const Matrix3X<S> t = target.colwise() - target.rowwise().mean();
    const Matrix3<S> correlation = t * s.transpose();
    Matrix3<S> best = Matrix3<S>::Identity();
    std::array<int, 3> axes{0, 1, 2};
    do {
        for (int signs = 0; signs < 8; ++signs) {
            Matrix3<S> C = Matrix3<S>::Zero();
            for (int row = 0; row < 3; ++row) {
                C(row, axes[size_t(row)]) = (signs >> row & 1) != 0 ? S(-1) : S(1);
            }
            const bool is_rotation = C.row(0).cross(C.row(1)).dot(C.row(2)) > S(0);
            if (is_rotation && C.cwiseProduct(correlation).sum() > best.cwiseProduct(correlation).sum()) {
                best = C;
            }
        }
    } while (std::next_permutation(axes.begin(), axes.end()));
    return best;
}

}  // namespace detail

template <RealScalar S>
class Retargeter {
public:
    Retargeter(Skeleton<S> source, Skeleton<S> target, const JointMap& map, RetargetOptions<S> options = {})
        : source_(std::move(source)),
          target_(std::move(target)),
          options_(options),
          inverse_kinematics_(target_.tree, target_.joints, legs_only(map)) {
        source_.validate("retarget: source");
        map.require_joints(target_, source_);
        require(!map.legs.empty(), "retarget: the joint map has no legs");
        source_of_.assign(size_t(target_.num_joints()), none);
        copies_rotation_.assign(size_t(target_.num_joints()), false);
        std::vector<std::int32_t> towards(size_t(target_.num_joints()), none);
        for (const JointPair& pair : map.pairs) {
            const auto j = size_t(target_.joint(pair.target));
            source_of_[j] = source_.joint(pair.source);
            copies_rotation_[j] = pair.copies_rotation;
            towards[j] = pair.towards.empty() ? none : target_.joint(pair.towards);
        }
        for (const std::vector<std::string>& leg : map.legs) {
            std::vector<std::int32_t>& joints = legs_.emplace_back();
            for (const std::string& name : leg) {
                joints.push_back(target_.joint(name));
            }
        }
        find_axes();
        find_scale();
        align_bones(towards);
    }

    /// Metres of the target per length of the source.
    S scale() const { return scale_; }
    const Matrix3<S>& axes() const { return axes_; }

    /// The target's pose for a pose of the source.
    Pose<S> operator()(const Pose<S>& source_pose, RetargetReport<S>& report) const {
        const auto source = joint_transforms(source_.tree, source_.joints, source_pose);
        const Matrix3X<S> places = scale_ * axes_ * posed_joints(source, source_.joints);
        Pose<S> pose = Pose<S>::rest(target_.num_joints());
        PoseGoals<S> goals;
        std::vector<Matrix3<S>> rotations(size_t(target_.num_joints()));
        for (const std::int32_t j : target_.tree.order()) {
            const std::int32_t parent = target_.tree.parent(j);
            const Matrix3<S> above =
                parent == KinematicTree::no_parent ? Matrix3<S>(Matrix3<S>::Identity()) : rotations[size_t(parent)];
            rotations[size_t(j)] = above;
            if (copies_rotation_[size_t(j)]) {
                const Matrix3<S>& G = source[size_t(source_of_[size_t(j)])].linear;
                rotations[size_t(j)] = axes_ * G * axes_.transpose() * alignment_[size_t(j)];
                const Matrix3<S> local = above.transpose() * rotations[size_t(j)];
                pose.rotation_vectors.col(j) = rotation_vector_from_rotation_matrix<S>(local);
            }
        }
        const auto turned = joint_transforms(target_.tree, target_.joints, pose);
        const Matrix3X<S> joints = posed_joints(turned, target_.joints);
        for (const std::vector<std::int32_t>& leg : legs_) {
            const Vector3<S> moved = places.col(source_of_[size_t(leg.front())]) - joints.col(leg.front());
            pose.translation += moved / S(legs_.size());
            goals.positions.push_back({leg.back(), places.col(source_of_[size_t(leg.back())]), S(1)});
            for (const std::int32_t j : leg) {
                goals.orientations.push_back({j, rotations[size_t(j)], options_.lever});
            }
        }
        ++report.poses;
        if (options_.plants_feet) {
            const auto solved = inverse_kinematics_.solve_into(goals, pose);
            report.not_converged += solved.status == InverseKinematicsStatus::max_iterations ? 1 : 0;
        }
        const VectorX<S> residual = inverse_kinematics_.residual({goals.positions, {}}, pose);
        for (Index leg = 0; leg < Index(legs_.size()); ++leg) {
            report.largest_foot_error =
                std::max(report.largest_foot_error, residual.template segment<3>(3 * leg).norm());
        }
        return pose;
    }

    /// A whole motion.
    Motion<S> operator()(const Motion<S>& motion, RetargetReport<S>& report) const {
        motion.validate("retarget", source_.num_joints());
        Motion<S> result;
        result.frame_rate = motion.frame_rate;
        for (const Pose<S>& pose : motion.poses) {
            result.poses.push_back((*this)(pose, report));
        }
        return result;
    }

private:
    static constexpr std::int32_t none = -1;

    InverseKinematicsOptions<S> legs_only(const JointMap& map) const {
        target_.validate("retarget: target");
        InverseKinematicsOptions<S> options;
        options.root_translates = false;
        options.mobility.setZero(target_.num_joints());
        for (const std::vector<std::string>& leg : map.legs) {
            for (const std::string& name : leg) {
                options.mobility(target_.joint(name)) = S(1);
            }
        }
        return options;
    }

    void find_axes() {
        Matrix3X<S> source(3, 0), target(3, 0);
        for (std::int32_t j = 0; j < target_.num_joints(); ++j) {
            if (source_of_[size_t(j)] != none) {
                source.conservativeResize(3, source.cols() + 1);
                target.conservativeResize(3, source.cols());
                source.rightCols(1) = source_.joints.col(source_of_[size_t(j)]);
                target.rightCols(1) = target_.joints.col(j);
            }
        }
        axes_ = detail::nearest_axis_rotation<S>(source, target);
    }

    void find_scale() {
        S source = S(0), target = S(0);
        for (const std::vector<std::int32_t>& leg : legs_) {
            for (size_t k = 1; k < leg.size(); ++k) {
                const std::int32_t a = leg[k - 1], b = leg[k];
                target += (target_.joints.col(b) - target_.joints.col(a)).norm();
                source +=
                    (source_.joints.col(source_of_[size_t(b)]) - source_.joints.col(source_of_[size_t(a)])).norm();
            }
        }
        require(source > S(0) && target > S(0), "retarget: legs of length ", source, " in the source and ", target,
                " in the target, expected > 0");
        scale_ = target / source;
    }

    void align_bones(const std::vector<std::int32_t>& towards) {
        alignment_.assign(size_t(target_.num_joints()), Matrix3<S>::Identity());
        for (const std::int32_t j : target_.tree.order()) {
            Matrix3<S>& B = alignment_[size_t(j)];
            if (target_.tree.parent(j) != KinematicTree::no_parent) {
                B = alignment_[size_t(target_.tree.parent(j))];
            }
            const std::int32_t end = towards[size_t(j)];
            if (end == none) {
                continue;
            }
            const Vector3<S> ours = B * (target_.joints.col(end) - target_.joints.col(j));
            const Vector3<S> theirs =
                axes_ * (source_.joints.col(source_of_[size_t(end)]) - source_.joints.col(source_of_[size_t(j)]));
            if (ours.norm() > S(0) && theirs.norm() > S(0)) {
                B = (detail::shortest_rotation<S>(ours, theirs) * B).eval();
            }
        }
    }

    Skeleton<S> source_;
    Skeleton<S> target_;
    RetargetOptions<S> options_;
    InverseKinematics<S> inverse_kinematics_;
    std::vector<std::int32_t> source_of_;  ///< source joint of each target joint
    std::vector<bool> copies_rotation_;
    std::vector<std::vector<std::int32_t>> legs_;
    Matrix3<S> axes_ = Matrix3<S>::Identity();
    S scale_ = S(1);
    std::vector<Matrix3<S>> alignment_;
};

}  // namespace softtissue
