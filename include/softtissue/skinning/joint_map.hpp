// SPDX-License-Identifier: MIT
/// @file
/// Which joint of one skeleton moves which joint of another, for retargeting; tables for SMPL's joints.
///
/// What        JointMap: pairs of names; smpl_joint_map: from the skeletons of common capture files to SMPL's 24 joints.
/// Bones       a pair with `towards` aligns its bone: what the target's bone from the joint to `towards` is at rest, the
///             source's bone between the same two joints is at rest. Limbs are aligned (an A-pose meets a T-pose), the
///             trunk is not: spines are drawn too differently.
/// Styles      cmu: the CMU database as .bvh, with the names of either common conversion; fair: Animated Drawings' clips;
///             makehuman: MakeHuman's default rig; smpl: SMPL's own names. CMU's skeletons have neither collar bones nor a
///             neck that leans forward: both keep the target's rest direction there.
/// Refuses     require_joints(): names that a skeleton does not have (InvalidInput names joint and skeleton).
/// Tests       tests/unit/skinning/joint_map_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/skinning/skeleton.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace softtissue {

struct JointPair {
    std::string target;
    std::string source;
    std::string towards = {};     ///< target joint at the other end of the bone to align; empty: no bone
    bool copies_rotation = true;  ///< false: the target joint stays as it is on its parent
};

struct JointMap {
    std::vector<JointPair> pairs;
    std::vector<std::vector<std::string>> legs;  ///< target joints from hip to ankle: they give scale and stance

    /// Throws InvalidInput unless both skeletons have every joint that the map names.
    template <RealScalar S>
    void require_joints(const Skeleton<S>& target, const Skeleton<S>& source) const {
        const auto require_joint = [](const char* which, const Skeleton<S>& skeleton, const std::string& name) {
            require(skeleton.has_joint(name), "joint map: the ", which, " skeleton has no joint '", name, "'");
        };
        for (const JointPair& pair : pairs) {
            require_joint("target", target, pair.target);
            require_joint("source", source, pair.source);
        }
        for (const JointPair& pair : pairs) {
            require(pair.towards.empty() || find(pair.towards) != nullptr, "joint map: '", pair.target,
                    "' is aligned towards '", pair.towards, "', which has no source joint");
        }
        for (const std::vector<std::string>& leg : legs) {
            require(leg.size() >= 2, "joint map: a leg of ", leg.size(), " joints, expected at least hip and ankle");
            for (const std::string& name : leg) {
                require(find(name) != nullptr, "joint map: the leg's joint '", name, "' has no source joint");
            }
        }
    }

    /// The pair of a target joint; null if it has none.
    const JointPair* find(const std::string& target) const {
        for (const JointPair& pair : pairs) {
            if (pair.target == target) {
                return &pair;
            }
        }
        return nullptr;
    }
};

/// Where a motion comes from.
enum class MotionStyle { cmu, fair, makehuman, smpl };

/// SMPL's joints in its order.
inline std::vector<std::string> smpl_joint_names() {
    return {"pelvis",     "left_hip",    "right_hip",    "spine1",      "left_knee",     "right_knee",
            "spine2",     "left_ankle",  "right_ankle",  "spine3",      "left_foot",     "right_foot",
            "neck",       "left_collar", "right_collar", "head",        "left_shoulder", "right_shoulder",
            "left_elbow", "right_elbow", "left_wrist",   "right_wrist", "left_hand",     "right_hand"};
}

namespace detail {

/// One row a joint; % stands for the side as the style spells it.
struct JointNames {
    const char* smpl;
    const char* cmu;
    const char* cmu_other;
    const char* fair;
    const char* makehuman;
    const char* towards;
};

inline constexpr std::array<JointNames, 6> trunk_names{{
    {"pelvis", "Hips", "Hips", "Hips", "root", ""},
    {"spine1", "lowerback", "LowerBack", "Spine", "spine04", ""},
    {"spine2", "Chest", "Spine", "Spine1", "spine02", ""},
    {"spine3", "Chest2", "Spine1", "Spine3", "spine01", ""},
    {"neck", "lowerneck", "Neck", "Neck", "neck01", "head"},
    {"head", "Head", "Head", "Head", "head", ""},
}};

inline constexpr std::array<JointNames, 9> limb_names{{
    {"%hip", "%Hip", "%UpLeg", "%UpLeg", "upperleg01.%", "%knee"},
    {"%knee", "%Knee", "%Leg", "%Leg", "lowerleg01.%", "%ankle"},
    {"%ankle", "%Ankle", "%Foot", "%Foot", "foot.%", "%foot"},
    {"%foot", "%Toe", "%ToeBase", "%ToeBase", "toe2-1.%", ""},
    {"%collar", "%Collar", "%Shoulder", "%Shoulder", "clavicle.%", "%shoulder"},
    {"%shoulder", "%Shoulder", "%Arm", "%Arm", "upperarm01.%", "%elbow"},
    {"%elbow", "%Elbow", "%ForeArm", "%ForeArm", "lowerarm01.%", "%wrist"},
    {"%wrist", "%Wrist", "%Hand", "%Hand", "wrist.%", "%hand"},
    {"%hand", "@hand", "%FingerBase", "%HandEnd", "finger3-1.%", ""},
}};

/// `name` with the side in place of %, its initial in place of @.
inline std::string with_side(std::string name, const std::string& side, const std::string& initial) {
    for (const auto& [mark, text] : {std::pair<char, std::string>('%', side), {'@', initial}}) {
        const std::size_t place = name.find(mark);
        if (place != std::string::npos) {
            name.replace(place, 1, text);
        }
    }
    return name;
}

}  // namespace detail

/// From the skeleton of a capture file to SMPL's joints. Hands stay on their wrists: captures have no use of them.
template <RealScalar S>
JointMap smpl_joint_map(MotionStyle style, const Skeleton<S>& source) {
    const bool has_other_names = source.has_joint("LeftUpLeg");
    const auto source_name = [&](const detail::JointNames& names) {
        return style == MotionStyle::cmu         ? (has_other_names ? names.cmu_other : names.cmu)
               : style == MotionStyle::fair      ? names.fair
               : style == MotionStyle::makehuman ? names.makehuman
                                                 : names.smpl;
    };
    const auto is_aligned = [&](const std::string& joint) {
        return style != MotionStyle::cmu || (joint != "neck" && joint != "%collar");
    };
    JointMap map;
    for (const detail::JointNames& names : detail::trunk_names) {
        map.pairs.push_back({names.smpl, source_name(names), is_aligned(names.smpl) ? names.towards : ""});
    }
    for (const bool left : {true, false}) {
        const std::string smpl_side = left ? "left_" : "right_";
        const std::string side = style == MotionStyle::smpl        ? smpl_side
                                 : style == MotionStyle::makehuman ? (left ? "L" : "R")
                                                                   : (left ? "Left" : "Right");
        const std::string initial = left ? "l" : "r";
        for (const detail::JointNames& names : detail::limb_names) {
            map.pairs.push_back({detail::with_side(names.smpl, smpl_side, ""),
                                 detail::with_side(source_name(names), side, initial),
                                 is_aligned(names.smpl) ? detail::with_side(names.towards, smpl_side, "") : "",
                                 names.smpl != std::string("%hand")});
        }
        map.legs.push_back({smpl_side + "hip", smpl_side + "knee", smpl_side + "ankle"});
    }
    return map;
}

}  // namespace softtissue
