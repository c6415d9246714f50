// SPDX-License-Identifier: MIT
#include <softtissue/io/usda.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

using namespace softtissue;
using namespace io_test;

namespace {

const Connectivity<4> tet = (Connectivity<4>(4, 1) << 0, 1, 2, 3).finished();

Matrix3X<double> frame(int t) {
    const Matrix3X<double> x = (Matrix3X<double>(3, 4) << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1).finished();
    return (1.0 + t) * x;
}

Skeleton<double> arm() {
    Skeleton<double> skeleton;
    skeleton.joint_names = {"hand", "up per"};
    skeleton.tree = KinematicTree({1, -1});
    skeleton.joints = (Matrix3X<double>(3, 2) << 3, 1, 0, 0, 0.5, 0).finished();
    return skeleton;
}

/// Braces and brackets close in order, quotes in pairs.
bool is_balanced(const std::string& text) {
    std::string open;
    bool in_text = false;
    for (const char c : text) {
        in_text = in_text != (c == '"');
        if (in_text) {
            continue;
        }
        if (c == '(' || c == '[' || c == '{') {
            open += c;
        } else if (c == ')' || c == ']' || c == '}') {
            const char expected = c == ')' ? '(' : c == ']' ? '[' : '{';
            if (open.empty() || open.back() != expected) {
                return false;
            }
            open.pop_back();
        }
    }
    return open.empty() && !in_text;
}

}  // namespace

TEST_CASE("tets, surfaces and a skeleton over time") {
    const TemporaryFolder folder;
    UsdAnimation animation(24.0);
    const Index tissue = animation.add_tets({.name = "tissue", .tets = tet, .translation = {0.5, 0, 0}});
    const Index skin = animation.add_surface({.name = "skin", .triangles = surface_of_tets(tet), .color = {1, 0, 0}});
    animation.set_skeleton(arm());
    for (int t = 0; t < 3; ++t) {
        animation.add_frame(tissue, frame(t));
        Pose<double> pose = Pose<double>::rest(2);
        pose.rotation_vectors(2, 1) = t * std::acos(-1.0) / 2;
        pose.translation(1) = t;
        animation.add_pose(pose);
    }
    animation.add_frame(skin, frame(0).cast<float>());
    animation.write(folder / "a.usda");
    CHECK(folder.num_files() == 1);
    const std::string text = read_bytes(folder / "a.usda");
    CHECK(text.starts_with("#usda 1.0\n(\n"));
    CHECK(is_balanced(text));
    for (const char* part : {"defaultPrim = \"root\"",
                             "startTimeCode = 0",
                             "endTimeCode = 2",
                             "timeCodesPerSecond = 24",
                             "upAxis = \"Y\"",
                             "metersPerUnit = 1",
                             "def TetMesh \"tissue\"",
                             "int4[] tetVertexIndices = [(0, 1, 2, 3)]",
                             "int3[] surfaceFaceVertexIndices = [(1, 2, 3), (0, 3, 2), (0, 1, 3), (0, 2, 1)]",
                             "point3f[] points.timeSamples = {\n            0: [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, "
                             "0, 1)],\n            1: [(0, 0, "
                             "0), (2, 0, 0)",
                             "float3[] extent.timeSamples",
                             "2: [(0, 0, 0), (3, 3, 3)]",
                             "double3 xformOp:translate = (0.5, 0, 0)",
                             "def Mesh \"skin\"",
                             "int[] faceVertexCounts = [3, 3, 3, 3]",
                             "int[] faceVertexIndices = [1, 2, 3, 0, 3, 2, 0, 1, 3, 0, 2, 1]",
                             "point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]",
                             "primvars:displayColor = [(1, 0, 0)]",
                             "def SkelRoot \"rig\"",
                             "uniform token[] joints = [\"up_per\", \"up_per/hand\"]",
                             "bindTransforms = [((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (1, 0, 0, 1)), ((1, 0, 0, "
                             "0), (0, 1, 0, 0), (0, 0, 1, "
                             "0), (3, 0, 0.5, 1))]",
                             "(2, 0, 0.5, 1))]",
                             "rel skel:animationSource = </root/rig/motion>",
                             "quatf[] rotations.timeSamples",
                             "0: [(1, 0, 0, 0), (1, 0, 0, 0)]",
                             "1: [(0.70710677, 0, 0, 0.70710677), (1, 0, 0, 0)]",
                             "2: [(1, 2, 0), (2, 0, 0.5)]",
                             "half3[] scales = [(1, 1, 1), (1, 1, 1)]"}) {
        CAPTURE(part);
        CHECK(contains(text, part));
    }
}

TEST_CASE("what cannot be shown is refused, and no file appears") {
    const TemporaryFolder folder;
    CHECK(contains(refusal([] { UsdAnimation animation(0.0); }), "usda: frame rate is 0, expected > 0"));
    UsdAnimation animation(30.0);
    const auto written = [&] { return refusal([&] { animation.write(folder / "a.usda"); }); };
    CHECK(contains(written(), "a.usda: expected a usda animation with meshes or a skeleton"));
    CHECK(contains(refusal([&] { animation.add_tets({.name = "m", .tets = {}}); }), "mesh 'm' has 0 cells"));
    CHECK(contains(refusal([&] { animation.add_tets({.name = "m", .tets = -tet}); }), "of vertices from 0"));
    CHECK(contains(refusal([&] { animation.add_pose(Pose<double>::rest(2)); }), "pose of 2 joints, expected 0"));
    const Index mesh = animation.add_tets({.name = "m", .tets = tet});
    CHECK(contains(written(), "usda mesh 'm' has no frames"));
    const auto refused = [&](Index number, const Matrix3X<double>& x) {
        return refusal([&] { animation.add_frame(number, x); });
    };
    CHECK(contains(refused(1, frame(0)), "no mesh 1"));
    CHECK(contains(refused(mesh, frame(0).leftCols(3)), "mesh 'm' has cells with vertex 3, expected 0 to 2"));
    animation.add_frame(mesh, frame(0));
    CHECK(contains(refused(mesh, frame(0).leftCols(3)), "mesh 'm', frame 1 has 3 vertices, expected 4"));
    Matrix3X<double> broken = frame(0);
    broken(1, 2) = std::numeric_limits<double>::quiet_NaN();
    CHECK(contains(refused(mesh, broken), "mesh 'm', frame 1: vertex 2 is not finite"));
    Skeleton<double> twins = arm();
    twins.joint_names[1] = "hand";
    CHECK(contains(refusal([&] { animation.set_skeleton(twins); }), "usda: skeleton: joint name 'hand' appears twice"));
    animation.set_skeleton(arm());
    Pose<double> pose = Pose<double>::rest(2);
    pose.translation(0) = std::numeric_limits<double>::infinity();
    CHECK(contains(refusal([&] { animation.add_pose(pose); }), "usda: pose 0 is not finite"));
    CHECK(contains(refusal([&] { animation.add_pose(Pose<double>::rest(3)); }), "pose of 3 joints, expected 2"));
    CHECK(folder.num_files() == 0);
    animation.write(folder / "a.usda");
    CHECK(is_balanced(read_bytes(folder / "a.usda")));
    CHECK(contains(refusal([&] { animation.write(folder / "none/a.usda"); }), "none/a.usda: cannot write"));
}
