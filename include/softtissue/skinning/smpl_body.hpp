// SPDX-License-Identifier: MIT
/// @file
/// The data of a body in SMPL's form, as read from a file, generated, or carried into a volume.
///
/// What        rest vertices, triangles, skeleton, skinning weights, shape and pose blend shapes, joint regressor.
/// Shapes      template_vertices 3 x n [m]; faces 3 x m (may be empty: a volume); weights n x joints;
///             joint_regressor joints x n;
///             shape_directions 3n x num_shapes [m per standard deviation], row 3v + d;
///             pose_directions 3n x 9 (joints - 1) [m], sparse; column 9 (j - 1) + 3 a + b multiplies (R_j - I)[a, b].
///             The root is joint 0: its rotation moves the whole body and has no pose blend shape.
/// Refuses     validate(): shapes that do not fit together, values that are not finite, another root
///             (InvalidInput names the array).
/// Source      Loper et al. 2015 (SMPL); Romero et al. 2020, eq. (1).
/// Departs     std headers only elsewhere in skinning/; here Eigen/SparseCore, for the pose blend shapes (93 % zeros on real bodies).
/// Tests       tests/unit/skinning/smpl_body_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>
#include <softtissue/skinning/weights.hpp>

#include <Eigen/SparseCore>

#include <cmath>
#include <string>
#include <vector>

namespace softtissue {

template <RealScalar S>
struct SmplBody {
    using Scalar = S;
    using SparseMatrix = Eigen::SparseMatrix<Scalar, Eigen::RowMajor>;

    Matrix3X<Scalar> template_vertices;
    Triangles faces;
    KinematicTree tree{{KinematicTree::no_parent}};
    SkinningWeights<Scalar> weights;
    SparseMatrix joint_regressor;       // joints x n
    MatrixX<Scalar> shape_directions;   // 3n x shapes
    SparseMatrix pose_directions;       // 3n x 9 (joints - 1)
    std::vector<std::string> joint_names;  // empty, or one per joint

    Index num_vertices() const { return template_vertices.cols(); }
    Index num_joints() const { return tree.num_joints(); }
    Index num_shapes() const { return shape_directions.cols(); }

    /// Throws InvalidInput unless all arrays fit together and are finite; `source` (a file name) starts the message.
    void validate(const std::string& source) const {
        const Index n = num_vertices();
        const Index joints = num_joints();
        require(n > 0, source, ": v_template has no vertices");
        require(tree.root() == 0, source, ": the root is joint ", tree.root(), ", expected 0");
        require_shape(source, "weights", weights.num_vertices(), weights.num_joints(), n, joints);
        require_shape(source, "J_regressor", joint_regressor.rows(), joint_regressor.cols(), joints, n);
        require_shape(source, "shapedirs (3n x shapes)", shape_directions.rows(), shape_directions.cols(), 3 * n,
                      num_shapes());
        require_shape(source, "posedirs (3n x 9(joints-1))", pose_directions.rows(), pose_directions.cols(), 3 * n,
                      9 * (joints - 1));
        for (Index v = 0; v < n; ++v) {
            require(template_vertices.col(v).allFinite(), source, ": v_template of vertex ", v,
                    " is not finite");
        }
        for (Index r = 0; num_shapes() > 0 && r < shape_directions.rows(); ++r) {
            require(shape_directions.row(r).allFinite(), source, ": shapedirs of vertex ", r / 3, " is not finite");
        }
        require_finite(source, "J_regressor", joint_regressor);
        require_finite(source, "posedirs", pose_directions);
        require(joint_names.empty() || Index(joint_names.size()) == joints, source, ": ", joint_names.size(),
                " joint names, expected ", joints);
        for (Index f = 0; f < faces.cols(); ++f) {
            for (int k = 0; k < 3; ++k) {
                require(faces(k, f) >= 0 && faces(k, f) < n, source, ": f[", f, ", ", k, "] = ", faces(k, f),
                        ", expected a vertex from 0 to ", n - 1);
            }
        }
    }

    /// The same body in another precision.
    template <RealScalar T>
    SmplBody<T> cast() const {
        return {template_vertices.template cast<T>(),
                faces,
                tree,
                SkinningWeights<T>(weights.dense().template cast<T>().eval()),
                joint_regressor.template cast<T>(),
                shape_directions.template cast<T>(),
                pose_directions.template cast<T>(),
                joint_names};
    }

private:
    static void require_shape(const std::string& source, const char* name, Index rows, Index cols,
                              Index expected_rows, Index expected_cols) {
        require(rows == expected_rows && cols == expected_cols, source, ": ", name, " is ", rows, " x ", cols,
                ", expected ", expected_rows, " x ", expected_cols);
    }
    static void require_finite(const std::string& source, const char* name, const SparseMatrix& m) {
        for (Index r = 0; r < m.outerSize(); ++r) {
            for (typename SparseMatrix::InnerIterator entry(m, r); entry; ++entry) {
                require(std::isfinite(entry.value()), source, ": ", name, "[", r, ", ", entry.col(), "] = ",
                        entry.value(), ", expected a finite value");
            }
        }
    }
};

}  // namespace softtissue
