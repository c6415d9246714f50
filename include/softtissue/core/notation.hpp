// SPDX-License-Identifier: MIT
/// @file
/// The library's letters, array shapes and the one order of vec().
///
/// Letters     X rest position [m], x current position [m], F deformation gradient [-], J = det F,
///             P first Piola stress [Pa], H = d vec(P) / d vec(F), 9x9 [Pa], vec = column-major.
/// Shapes      positions 3 x n column-major (xyz xyz xyz in memory), dof = 3 * vertex + component,
///             connectivity num_nodes x cells, 32-bit.
/// Binding     ConstRef<Matrix3X<S>> binds without a copy to a 3 x n column-major matrix, to leading columns,
///             and to the transpose of a row-major n x 3 array (NumPy C order); the transpose of a
///             column-major n x 3 matrix is copied.
/// Tests       tests/unit/core/notation_test.cpp
#pragma once

#include <Eigen/Core>

#include <cstdint>

namespace softtissue {

using Index = Eigen::Index;

template <class Scalar>
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
template <class Scalar>
using Vector9 = Eigen::Matrix<Scalar, 9, 1>;
template <class Scalar>
using VectorX = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;
template <class Scalar>
using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;
template <class Scalar>
using Matrix9 = Eigen::Matrix<Scalar, 9, 9>;
template <class Scalar>
using MatrixX = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

/// Positions, displacements or forces of n vertices, 3 x n.
template <class Scalar>
using Matrix3X = Eigen::Matrix<Scalar, 3, Eigen::Dynamic>;

/// Vertex indices of the cells of a mesh, num_nodes x cells.
template <int num_nodes>
using Connectivity = Eigen::Matrix<std::int32_t, num_nodes, Eigen::Dynamic>;

/// Vertex indices of triangles, 3 x triangles, counter-clockwise seen from outside.
using Triangles = Connectivity<3>;

/// A read-only array argument.
template <class T>
using ConstRef = const Eigen::Ref<const T>&;

/// vec(F): the columns of F stacked.
template <class Scalar>
Vector9<Scalar> vec(const Matrix3<Scalar>& F) {
    return Eigen::Map<const Vector9<Scalar>>(F.data());
}

/// The inverse of vec().
template <class Scalar>
Matrix3<Scalar> unvec(const Vector9<Scalar>& f) {
    return Eigen::Map<const Matrix3<Scalar>>(f.data());
}

}  // namespace softtissue
