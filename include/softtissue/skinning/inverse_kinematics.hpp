// SPDX-License-Identifier: MIT
/// @file
/// Damped least-squares inverse kinematics: joint rotations that bring chosen joints where they shall be.
///
/// What        moves a pose, the start, to the nearest minimum of the weighted squared errors of all goals; unknowns are a
///             rotation of every joint and the root's translation.
/// Equation    (J^T J + damping I) step = -J^T r;  the damping follows the ratio of actual and predicted decrease
///             position goal     r = weight (x_k - target),            dr/dw_a = -weight [x_k - x_a]_x,  a above k
///             orientation goal  r = lever / sqrt 2 vec(A_k - target), dr/dw_a = -lever / sqrt 2 [A_k e_c]_x, a = k or above
///             w_a: rotation vector of joint a in the world's axes, A_k: rest-to-posed rotation
/// Shapes      step 3 (num_joints + 1): w of every joint, then the root's translation; pose: see skinning/pose.hpp.
/// Units       positions, levers [m]; an orientation error of t radians counts as a displacement by lever * t.
/// Valid       goals out of reach and more unknowns than goals are no exception: the step is the shortest one (damping),
///             joints that no goal asks for stay. The result depends on the start: begin with the previous frame.
/// Refuses     rest joints, pose, mobilities or goals that do not fit the tree or are not finite (InvalidInput).
/// Source      Wampler 1986 (damped least squares); Nielsen 1999, "Damping parameter in Marquardt's method"; Nolte et al. 2026, sec. 4.1
/// Cost        per iteration one dense Cholesky factorisation of 3 (num_joints + 1) unknowns
/// Tests       tests/unit/skinning/inverse_kinematics_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/skinning/joint_transforms.hpp>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

namespace softtissue {

/// Joint `joint` shall be at `position`.
template <RealScalar S>
struct PositionGoal {
    std::int32_t joint = 0;
    Vector3<S> position = Vector3<S>::Zero();
    S weight = S(1);
};

/// The rest-to-posed rotation of joint `joint` shall be `rotation`.
template <RealScalar S>
struct OrientationGoal {
    std::int32_t joint = 0;
    Matrix3<S> rotation = Matrix3<S>::Identity();
    S lever = S(0.1);
};

template <RealScalar S>
struct PoseGoals {
    std::vector<PositionGoal<S>> positions;
    std::vector<OrientationGoal<S>> orientations;

    Index num_residuals() const { return 3 * Index(positions.size()) + 9 * Index(orientations.size()); }
};

template <RealScalar S>
struct InverseKinematicsOptions {
    int max_iterations = 100;
    S residual_tolerance =
        S(1e-7) + S(32) * std::numeric_limits<S>::epsilon();  ///< converged where |r| is at most this [m] ...
    S cosine_tolerance =
        S(16) * std::sqrt(std::numeric_limits<S>::epsilon());  ///< ... or r that orthogonal to every column of J
    VectorX<S> mobility;  ///< how willingly each joint turns, 0 = locked; empty: 1 for all
    bool root_translates = true;
};

enum class InverseKinematicsStatus {
    converged,
    max_iterations,
    stalled,     ///< no step decreases the error any more, within rounding
    not_finite,  ///< goals or pose too far away for the range of the numbers
};

template <RealScalar S>
struct [[nodiscard]] InverseKinematicsReport {
    InverseKinematicsStatus status = InverseKinematicsStatus::max_iterations;
    int iterations = 0;
    S residual = S(0);  ///< |r| [m]
};

template <RealScalar S>
class InverseKinematics {
public:
    InverseKinematics(KinematicTree tree, Matrix3X<S> joints, InverseKinematicsOptions<S> options = {})
        : tree_(std::move(tree)), joints_(std::move(joints)), options_(std::move(options)) {
        const Index n = tree_.num_joints();
        require(joints_.cols() == n && joints_.allFinite(), "inverse kinematics: ", joints_.cols(),
                " rest joints, expected ", n, " with finite positions");
        if (options_.mobility.size() == 0) {
            options_.mobility.setOnes(n);
        }
        require(options_.mobility.size() == n, "inverse kinematics: ", options_.mobility.size(),
                " mobilities, expected one for each of ", n, " joints");
        for (Index j = 0; j < n; ++j) {
            require(std::isfinite(options_.mobility(j)) && options_.mobility(j) >= S(0),
                    "inverse kinematics: mobility of joint ", j, " is ", options_.mobility(j), ", expected >= 0");
        }
    }

    Index num_unknowns() const { return 3 * (tree_.num_joints() + 1); }

    /// Moves `pose` until the goals are met as well as they can be.
    InverseKinematicsReport<S> solve_into(const PoseGoals<S>& goals, Pose<S>& pose) const {
        require_goals(goals);
        InverseKinematicsReport<S> report;
        VectorX<S> r = residual(goals, pose);
        S damping = S(0);
        S growth = S(2);
        for (;; ++report.iterations) {
            report.residual = r.norm();
            const MatrixX<S> J = jacobian(goals, pose);
            const VectorX<S> gradient = J.transpose() * r;
            if (report.residual <= options_.residual_tolerance || is_orthogonal(J, gradient, report.residual)) {
                report.status = InverseKinematicsStatus::converged;
                return report;
            }
            if (report.iterations == options_.max_iterations) {
                return report;
            }
            const MatrixX<S> normal = J.transpose() * J;
            if (!std::isfinite(normal.sum()) || !std::isfinite(gradient.sum()) || !std::isfinite(r.squaredNorm())) {
                report.status = InverseKinematicsStatus::not_finite;
                return report;
            }
            const S largest = normal.diagonal().maxCoeff();
            damping = std::max(damping, (report.iterations == 0 ? S(1e-3) : least_damping) * largest);
            for (bool accepted = false; !accepted;) {
                const VectorX<S> step = damped_step(normal, gradient, damping);
                Pose<S> trial = moved(pose, step);
                VectorX<S> trial_residual;
                S gain(0);
                if (trial.rotation_vectors.allFinite() && trial.translation.allFinite()) {
                    trial_residual = residual(goals, trial);
                    gain = (r.squaredNorm() - trial_residual.squaredNorm()) / step.dot(damping * step - gradient);
                }
                accepted = gain > S(0);
                if (accepted) {
                    const S shrink = S(2) * gain - S(1);
                    damping *= std::max(S(1) / S(3), S(1) - shrink * shrink * shrink);
                    growth = S(2);
                    pose = std::move(trial);
                    r = trial_residual;
                } else if (damping * std::numeric_limits<S>::epsilon() > largest || !(damping > S(0))) {
                    report.status = InverseKinematicsStatus::stalled;
                    return report;
                } else {
                    damping *= growth;
                    growth *= S(2);
                }
            }
        }
    }

    /// r: three entries for each position goal, then nine for each orientation goal.
    VectorX<S> residual(const PoseGoals<S>& goals, const Pose<S>& pose) const {
        const std::vector<AffineTransform<S>> transforms = joint_transforms(tree_, joints_, pose);
        VectorX<S> r(goals.num_residuals());
        Index row = 0;
        for (const PositionGoal<S>& goal : goals.positions) {
            const Vector3<S> x = transforms[size_t(goal.joint)](joints_.col(goal.joint));
            r.template segment<3>(row) = goal.weight * (x - goal.position);
            row += 3;
        }
        for (const OrientationGoal<S>& goal : goals.orientations) {
            const Matrix3<S> difference = transforms[size_t(goal.joint)].linear - goal.rotation;
            r.template segment<9>(row) = goal.lever / std::numbers::sqrt2_v<S> * vec(difference);
            row += 9;
        }
        return r;
    }

    /// dr / dstep at step = 0; columns are scaled by the joints' mobilities.
    MatrixX<S> jacobian(const PoseGoals<S>& goals, const Pose<S>& pose) const {
        const std::vector<AffineTransform<S>> transforms = joint_transforms(tree_, joints_, pose);
        const Matrix3X<S> x = posed_joints(transforms, joints_);
        MatrixX<S> J = MatrixX<S>::Zero(goals.num_residuals(), num_unknowns());
        Index row = 0;
        for (const PositionGoal<S>& goal : goals.positions) {
            for (std::int32_t a = tree_.parent(goal.joint); a != KinematicTree::no_parent; a = tree_.parent(a)) {
                J.template block<3, 3>(row, 3 * a) =
                    cross_columns(goal.weight * options_.mobility(a) * (x.col(a) - x.col(goal.joint)));
            }
            if (options_.root_translates) {
                J.template block<3, 3>(row, num_unknowns() - 3).diagonal().setConstant(goal.weight);
            }
            row += 3;
        }
        for (const OrientationGoal<S>& goal : goals.orientations) {
            const Matrix3<S>& A = transforms[size_t(goal.joint)].linear;
            for (std::int32_t a = goal.joint; a != KinematicTree::no_parent; a = tree_.parent(a)) {
                const S factor = -goal.lever / std::numbers::sqrt2_v<S> * options_.mobility(a);
                for (int c = 0; c < 3; ++c) {
                    J.template block<3, 3>(row + 3 * c, 3 * a) = cross_columns(factor * A.col(c));
                }
            }
            row += 9;
        }
        return J;
    }

    /// The pose after `step`, whose rotations are scaled by the joints' mobilities.
    Pose<S> moved(const Pose<S>& pose, const VectorX<S>& step) const {
        const std::vector<AffineTransform<S>> transforms = joint_transforms(tree_, joints_, pose);
        Pose<S> result = pose;
        for (std::int32_t j = 0; j < tree_.num_joints(); ++j) {
            Vector3<S> turn = options_.mobility(j) * step.template segment<3>(3 * j);
            if (turn.isZero(S(0))) {
                continue;
            }
            if (tree_.parent(j) != KinematicTree::no_parent) {  // from the world's axes to the parent's
                turn = transforms[size_t(tree_.parent(j))].linear.transpose() * turn;
            }
            const Quaternion<S> q = quaternion_from_rotation_vector<S>(pose.rotation_vectors.col(j));
            result.rotation_vectors.col(j) =
                rotation_vector_from_quaternion<S>(quaternion_product<S>(quaternion_from_rotation_vector<S>(turn), q));
        }
        if (options_.root_translates) {
            result.translation += step.template tail<3>();
        }
        return result;
    }

private:
    /// Of the largest diagonal entry of J^T J: what keeps the factorisation of a singular matrix safe.
    static constexpr S least_damping = S(100) * std::numeric_limits<S>::epsilon();

    void require_goals(const PoseGoals<S>& goals) const {
        const auto require_goal = [this](const char* kind, size_t number, std::int32_t joint, bool is_finite) {
            require(joint >= 0 && joint < tree_.num_joints() && is_finite, "inverse kinematics: ", kind, " goal ",
                    number, " for joint ", joint, ", expected a joint from 0 to ", tree_.num_joints() - 1,
                    " and finite values");
        };
        for (size_t g = 0; g < goals.positions.size(); ++g) {
            const PositionGoal<S>& goal = goals.positions[g];
            require_goal("position", g, goal.joint, goal.position.allFinite() && std::isfinite(goal.weight));
        }
        for (size_t g = 0; g < goals.orientations.size(); ++g) {
            const OrientationGoal<S>& goal = goals.orientations[g];
            require_goal("orientation", g, goal.joint, goal.rotation.allFinite() && std::isfinite(goal.lever));
        }
    }

    /// [v]_x: its product with w is v x w.
    static Matrix3<S> cross_columns(const Vector3<S>& v) {
        return (Matrix3<S>() << S(0), -v(2), v(1), v(2), S(0), -v(0), -v(1), v(0), S(0)).finished();
    }

    /// Is the cosine of the angle between r and every column of J small?
    bool is_orthogonal(const MatrixX<S>& J, const VectorX<S>& gradient, S residual) const {
        for (Index i = 0; i < J.cols(); ++i) {
            if (!(std::abs(gradient(i)) <= options_.cosine_tolerance * J.col(i).norm() * residual)) {
                return false;
            }
        }
        return true;
    }

    static VectorX<S> damped_step(MatrixX<S> normal, const VectorX<S>& gradient, S damping) {
        normal.diagonal().array() += damping;
        return normal.llt().solve(-gradient);
    }

    KinematicTree tree_;
    Matrix3X<S> joints_;
    InverseKinematicsOptions<S> options_;
};

}  // namespace softtissue
