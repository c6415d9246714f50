// SPDX-License-Identifier: MIT
/// @file
/// Bodies in SMPL's file layout (.npz): read, checked, and written.
///
/// What        v_template (n, 3), f (m, 3), weights (n, J), kintree_table (2, J), J_regressor (J, n), shapedirs (n, 3, k),
///             posedirs (n, 3, 9 (J - 1)), optional joint_names (J); other arrays are ignored.
///             J_regressor and posedirs may instead be stored as the parts of a compressed-row matrix
///             <name>_{data, indices, indptr, shape}; posedirs then has one row per vertex and the column
///             9 (J - 1) c + k for coordinate c.
/// Tree        row 0 of kintree_table is the id of the parent, row 1 the joint's own id; the root's parent is
///             4294967295, -1 or the root itself. Joint j is column j.
/// Units       metres; see SmplBody.
/// Refuses     missing arrays, shapes that do not fit, values that are not finite, weights that do not sum to one, a
///             kinematic tree that is none or does not start in joint 0; unless SmplSurface::any is asked for, a surface that is
///             not closed and manifold, as SMPL-X's is not (InvalidInput names the file).
/// Source      Loper et al. 2015 (SMPL)
/// Tests       tests/unit/io/smpl_file_test.cpp
#pragma once

#if !defined(__cpp_exceptions) && !defined(_CPPUNWIND)
#error "softtissue: io/smpl_file.hpp needs exceptions; without them, leave it out"
#endif

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/io/csr_arrays.hpp>
#include <softtissue/io/npz.hpp>
#include <softtissue/mesh/validate_surface.hpp>
#include <softtissue/skinning/smpl_body.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace softtissue {

namespace detail {

/// The result of `make`; if that refuses its input, the message is preceded by the file's name.
template <class Make>
auto made_from_file(const std::string& file, const Make& make) {
    try {
        return make();
    } catch (const InvalidInput& error) {
        throw_invalid_input(file, ": ", error.what());
    }
}

inline KinematicTree read_kinematic_tree(const NpzFile& file) {
    const NpyArray& table = file.at("kintree_table");
    table.require_shape({2, NpyArray::any});
    const std::vector<std::int64_t> entries = table.as<std::int64_t>();
    const std::size_t joints = entries.size() / 2;
    std::map<std::int64_t, std::int32_t> joint_of_id;
    for (std::size_t j = 0; j < joints; ++j) {
        const bool is_new = joint_of_id.emplace(entries[joints + j], std::int32_t(j)).second;
        require(is_new, table.source(), ": joint id ", entries[joints + j], " appears twice in row 1");
    }
    std::vector<std::int32_t> parents(joints);
    for (std::size_t j = 0; j < joints; ++j) {
        const std::int64_t parent = entries[j];
        const bool is_root = parent == -1 || parent == 4294967295 || parent == entries[joints + j];
        require(is_root || joint_of_id.count(parent) > 0, table.source(), ": parent of joint ", j, " is ", parent,
                ", expected the id of a joint, or -1 for the root");
        parents[j] = is_root ? KinematicTree::no_parent : joint_of_id[parent];
    }
    return made_from_file(file.path(), [&] { return KinematicTree(std::move(parents)); });
}

/// joints x n, from a dense array or compressed rows.
template <RealScalar S>
typename SmplBody<S>::SparseMatrix read_joint_regressor(const NpzFile& file, Index joints, Index n) {
    typename SmplBody<S>::SparseMatrix regressor(joints, n);
    if (file.contains("J_regressor")) {
        const NpyArray& array = file.at("J_regressor");
        array.require_shape({joints, n});
        append_dense_rows(array, regressor);
        return regressor;
    }
    const CsrArrays<S> rows(file, "J_regressor", {joints, n});
    for (Index j = 0; j < joints; ++j) {
        regressor.startVec(j);
        for (const auto& [column, value] : rows.sorted_row(j)) {
            regressor.insertBack(j, column) = value;
        }
    }
    regressor.finalize();
    return regressor;
}

/// 3n x columns, from a dense (n, 3, columns) array or compressed rows of 3 columns' width.
template <RealScalar S>
typename SmplBody<S>::SparseMatrix read_pose_directions(const NpzFile& file, Index n, Index columns) {
    typename SmplBody<S>::SparseMatrix directions(3 * n, columns);
    if (file.contains("posedirs")) {
        const NpyArray& array = file.at("posedirs");
        array.require_shape({n, 3, columns});
        append_dense_rows(array, directions);
        return directions;
    }
    const CsrArrays<S> rows(file, "posedirs", {n, 3, columns});
    for (Index v = 0; v < n; ++v) {
        const std::vector<CsrEntry<S>> row = rows.sorted_row(v);
        std::size_t next = 0;
        for (Index c = 0; c < 3; ++c) {
            directions.startVec(3 * v + c);
            for (; next < row.size() && row[next].column < (c + 1) * columns; ++next) {
                directions.insertBack(3 * v + c, row[next].column - c * columns) = row[next].value;
            }
        }
    }
    directions.finalize();
    return directions;
}

}  // namespace detail

/// What a body is read for: closed surfaces can hold tissue, any one can be skinned.
enum class SmplSurface { closed, any };

/// The body in `path`, checked completely.
template <RealScalar S>
SmplBody<S> read_smpl_body(const std::filesystem::path& path, SmplSurface surface = SmplSurface::closed) {
    const NpzFile file = read_npz(path);
    SmplBody<S> body;
    body.template_vertices = file.at("v_template").columns3<S>();
    body.faces = file.at("f").columns<std::int32_t, 3>();
    body.tree = detail::read_kinematic_tree(file);
    const Index n = body.num_vertices();
    const Index joints = body.num_joints();

    const NpyArray& weights = file.at("weights");
    weights.require_shape({n, joints});
    body.weights = detail::made_from_file(file.path(), [&] { return SkinningWeights<S>(weights.matrix<S>()); });
    body.joint_regressor = detail::read_joint_regressor<S>(file, joints, n);

    const NpyArray& shapes = file.at("shapedirs");
    shapes.require_shape({n, 3, NpyArray::any});
    const Index num_shapes = shapes.shape()[2];
    body.shape_directions.resize(3 * n, num_shapes);
    shapes.for_each<S>([&](Index i, S value) { body.shape_directions(i / num_shapes, i % num_shapes) = value; });

    body.pose_directions = detail::read_pose_directions<S>(file, n, 9 * (joints - 1));
    if (file.contains("joint_names")) {
        body.joint_names = file.at("joint_names").strings();
    }
    body.validate(file.path());
    if (surface == SmplSurface::closed) {
        validate_closed_surface(body.template_vertices, body.faces, file.path());
    }
    return body;
}

/// Writes `body` in the same layout: dense J_regressor, compressed-row posedirs.
template <RealScalar S>
void write_smpl_body(const std::filesystem::path& path, const SmplBody<S>& body,
                     NpzCompression compression = NpzCompression::deflated) {
    body.validate(path.string());
    const Index n = body.num_vertices();
    const Index joints = body.num_joints();
    NpyArrays arrays;
    arrays["v_template"] = NpyArray::from_columns(body.template_vertices);
    arrays["f"] = NpyArray::from_columns(body.faces);
    arrays["weights"] = NpyArray::from_matrix(body.weights.dense());
    arrays["J_regressor"] = NpyArray::from_matrix(MatrixX<S>(body.joint_regressor));
    const MatrixX<S> shapes = body.shape_directions.transpose();
    arrays["shapedirs"] =
        NpyArray::from_values(std::span<const S>(shapes.data(), std::size_t(shapes.size())), {n, 3, body.num_shapes()});

    std::vector<std::uint32_t> tree;
    for (Index j = 0; j < joints; ++j) {
        tree.push_back(static_cast<std::uint32_t>(body.tree.parent(j)));  // the root's -1 becomes 4294967295
    }
    for (Index j = 0; j < joints; ++j) {
        tree.push_back(static_cast<std::uint32_t>(j));
    }
    arrays["kintree_table"] = NpyArray::from_values(std::span<const std::uint32_t>(tree), {2, joints});

    CsrArrays<S> posedirs({n, 3, 9 * (joints - 1)});
    for (Index r = 0; r < body.pose_directions.outerSize(); ++r) {
        for (typename SmplBody<S>::SparseMatrix::InnerIterator entry(body.pose_directions, r); entry; ++entry) {
            posedirs.append(r / 3, r % 3 * body.pose_directions.cols() + entry.col(), entry.value());
        }
    }
    posedirs.store(arrays, "posedirs");
    if (!body.joint_names.empty()) {
        arrays["joint_names"] = NpyArray::from_strings(body.joint_names, {joints});
    }
    write_npz(path, arrays, compression);
}

}  // namespace softtissue
