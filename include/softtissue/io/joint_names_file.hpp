// SPDX-License-Identifier: MIT
/// @file
/// Which joints of a skeleton are which of SMPL's: a JSON file from names to names, for programs that ask for SMPL's joints.
///
/// What        {"mixamorig:Head": "head", "mixamorig:LeftFoot": "left_ankle", ...}: any joints, as many as are needed.
///             smpl_extremities_of(): the groups of joints of head, feet and hands, with all joints below them.
/// Refuses     a file that is no such object, a name that the skeleton does not have, a name that is none of SMPL's, two joints
///             for one (InvalidInput names the file and the joint and lists the names).
/// Needs       nlohmann-json
/// Tests       tests/unit/io/joint_names_file_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/io/json_element.hpp>
#include <softtissue/skinning/joint_map.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace softtissue {

/// Per joint of the skeleton the number of SMPL's joint, or -1.
inline std::vector<std::int32_t> read_joint_names(const std::filesystem::path& path,
                                                  const std::vector<std::string>& joint_names) {
    const std::string file = path.string();
    require(std::filesystem::is_regular_file(path), file, ": is no file, expected names of joints (.json)");
    std::ifstream stream(path, std::ios::binary);
    const nlohmann::json json = nlohmann::json::parse(stream, nullptr, false);
    require(json.is_object(), file, ": expected a JSON object from names of joints to names of SMPL's joints");
    const std::vector<std::string> smpl_names = smpl_joint_names();
    std::vector<std::int32_t> result(joint_names.size(), -1);
    const auto number_of = [&](const std::vector<std::string>& names, const std::string& name, const char* whose) {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) {
            std::string all;
            for (const std::string& other : names) {
                all += (all.empty() ? "" : ", ") + other;
            }
            throw_invalid_input(file, ": '", name, "' is none of ", whose, " joints: ", all);
        }
        return found - names.begin();
    };
    for (const auto& [name, value] : json.items()) {
        const auto joint = size_t(number_of(joint_names, name, "the skeleton's"));
        const std::string smpl_name = JsonElement(file + ": " + name, value).text();
        const auto smpl_joint = static_cast<std::int32_t>(number_of(smpl_names, smpl_name, "SMPL's"));
        require(std::find(result.begin(), result.end(), smpl_joint) == result.end(), file, ": '", smpl_name,
                "' is given to two joints, the second is '", name, "'");
        result[joint] = smpl_joint;
    }
    return result;
}

/// Head; left and right foot; left and right hand: in each group the joints that are SMPL's and all below them.
inline std::vector<std::vector<std::int32_t>> smpl_extremities_of(const KinematicTree& tree,
                                                                  const std::vector<std::int32_t>& smpl_joints) {
    require(Index(smpl_joints.size()) == tree.num_joints(), "joint names: for ", smpl_joints.size(),
            " joints, expected ", tree.num_joints());
    const std::vector<std::vector<std::string>> wanted = {{"head"},
                                                          {"left_ankle", "right_ankle", "left_foot", "right_foot"},
                                                          {"left_wrist", "right_wrist", "left_hand", "right_hand"}};
    const std::vector<std::string> names = smpl_joint_names();
    std::vector<std::vector<std::int32_t>> groups;
    for (const std::vector<std::string>& group_names : wanted) {
        std::vector<bool> belongs(smpl_joints.size(), false);
        std::vector<std::int32_t> group;
        for (const std::int32_t j : tree.order()) {
            const std::int32_t smpl = smpl_joints[size_t(j)];
            const std::int32_t parent = tree.parent(j);
            const bool is_named = smpl >= 0 && std::find(group_names.begin(), group_names.end(), names[size_t(smpl)]) !=
                                                   group_names.end();
            belongs[size_t(j)] = is_named || (parent != KinematicTree::no_parent && belongs[size_t(parent)]);
            if (belongs[size_t(j)]) {
                group.push_back(j);
            }
        }
        if (!group.empty()) {
            std::sort(group.begin(), group.end());
            groups.push_back(std::move(group));
        }
    }
    return groups;
}

}  // namespace softtissue
