// SPDX-License-Identifier: MIT
/// @file
/// Material axes that follow the skin: the first along its normal, the others any tangents.
///
/// What        one orthonormal basis per cell, from normals at the vertices of its mesh.
/// Equation    B = [n, s, n x s], n the normalised mean of the nodes' normals, s a unit tangent; det B = 1.
/// Shapes      vertex normals 3 x vertices, unit or not; one 3x3 per cell.
/// Valid       the tangents jump where the smallest component of n changes place: the material is isotropic tangentially.
/// Refuses     a cell whose nodes' normals cancel (InvalidInput names it).
/// Source      Romero et al. 2020, section 4.3 (axes B of the strain B^T E B).
/// Tests       tests/unit/anatomy/orthotropy_basis_test.cpp
#pragma once

#include <softtissue/anatomy/soft_layer.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/surface_normals.hpp>

#include <Eigen/Geometry>

#include <limits>
#include <vector>

namespace softtissue {

/// The basis [n, s, n x s] of a unit vector n: s is orthogonal to n and to the axis that n is least along.
template <RealScalar S>
Matrix3<S> basis_along(const Vector3<S>& n) {
    Index axis = 0;
    n.cwiseAbs().minCoeff(&axis);
    const Vector3<S> s = n.cross(Vector3<S>::Unit(axis)).normalized();
    Matrix3<S> basis;
    basis << n, s, n.cross(s);
    return basis;
}

/// One basis per cell of `cells`, from a normal per vertex.
template <RealScalar S, int num_nodes>
std::vector<Matrix3<S>> orthotropy_bases(const Connectivity<num_nodes>& cells, const Matrix3X<S>& vertex_normals) {
    std::vector<Matrix3<S>> bases;
    bases.reserve(size_t(cells.cols()));
    for (Index c = 0; c < cells.cols(); ++c) {
        Vector3<S> sum = Vector3<S>::Zero();
        for (int k = 0; k < num_nodes; ++k) {
            sum += vertex_normals.col(cells(k, c));
        }
        const S length = sum.norm();
        require(length > S(100) * std::numeric_limits<S>::epsilon(), "orthotropy basis: the normals of cell ", c,
                " cancel (their sum has length ", length, "), expected a common direction");
        bases.push_back(basis_along<S>(sum / length));
    }
    return bases;
}

/// The skin's normal above each vertex of the layer, 3 x vertices: every level of a column has that at its end.
template <RealScalar S>
Matrix3X<S> column_normals(const SoftLayer<S>& layer) {
    const Matrix3X<S> skin_normals = vertex_normals(layer.skin_positions, layer.region.triangles);
    Matrix3X<S> normals(3, layer.mesh.num_vertices());
    for (Index v = 0; v < normals.cols(); ++v) {
        normals.col(v) = skin_normals.col(layer.layers.column(v));
    }
    return normals;
}

/// One basis per prism of the layer.
template <RealScalar S>
std::vector<Matrix3<S>> orthotropy_bases(const SoftLayer<S>& layer) {
    return orthotropy_bases(layer.mesh.cells, column_normals(layer));
}

}  // namespace softtissue
