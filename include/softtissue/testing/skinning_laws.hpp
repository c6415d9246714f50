// SPDX-License-Identifier: MIT
/// @file
/// The laws every skinning policy and every skinned body must obey, checked on seeded random states.
///
///     const LawReport report = check_skinning_laws(MyBlend{});
///     if (!report.all_passed()) { std::cerr << report.summary(); }
///
/// Policy laws "identity"             joints at rest give the identity
///             "common motion"        one rigid motion of all joints is the vertex's motion
///             "single joint"         a joint of weight one gives its own motion (so all policies agree there)
///             "rigid equivariance"   a rigid motion G after every joint: blend(G T_j) = G blend(T_j)
///             "weight permutation"   the order of a row does not matter
///             "quaternion sign"      joints turned by a further 2 pi give the same motion
///             "inverse"              the inverse of the blend takes every vertex back
///             "rigid"                the blend is rigid (only with is_rigid)
/// Body laws   "identity pose"        the rest pose leaves the shaped vertices where they are
///             "rigid body"           turning the root and moving it moves the body rigidly
///             "skinning relation"    positions = A (rest + offsets) + t
///             "inverse skinning"     unposed(positions) are the rest vertices
/// Measures    lengths over the size of the set-up (1 m for policies, the extent of the body for bodies);
///             the tolerance is round_off times epsilon of the scalar
/// Tests       tests/laws/skinning_laws_test.cpp, tests/unit/testing/skinning_laws_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/skinning/concepts.hpp>
#include <softtissue/skinning/inverse.hpp>
#include <softtissue/skinning/pose.hpp>
#include <softtissue/testing/law_report.hpp>
#include <softtissue/testing/random_states.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace softtissue {

struct SkinningLawOptions {
    int samples = 50;
    std::uint64_t seed = 1;
    bool is_rigid = false;     ///< true where every blend of rotations is a rotation
    double joint_angle = 1.2;  ///< joints differ from each other by up to twice this [rad]
    /// Allowed round-off, in epsilon of the scalar: a chain of some ten 3x3 products with a factor of safety.
    double round_off = 200;
};

namespace detail {

/// Measures the laws of one policy, one random row of joints after the other.
template <SkinningPolicy P>
class SkinningLawSuite {
public:
    using Scalar = typename P::Scalar;
    static_assert(RealScalar<Scalar>, "check_skinning_laws needs a policy over float or double");

    SkinningLawSuite(const P& policy, const SkinningLawOptions& options)
        : policy_(policy),
          options_(options),
          random_(options.seed),
          tolerance_(options.round_off * double(std::numeric_limits<Scalar>::epsilon())) {}

    LawReport report() {
        for (int sample = 0; sample < options_.samples; ++sample) {
            where_ = "sample " + std::to_string(sample);
            draw(1 + random_.index(8));
            check_fixed_points();
            check_symmetries();
            check_inverse();
        }
        return std::move(report_);
    }

private:
    using Transform = AffineTransform<Scalar>;
    using Row = std::vector<JointWeight<Scalar>>;

    const P& policy_;
    const SkinningLawOptions& options_;
    RandomGenerator random_;
    double tolerance_;
    LawReport report_;
    std::string where_;
    std::vector<Vector3<Scalar>> rotations_;
    std::vector<Transform> joints_;
    Row row_;

    static Transform motion(const Vector3<Scalar>& rotation_vector, const Vector3<Scalar>& translation) {
        return {rotation_matrix_from_rotation_vector(rotation_vector), translation};
    }

    Transform random_motion(double largest_angle) {
        const Vector3<Scalar> axis = random_unit<Vector3<Scalar>>(random_);
        return motion(axis * Scalar(random_.uniform(0, largest_angle)), random_unit<Vector3<Scalar>>(random_));
    }

    /// Joints that all turn less than joint_angle and carry random weights.
    void draw(Index num_joints) {
        rotations_.clear();
        joints_.clear();
        row_.clear();
        Scalar sum(0);
        for (Index j = 0; j < num_joints; ++j) {
            rotations_.push_back(random_unit<Vector3<Scalar>>(random_) *
                                 Scalar(random_.uniform(0.1, options_.joint_angle)));
            joints_.push_back(motion(rotations_.back(), random_unit<Vector3<Scalar>>(random_)));
            row_.push_back({std::int32_t(j), Scalar(random_.uniform(0.05, 1))});
            sum += row_.back().weight;
        }
        for (JointWeight<Scalar>& entry : row_) {
            entry.weight /= sum;
        }
    }

    Transform blend(const std::vector<Transform>& joints, const Row& row) const {
        MatrixX<Scalar> prepared;
        policy_.prepare_into(joints, prepared);
        return policy_.blend(prepared, row);
    }

    void same(const char* law, const Transform& a, const Transform& b) {
        const Scalar error = std::max((a.linear - b.linear).norm(), (a.translation - b.translation).norm());
        report_.at_most(law, double(error), tolerance_, where_);
    }

    void check_fixed_points() {
        const size_t count = joints_.size();
        same("identity", blend(std::vector<Transform>(count), row_), Transform{});
        const Transform common = random_motion(std::numbers::pi);
        same("common motion", blend(std::vector<Transform>(count, common), row_), common);
        const std::int32_t j = std::int32_t(random_.index(Index(count)));
        same("single joint", blend(joints_, {{j, Scalar(1)}}), joints_[size_t(j)]);
    }

    void check_symmetries() {
        const Transform expected = blend(joints_, row_);
        const Transform G = random_motion(std::numbers::pi);
        std::vector<Transform> moved, turned;
        for (size_t j = 0; j < joints_.size(); ++j) {
            moved.push_back(G * joints_[j]);
            const Scalar full_turn = Scalar(2 * std::numbers::pi);
            turned.push_back(motion(rotations_[j] - full_turn * rotations_[j].normalized(), joints_[j].translation));
        }
        same("rigid equivariance", blend(moved, row_), G * expected);
        same("quaternion sign", blend(turned, row_), expected);
        Row permuted = row_;
        for (size_t k = permuted.size(); k > 1; --k) {
            std::swap(permuted[k - 1], permuted[size_t(random_.index(Index(k)))]);
        }
        same("weight permutation", blend(joints_, permuted), expected);
    }

    void check_inverse() {
        const Transform T = blend(joints_, row_);
        const Vector3<Scalar> x = random_unit<Vector3<Scalar>>(random_);
        const double condition = 1 / std::abs(double(signed_smallest_singular_value(T.linear)));
        const double error = double((T.inverse()(T(x)) - x).norm());
        report_.at_most("inverse", error / condition, tolerance_, where_);
        if (options_.is_rigid) {
            const Matrix3<Scalar> gram = T.linear.transpose() * T.linear - Matrix3<Scalar>::Identity();
            const double mirrored = signed_smallest_singular_value(T.linear) < Scalar(0) ? 1 : 0;
            report_.at_most("rigid", double(gram.norm()) + mirrored, tolerance_, where_);
        }
    }
};

}  // namespace detail

/// Checks the laws of a skinning policy on random joints and weights.
template <SkinningPolicy P>
LawReport check_skinning_laws(const P& policy, const SkinningLawOptions& options = {}) {
    return detail::SkinningLawSuite<P>(policy, options).report();
}

/// Checks the laws of a skinned body (a VolumetricSmpl, or anything with rest_vertices(), rest_joints(), tree(),
/// num_joints() and pose()) in random poses. Pose correctives of the rest pose must vanish, as SMPL's do.
template <class Body>
LawReport check_skinned_body_laws(const Body& body, const SkinningLawOptions& options = {}) {
    using S = typename Body::Scalar;
    const Matrix3X<S>& rest = body.rest_vertices();
    const double extent = double((rest.rowwise().maxCoeff() - rest.rowwise().minCoeff()).norm());
    const double tolerance = options.round_off * double(std::numeric_limits<S>::epsilon());
    const auto error = [extent](const Matrix3X<S>& a, const Matrix3X<S>& b) {
        return double((a - b).colwise().norm().maxCoeff()) / extent;
    };
    RandomGenerator random(options.seed);
    LawReport report;
    report.at_most("identity pose", error(body.pose(Pose<S>::rest(body.num_joints())).positions, rest), tolerance);
    for (int sample = 0; sample < options.samples; ++sample) {
        const std::string where = "sample " + std::to_string(sample);
        Pose<S> pose = Pose<S>::rest(body.num_joints());
        for (Index j = 1; j < body.num_joints(); ++j) {
            pose.rotation_vectors.col(j) = random_unit<Vector3<S>>(random) * S(random.uniform(0, 1));
        }
        const PosedBody<S> posed = body.pose(pose);
        Matrix3X<S> skinned(3, rest.cols());
        for (Index v = 0; v < rest.cols(); ++v) {
            skinned.col(v) = posed.transforms[size_t(v)](rest.col(v) + posed.offsets.col(v));
        }
        report.at_most("skinning relation", error(skinned, posed.positions), tolerance, where);
        const S worst = check_blends<S>(posed.transforms).smallest_singular_value;
        report.at_most("inverse skinning", error(unposed(posed, posed.positions), rest) * std::abs(double(worst)),
                       tolerance, where);

        pose.rotation_vectors.col(body.tree().root()) = random_unit<Vector3<S>>(random) * S(random.uniform(0, 3));
        pose.translation = random_unit<Vector3<S>>(random) * S(extent);
        const Vector3<S> root = body.rest_joints().col(body.tree().root());
        const Matrix3<S> R =
            rotation_matrix_from_rotation_vector<S>(pose.rotation_vectors.col(body.tree().root()));
        const Vector3<S> shift = root + pose.translation - R * root;
        const Matrix3X<S> moved = (R * posed.positions).colwise() + shift;
        report.at_most("rigid body", error(body.pose(pose).positions, moved), tolerance, where);
    }
    return report;
}

}  // namespace softtissue
