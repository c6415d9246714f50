// SPDX-License-Identifier: MIT
/// @file
/// Tetrahedral and triangle meshes and a skeleton over time as OpenUSD text (.usda), for DCC tools and simulators.
///
/// What        UsdGeom Mesh and TetMesh with points per frame, UsdSkel Skeleton and SkelAnimation. What has one frame stands still.
/// Order       a cell with positive volume is right-handed in USD: node order as in Tet4, faces 123, 032, 013, 021 outwards; the
///             surface of a TetMesh are the faces that one cell has.
/// Skeleton    joints are paths ("pelvis/spine"), parents first; rest frames are parallel to the axes, so that a Pose's rotations
///             are the file's; the root's translation is its rest place plus that of the pose.
/// Example     UsdAnimation animation(30.0);
///             const Index tissue = animation.add_tets({.name = "tissue", .tets = mesh.cells});
///             for (const Matrix3X<double>& x : frames) { animation.add_frame(tissue, x); }
///             animation.write("tissue.usda");
/// Shapes      positions 3 x n, triangles 3 x m, tets 4 x m. Prisms: mesh/split_prisms.hpp first.
/// Units       metres, y up; frame rate [1/s]
/// Valid       points are stored as float32 in the shortest decimal form that gives them back. Names become identifiers of USD: other
///             characters are '_', names that coincide are numbered.
/// Refuses     meshes without cells, frames of different size, values that are not finite, vertices out of range, poses of another
///             skeleton, a mesh without frames (InvalidInput names mesh and frame).
/// Source      Pixar, "OpenUSD: UsdGeom" (Mesh, TetMesh), "UsdSkel", USDA text format
/// Tests       tests/unit/io/usda_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/io/atomic_file.hpp>
#include <softtissue/io/usd_text.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/mesh/tet_surface.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>
#include <softtissue/skinning/pose.hpp>
#include <softtissue/skinning/skeleton.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace softtissue {

struct UsdSurface {
    std::string name;
    Triangles triangles;
    Vector3<double> translation = Vector3<double>::Zero();  ///< moves the whole mesh [m]
    Vector3<double> color = Vector3<double>::Constant(0.8);
};

struct UsdTets {
    std::string name;
    Connectivity<4> tets;
    Vector3<double> translation = Vector3<double>::Zero();
    Vector3<double> color = Vector3<double>::Constant(0.8);
};

class UsdAnimation {
public:
    explicit UsdAnimation(double frame_rate) : frame_rate_(frame_rate) {
        require(frame_rate > 0.0 && frame_rate <= std::numeric_limits<double>::max(), "usda: frame rate is ",
                frame_rate, ", expected > 0");
    }

    /// Announces a mesh; returns its number for add_frame().
    Index add_surface(const UsdSurface& mesh) {
        std::string cells = "        uniform token subdivisionScheme = \"none\"\n        int[] faceVertexCounts = [";
        for (Index t = 0; t < mesh.triangles.cols(); ++t) {
            cells += t == 0 ? "3" : ", 3";
        }
        cells += "]\n        int[] faceVertexIndices = [";
        for (Index i = 0; i < mesh.triangles.size(); ++i) {
            cells += i == 0 ? "" : ", ";
            append_usd_number(cells, mesh.triangles.data()[i]);
        }
        return add_mesh("Mesh", mesh, mesh.triangles, cells + "]\n");
    }

    Index add_tets(const UsdTets& mesh) {
        std::string cells = "        int4[] tetVertexIndices = ";
        append_usd_tuples(cells, mesh.tets);
        cells += "\n        int3[] surfaceFaceVertexIndices = ";
        append_usd_tuples(cells, surface_of_tets(mesh.tets));
        return add_mesh("TetMesh", mesh, mesh.tets, cells + "\n");
    }

    /// Appends the next frame of `mesh`, positions 3 x n.
    template <class Derived>
    void add_frame(Index mesh, const Eigen::MatrixBase<Derived>& positions) {
        append_frame(mesh, positions.template cast<float>());
    }

    /// The skeleton whose poses follow by add_pose().
    void set_skeleton(const Skeleton<double>& skeleton) {
        skeleton.validate("usda: skeleton");
        skeleton_ = skeleton;
        joint_paths_.assign(std::size_t(skeleton.num_joints()), "");
        std::set<std::string> used;
        for (const std::int32_t j : skeleton.tree.order()) {
            const std::int32_t parent = skeleton.tree.parent(j);
            const std::string above = parent == KinematicTree::no_parent ? "" : joint_paths_[std::size_t(parent)] + "/";
            joint_paths_[std::size_t(j)] = above + usd_identifier(skeleton.joint_names[std::size_t(j)], used);
        }
    }

    void add_pose(const Pose<double>& pose) {
        require(!joint_paths_.empty() && pose.rotation_vectors.cols() == skeleton_.num_joints(), "usda: pose of ",
                pose.rotation_vectors.cols(), " joints, expected ", joint_paths_.empty() ? 0 : skeleton_.num_joints(),
                " as in the skeleton that was set");
        require(pose.rotation_vectors.allFinite() && pose.translation.allFinite(), "usda: pose ", rotations_.size(),
                " is not finite");
        Eigen::Matrix<float, 4, Eigen::Dynamic> rotations(4, skeleton_.num_joints());
        Matrix3X<float> translations(3, skeleton_.num_joints());
        Index i = 0;
        for (const std::int32_t j : skeleton_.tree.order()) {
            rotations.col(i) = quaternion_from_rotation_vector<double>(pose.rotation_vectors.col(j)).cast<float>();
            translations.col(i) =
                (local_place(j) + (i == 0 ? pose.translation : Vector3<double>::Zero())).cast<float>();
            ++i;
        }
        rotations_.add(rotations);
        translations_.add(translations);
    }

    /// Writes the file, complete or not at all.
    void write(const std::filesystem::path& path) const {
        const std::string file = path.string();
        require(!meshes_.empty() || !joint_paths_.empty(), file,
                ": expected a usda animation with meshes or a skeleton");
        Index frames = std::max(Index(1), rotations_.size());
        for (const Mesh& mesh : meshes_) {
            require(mesh.points.size() > 0, file, ": usda mesh '", mesh.name, "' has no frames");
            frames = std::max(frames, mesh.points.size());
        }
        std::string text = "#usda 1.0\n(\n    defaultPrim = \"root\"\n    endTimeCode = " + std::to_string(frames - 1) +
                           "\n    framesPerSecond = ";
        append_usd_number(text, frame_rate_);
        text += "\n    metersPerUnit = 1\n    startTimeCode = 0\n    timeCodesPerSecond = ";
        append_usd_number(text, frame_rate_);
        text += "\n    upAxis = \"Y\"\n)\n\ndef Xform \"root\"\n{\n";
        for (const Mesh& mesh : meshes_) {
            text += "    def " + mesh.kind + " \"" + mesh.name + "\"\n    {\n" + mesh.properties;
            mesh.points.append_to(text, "point3f[] points");
            mesh.extents.append_to(text, "float3[] extent");
            text += "    }\n";
        }
        append_skeleton(text);
        text += "}\n";
        AtomicFile output(path);
        output.write(text);
        output.commit();
    }

private:
    struct Mesh {
        std::string kind, name, properties;
        std::int32_t last_vertex = 0;  // of its cells
        Index num_vertices = 0;
        UsdSamples points, extents;
    };

    template <class Description, class Cells>
    Index add_mesh(const char* kind, const Description& mesh, const Cells& cells, std::string properties) {
        require(cells.cols() > 0 && cells.minCoeff() >= 0, "usda: mesh '", mesh.name, "' has ", cells.cols(),
                " cells, expected some, of vertices from 0");
        require(mesh.translation.allFinite() && mesh.color.allFinite(), "usda: mesh '", mesh.name,
                "': translation or colour is not finite");
        properties += "        color3f[] primvars:displayColor = ";
        append_usd_tuples(properties, mesh.color.template cast<float>());
        properties += "\n        double3 xformOp:translate = ";
        std::string place;
        append_usd_tuples(place, mesh.translation);
        properties +=
            place.substr(1, place.size() - 2) + "\n        uniform token[] xformOpOrder = [\"xformOp:translate\"]\n";
        meshes_.push_back(
            {kind, usd_identifier(mesh.name, names_), std::move(properties), cells.maxCoeff(), 0, {}, {}});
        return Index(meshes_.size()) - 1;
    }

    void append_frame(Index number, const Matrix3X<float>& positions) {
        require(number >= 0 && number < Index(meshes_.size()), "usda: no mesh ", number, " to add a frame to");
        Mesh& mesh = meshes_[std::size_t(number)];
        const Index frame = mesh.points.size();
        for (Index v = 0; v < positions.cols(); ++v) {
            require(positions.col(v).allFinite(), "usda: mesh '", mesh.name, "', frame ", frame, ": vertex ", v,
                    " is not finite");
        }
        require(frame > 0 || mesh.last_vertex < positions.cols(), "usda: mesh '", mesh.name, "' has cells with vertex ",
                mesh.last_vertex, ", expected 0 to ", positions.cols() - 1);
        require(frame == 0 || positions.cols() == mesh.num_vertices, "usda: mesh '", mesh.name, "', frame ", frame,
                " has ", positions.cols(), " vertices, expected ", mesh.num_vertices);
        mesh.num_vertices = positions.cols();
        mesh.points.add(positions);
        Matrix3X<float> extent(3, 2);
        extent << positions.rowwise().minCoeff(), positions.rowwise().maxCoeff();
        mesh.extents.add(extent);
    }

    /// Of a joint in the frame of its parent.
    Vector3<double> local_place(std::int32_t joint) const {
        const std::int32_t parent = skeleton_.tree.parent(joint);
        const Vector3<double> place = skeleton_.joints.col(joint);
        return parent == KinematicTree::no_parent ? place : Vector3<double>(place - skeleton_.joints.col(parent));
    }

    /// Rows of a matrix that moves row vectors by `place`.
    static void append_translation(std::string& text, const Vector3<double>& place) {
        text += text.back() == '[' ? "" : ", ";
        text += "((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (";
        for (const double x : place) {
            append_usd_number(text, x);
            text += ", ";
        }
        text += "1))";
    }

    void append_skeleton(std::string& text) const {
        if (joint_paths_.empty()) {
            return;
        }
        std::string joints = "        uniform token[] joints = [";
        std::string bind = "        uniform matrix4d[] bindTransforms = [";
        std::string rest = "        uniform matrix4d[] restTransforms = [";
        std::string scales = "        half3[] scales = [";
        for (const std::int32_t j : skeleton_.tree.order()) {
            joints += (joints.back() == '[' ? "\"" : ", \"") + joint_paths_[std::size_t(j)] + "\"";
            append_translation(bind, skeleton_.joints.col(j));
            append_translation(rest, local_place(j));
            scales += scales.back() == '[' ? "(1, 1, 1)" : ", (1, 1, 1)";
        }
        const bool moves = rotations_.size() > 0;
        text +=
            "    def SkelRoot \"rig\"\n    {\n        def Skeleton \"skeleton\" (\n"
            "            prepend apiSchemas = [\"SkelBindingAPI\"]\n        )\n        {\n";
        text += joints + "]\n" + bind + "]\n" + rest + "]\n";
        text += moves ? "        rel skel:animationSource = </root/rig/motion>\n        }\n" : "        }\n";
        if (moves) {
            text += "        def SkelAnimation \"motion\"\n        {\n" + joints + "]\n" + scales + "]\n";
            rotations_.append_to(text, "quatf[] rotations");
            translations_.append_to(text, "float3[] translations");
            text += "        }\n";
        }
        text += "    }\n";
    }

    double frame_rate_;
    std::vector<Mesh> meshes_;
    std::set<std::string> names_{"rig"};
    Skeleton<double> skeleton_;
    std::vector<std::string> joint_paths_;  // empty: no skeleton
    UsdSamples rotations_, translations_;
};

}  // namespace softtissue
