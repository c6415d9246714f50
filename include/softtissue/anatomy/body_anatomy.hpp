// SPDX-License-Identifier: MIT
/// @file
/// Where bones and fat lie in a human body, as tables over its skeleton.
///
/// What        BodyAnatomy: limb bones as tubes around joint pairs, the trunk as an elliptic tube, fat thickness per joint;
///             smpl_anatomy(): those of an adult with SMPL's 24 joints.
/// Units       m, for a skeleton of the reference lengths: radii and thicknesses are multiplied by the skeleton's own scale.
/// Valid       proportions of an adult; the "bone" of the trunk contains lungs and viscera.
/// Source      a design after anatomical sections; Nolte et al. 2026, section 3.1 take theirs from scanned anatomy
/// Tests       tests/unit/anatomy/body_anatomy_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace softtissue {

/// A piecewise linear function of one number, constant beyond its ends.
struct Profile {
    std::vector<std::array<double, 2>> knots;  // (t, value), t ascending

    double operator()(double t) const {
        if (t <= knots.front()[0]) {
            return knots.front()[1];
        }
        for (size_t k = 1; k < knots.size(); ++k) {
            if (t < knots[k][0]) {
                const double s = (t - knots[k - 1][0]) / (knots[k][0] - knots[k - 1][0]);
                return knots[k - 1][1] + s * (knots[k][1] - knots[k - 1][1]);
            }
        }
        return knots.back()[1];
    }
};

/// A tube around the segment from one joint to another; it never fills more than `cap` of the way to the skin.
struct LimbBone {
    std::int32_t start;
    std::int32_t end;
    std::vector<std::int32_t> joints;  // whose skin covers this bone
    Profile radius;                    // [m] over 0 (start) to 1 (end)
    double cap;
};

/// An elliptic tube from one joint up to another, in the middle of the trunk's skin; its cross-sections lie across the line
/// between the two joints.
struct TrunkShape {
    std::int32_t bottom;
    std::int32_t top;
    std::int32_t left;  // with `right` the direction of the width
    std::int32_t right;
    std::vector<std::int32_t> joints;
    Profile half_width;  // [m] over 0 (bottom) to 1 (top)
    Profile half_depth;
    double lowest;       // below, the tube ends in half an ellipsoid
    double floor_depth;  // of this half axis [m]
    double cap;
    double buttock_fat;  // [m] in addition, at the back of the bottom joint's skin
};

/// A chain of joints and its length in the reference skeleton.
struct ReferenceLength {
    std::vector<std::int32_t> chain;
    double length;
};

struct BodyAnatomy {
    std::vector<std::int32_t> parents;  // the kinematic tree that these tables belong to
    std::vector<ReferenceLength> lengths;
    std::vector<LimbBone> limbs;
    TrunkShape trunk;
    std::vector<double> fat;    // per joint [m]
    std::vector<double> depth;  // per joint: mean distance of skin and bone target where `fat` is right [m]

    Index num_joints() const { return static_cast<Index>(parents.size()); }

    /// Throws InvalidInput if the tables belong to another skeleton, or are incomplete.
    void require_tree(const KinematicTree& tree) const {
        std::vector<bool> has_bone(parents.size(), false);
        const auto mark = [&](const std::vector<std::int32_t>& joints) {
            for (const std::int32_t joint : joints) {
                require(joint >= 0 && joint < num_joints(), "anatomy: joint ", joint, ", expected 0 to ",
                        num_joints() - 1);
                has_bone[size_t(joint)] = true;
            }
        };
        mark(trunk.joints);
        for (const LimbBone& bone : limbs) {
            mark(bone.joints);
        }
        for (size_t j = 0; j < has_bone.size(); ++j) {
            require(has_bone[j], "anatomy: no bone for the skin of joint ", j, ", expected a limb or the trunk");
        }
        require(fat.size() == parents.size() && depth.size() == parents.size(), "anatomy: ", fat.size(),
                " values of fat and ", depth.size(), " of depth, expected one for each of the ", num_joints(),
                " joints");
        require(tree.num_joints() == num_joints(), "layered body: the skeleton has ", tree.num_joints(),
                " joints, expected ", num_joints(), " as in the tables of the anatomy (SMPL's order by default)");
        for (Index j = 0; j < num_joints(); ++j) {
            require(tree.parent(j) == parents[size_t(j)], "layered body: joint ", j, " hangs from joint ",
                    tree.parent(j), ", expected ", parents[size_t(j)],
                    " as in the tables of the anatomy (SMPL's order by default)");
        }
    }

    /// Size of a skeleton: the mean ratio of its lengths to the reference lengths.
    template <RealScalar S>
    S scale(const Matrix3X<S>& joints) const {
        S sum(0);
        for (const ReferenceLength& reference : lengths) {
            S length(0);
            for (size_t k = 1; k < reference.chain.size(); ++k) {
                length += (joints.col(reference.chain[k]) - joints.col(reference.chain[k - 1])).norm();
            }
            sum += length / S(reference.length);
        }
        return sum / S(lengths.size());
    }
};

namespace detail {

inline void add_limb_pair(BodyAnatomy& anatomy, LimbBone left) {
    // SMPL numbers a right joint one after its left.
    LimbBone right = left;
    ++right.start;
    ++right.end;
    for (std::int32_t& joint : right.joints) {
        ++joint;
    }
    anatomy.limbs.push_back(std::move(left));
    anatomy.limbs.push_back(std::move(right));
}

}  // namespace detail

/// For SMPL's 24 joints. 0 pelvis, 1-2 hips, 3 6 9 spine, 4-5 knees, 7-8 ankles, 10-11 feet, 12 neck, 13-14 collars, 15 head,
/// 16-17 shoulders, 18-19 elbows, 20-21 wrists, 22-23 hands.
inline BodyAnatomy smpl_anatomy() {
    BodyAnatomy anatomy;
    anatomy.parents = {-1, 0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9, 9, 12, 13, 14, 16, 17, 18, 19, 20, 21};
    // The shoulders count as much as both legs.
    anatomy.lengths = {{{16, 17}, 0.340}, {{16, 17}, 0.340}, {{1, 4, 7}, 0.805}, {{2, 5, 8}, 0.805}};
    detail::add_limb_pair(  // femur
        anatomy, {1, 4, {1}, {{{0, .030}, {.12, .024}, {.3, .017}, {.6, .016}, {.85, .024}, {1, .030}}}, 0.72});
    detail::add_limb_pair(  // tibia and fibula
        anatomy, {4, 7, {4, 7, 10}, {{{0, .030}, {.15, .026}, {.45, .020}, {.8, .018}, {1, .022}}}, 0.72});
    detail::add_limb_pair(anatomy, {13, 16, {13}, {{{0, .030}, {1, .026}}}, 0.75});  // collar bone
    detail::add_limb_pair(                                                           // humerus
        anatomy, {16, 18, {16}, {{{0, .026}, {.15, .020}, {.35, .014}, {.65, .013}, {.9, .018}, {1, .021}}}, 0.70});
    detail::add_limb_pair(  // radius and ulna
        anatomy, {18, 20, {18, 20, 22}, {{{0, .021}, {.15, .019}, {.5, .017}, {.85, .017}, {1, .020}}}, 0.70});
    anatomy.trunk = {.bottom = 0,
                     .top = 12,
                     .left = 16,
                     .right = 17,
                     .joints = {0, 3, 6, 9, 12, 15},
                     .half_width = {{{-.25, .060},
                                     {-.1, .105},
                                     {0, .115},
                                     {.2, .100},
                                     {.35, .098},
                                     {.5, .112},
                                     {.65, .118},
                                     {.8, .105},
                                     {.95, .055},
                                     {1.05, .034},
                                     {1.3, .030}}},
                     .half_depth = {{{-.25, .045},
                                     {-.1, .065},
                                     {0, .072},
                                     {.2, .060},
                                     {.35, .062},
                                     {.5, .075},
                                     {.65, .080},
                                     {.8, .068},
                                     {.95, .042},
                                     {1.05, .034},
                                     {1.3, .030}}},
                     .lowest = -0.12,
                     .floor_depth = 0.060,
                     .cap = 0.80,
                     .buttock_fat = 0.012};
    anatomy.fat = {.020, .011, .011, .020, .006, .006, .016, .003, .003, .010, .003, .003,
                   .005, .007, .007, .005, .007, .007, .004, .004, .003, .003, .003, .003};
    anatomy.depth = {.043, .049, .049, .035, .027, .027, .032, .018, .018, .033, .018, .018,
                     .018, .031, .031, .015, .029, .029, .016, .016, .012, .012, .012, .012};
    return anatomy;
}

}  // namespace softtissue
