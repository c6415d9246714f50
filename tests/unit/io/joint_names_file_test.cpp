// SPDX-License-Identifier: MIT
#include <softtissue/io/joint_names_file.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

const std::vector<std::string> names = {"Hips", "Neck", "Head", "Jaw", "Foot", "Toe"};

std::string refused(const TemporaryFolder& folder, const std::string& text) {
    write_bytes(folder / "names.json", text);
    return refusal([&] { read_joint_names(folder / "names.json", names); });
}

}  // namespace

TEST_CASE("joints get SMPL's numbers, extremities take what hangs below") {
    const TemporaryFolder folder;
    write_bytes(folder / "names.json", R"({"Head": "head", "Hips": "pelvis", "Foot": "left_ankle"})");
    const auto joints = read_joint_names(folder / "names.json", names);
    CHECK(joints == std::vector<std::int32_t>{0, -1, 15, -1, 7, -1});
    const KinematicTree tree({-1, 0, 1, 2, 0, 4});
    CHECK(smpl_extremities_of(tree, joints) == std::vector<std::vector<std::int32_t>>{{2, 3}, {4, 5}});
    CHECK(smpl_extremities_of(tree, std::vector<std::int32_t>(6, -1)).empty());
    CHECK(contains(refusal([&] { smpl_extremities_of(tree, {1}); }), "for 1 joints, expected 6"));
}

TEST_CASE("names that do not exist are refused with those that do") {
    const TemporaryFolder folder;
    CHECK(contains(refusal([&] { read_joint_names(folder / "none.json", names); }), "none.json: is no file"));
    CHECK(contains(refused(folder, "["), "names.json: expected a JSON object"));
    CHECK(contains(refused(folder, R"({"Hip": "pelvis"})"), "'Hip' is none of the skeleton's joints: Hips, Neck"));
    CHECK(contains(refused(folder, R"({"Hips": "hips"})"), "'hips' is none of SMPL's joints: pelvis, left_hip"));
    CHECK(contains(refused(folder, R"({"Hips": 3})"), "names.json: Hips = 3, expected a text"));
    CHECK(contains(refused(folder, R"({"Hips": "pelvis", "Neck": "pelvis"})"), "'pelvis' is given to two joints"));
}
