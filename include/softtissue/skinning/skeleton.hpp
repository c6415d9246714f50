// SPDX-License-Identifier: MIT
/// @file
/// A skeleton with names: what is needed to say which joint of one is which joint of another.
///
/// What        joint names, kinematic tree, rest positions.
/// Shapes      one name per joint; joints 3 x num_joints [m].
/// Refuses     validate(): arrays that do not fit together, positions that are not finite, a name that appears twice;
///             joint(): a name that the skeleton does not have (InvalidInput names it).
/// Tests       tests/unit/skinning/skeleton_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace softtissue {

template <RealScalar S>
struct Skeleton {
    using Scalar = S;

    std::vector<std::string> joint_names;
    KinematicTree tree{{KinematicTree::no_parent}};
    Matrix3X<Scalar> joints;

    Index num_joints() const { return tree.num_joints(); }

    bool has_joint(std::string_view name) const {
        return std::find(joint_names.begin(), joint_names.end(), name) != joint_names.end();
    }

    /// The number of the joint `name`.
    std::int32_t joint(std::string_view name) const {
        const auto found = std::find(joint_names.begin(), joint_names.end(), name);
        if (found == joint_names.end()) {
            std::string names;
            for (const std::string& other : joint_names) {
                names += (names.empty() ? "" : ", ") + other;
            }
            throw_invalid_input("skeleton: no joint '", name, "'; it has ", names);
        }
        return static_cast<std::int32_t>(found - joint_names.begin());
    }

    /// Throws InvalidInput unless all arrays fit together; `source` starts the message.
    void validate(const std::string& source) const {
        require(Index(joint_names.size()) == num_joints(), source, ": ", joint_names.size(), " joint names, expected ",
                num_joints());
        require(joints.cols() == num_joints(), source, ": ", joints.cols(), " rest joints, expected ", num_joints());
        std::set<std::string_view> names;
        for (Index j = 0; j < num_joints(); ++j) {
            const std::string& name = joint_names[size_t(j)];
            require(names.insert(name).second, source, ": joint name '", name, "' appears twice");
            require(joints.col(j).allFinite(), source, ": rest position of joint ", j, " (", name, ") is not finite");
        }
    }
};

}  // namespace softtissue
