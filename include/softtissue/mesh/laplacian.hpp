// SPDX-License-Identifier: MIT
/// @file
/// Cotangent Laplacian and vertex masses of triangle surfaces and tet meshes.
///
/// What        cotangent_laplacian (stiffness of linear functions), barycentric_masses, voronoi_masses
/// Equation    L_ij = sum over cells of measure * grad N_i . grad N_j, so w^T L w = int |grad w|^2;
///             surfaces: L_ij = -(cot a_ij + cot b_ij) / 2 off the diagonal
/// Sign        positive semi-definite, rows sum to 0: the negative of the Laplace operator, and of what libigl returns
/// Shapes      L vertices x vertices, symmetric, both triangles stored; masses one per vertex
/// Units       surfaces: L dimensionless, masses m^2;  tets: L in m, masses m^3
/// Valid       negative weights (obtuse triangles, dihedral angles beyond 90 degrees) are kept: L stays semi-definite and
///             exact for linear functions, but loses the maximum principle.
/// Refuses     an index out of range, a cell without area or positive volume, values not finite (InvalidInput names the
///             cell)
/// Source      Pinkall, Polthier 1993; mixed Voronoi areas: Meyer, Desbrun, Schroeder, Barr 2003, section 3.3
/// Cost        one pass over the cells, one sparse assembly
/// Tests       tests/unit/mesh/laplacian_test.cpp
#pragma once

#include <softtissue/core/checked_index.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/mesh/cell_mesh.hpp>

#include <Eigen/Geometry>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace softtissue {

namespace detail {

/// The nodes of a cell, its indices checked.
template <RealScalar Scalar, int num_nodes>
Eigen::Matrix<Scalar, 3, num_nodes> checked_nodes(ConstRef<Matrix3X<Scalar>> X, const Connectivity<num_nodes>& cells,
                                                  Index c, const char* name) {
    Eigen::Matrix<Scalar, 3, num_nodes> nodes;
    for (int i = 0; i < num_nodes; ++i) {
        const std::int32_t v = cells(i, c);
        require(v >= 0 && v < X.cols(), "laplacian: ", name, " ", c, " uses vertex ", v, ", expected 0 to ",
                X.cols() - 1);
        nodes.col(i) = X.col(v);
    }
    return nodes;
}

/// Columns e_i = the edge opposite to node i, and twice the area.
template <RealScalar Scalar>
struct TriangleEdges {
    Matrix3<Scalar> edges;
    Scalar double_area;

    TriangleEdges(ConstRef<Matrix3X<Scalar>> X, const Triangles& triangles, Index t) {
        const Matrix3<Scalar> nodes = checked_nodes<Scalar, 3>(X, triangles, t, "triangle");
        edges.col(0) = nodes.col(2) - nodes.col(1);
        edges.col(1) = nodes.col(0) - nodes.col(2);
        edges.col(2) = nodes.col(1) - nodes.col(0);
        double_area = edges.col(0).cross(edges.col(1)).norm();
        require(double_area > Scalar(0) && std::isfinite(double_area), "laplacian: triangle ", t, " has area ",
                double_area / Scalar(2), ", expected > 0");
    }
};

template <RealScalar Scalar>
Scalar checked_volume(const NodePositions<Tet4, Scalar>& nodes, Index c) {
    const Scalar volume = Tet4::rest_volume(nodes);
    require(volume > Scalar(0) && std::isfinite(volume), "laplacian: tet ", c, " has volume ", volume,
            ", expected > 0");
    return volume;
}

/// The sum of one symmetric local matrix per cell; only its upper triangle is read, so the sum is symmetric to the bit.
template <RealScalar Scalar, int num_nodes, class LocalMatrix>
Eigen::SparseMatrix<Scalar> assemble_scalar(Index num_vertices, const Connectivity<num_nodes>& cells,
                                            const LocalMatrix& local_matrix) {
    std::vector<Eigen::Triplet<Scalar>> entries;
    entries.reserve(
        size_t(checked_index(num_nodes * num_nodes * cells.cols(), "Laplacian: entries before they are summed")));
    for (Index c = 0; c < cells.cols(); ++c) {
        const Eigen::Matrix<Scalar, num_nodes, num_nodes> local = local_matrix(c);
        for (int j = 0; j < num_nodes; ++j) {
            for (int i = 0; i < num_nodes; ++i) {
                entries.emplace_back(cells(i, c), cells(j, c), local(std::min(i, j), std::max(i, j)));
            }
        }
    }
    Eigen::SparseMatrix<Scalar> sum(num_vertices, num_vertices);
    sum.setFromTriplets(entries.begin(), entries.end());
    return sum;
}

}  // namespace detail

/// Of a surface with vertices X (3 x n).
template <RealScalar Scalar = double>
Eigen::SparseMatrix<Scalar> cotangent_laplacian(std::type_identity_t<ConstRef<Matrix3X<Scalar>>> X,
                                                const Triangles& triangles) {
    return detail::assemble_scalar<Scalar>(X.cols(), triangles, [&](Index t) -> Matrix3<Scalar> {
        const detail::TriangleEdges<Scalar> triangle(X, triangles, t);
        return triangle.edges.transpose() * triangle.edges / (Scalar(2) * triangle.double_area);
    });
}

/// Of a volume.
template <RealScalar Scalar>
Eigen::SparseMatrix<Scalar> cotangent_laplacian(const CellMesh<Tet4, Scalar>& mesh) {
    return detail::assemble_scalar<Scalar>(
        mesh.num_vertices(), mesh.cells, [&](Index c) -> Eigen::Matrix<Scalar, 4, 4> {
            const NodePositions<Tet4, Scalar> nodes =
                detail::checked_nodes<Scalar, 4>(mesh.rest_positions, mesh.cells, c, "tet");
            const Scalar volume = detail::checked_volume(nodes, c);
            const NodePositions<Tet4, Scalar> g = Tet4::gradient_operator(nodes);
            return volume * g.transpose() * g;
        });
}

/// A third of the area of every triangle at a vertex.
template <RealScalar Scalar = double>
VectorX<Scalar> barycentric_masses(std::type_identity_t<ConstRef<Matrix3X<Scalar>>> X, const Triangles& triangles) {
    VectorX<Scalar> masses = VectorX<Scalar>::Zero(X.cols());
    for (Index t = 0; t < triangles.cols(); ++t) {
        const detail::TriangleEdges<Scalar> triangle(X, triangles, t);
        for (int i = 0; i < 3; ++i) {
            masses(triangles(i, t)) += triangle.double_area / Scalar(6);
        }
    }
    return masses;
}

/// A quarter of the volume of every tet at a vertex.
template <RealScalar Scalar>
VectorX<Scalar> barycentric_masses(const CellMesh<Tet4, Scalar>& mesh) {
    VectorX<Scalar> masses = VectorX<Scalar>::Zero(mesh.num_vertices());
    for (Index c = 0; c < mesh.num_cells(); ++c) {
        const NodePositions<Tet4, Scalar> nodes =
            detail::checked_nodes<Scalar, 4>(mesh.rest_positions, mesh.cells, c, "tet");
        const Scalar volume = detail::checked_volume(nodes, c);
        for (int i = 0; i < 4; ++i) {
            masses(mesh.cells(i, c)) += volume / Scalar(4);
        }
    }
    return masses;
}

/// The mixed Voronoi area of every vertex: the part of each triangle that is closest to it; in an obtuse triangle
/// half of its area for the obtuse corner and a quarter for the others. The areas sum to that of the surface.
template <RealScalar Scalar = double>
VectorX<Scalar> voronoi_masses(std::type_identity_t<ConstRef<Matrix3X<Scalar>>> X, const Triangles& triangles) {
    VectorX<Scalar> masses = VectorX<Scalar>::Zero(X.cols());
    for (Index t = 0; t < triangles.cols(); ++t) {
        const detail::TriangleEdges<Scalar> triangle(X, triangles, t);
        const Matrix3<Scalar> products = triangle.edges.transpose() * triangle.edges;
        const Scalar area = triangle.double_area / Scalar(2);
        // Negative where the angle at the corner is acute.
        const Vector3<Scalar> corner(products(1, 2), products(2, 0), products(0, 1));
        const bool is_obtuse = corner.maxCoeff() > Scalar(0);
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3;
            const int k = (i + 2) % 3;
            const Scalar circumcentric =
                -(products(j, j) * corner(j) + products(k, k) * corner(k)) / (Scalar(16) * area);
            const Scalar obtuse = area / (corner(i) > Scalar(0) ? Scalar(2) : Scalar(4));
            masses(triangles(i, t)) += is_obtuse ? obtuse : circumcentric;
        }
    }
    return masses;
}

/// L M^-1 L: w^T (L M^-1 L) w is the squared Laplacian of w, integrated. Positive semi-definite.
template <RealScalar Scalar>
Eigen::SparseMatrix<Scalar> bilaplacian(const Eigen::SparseMatrix<Scalar>& laplacian,
                                        std::type_identity_t<ConstRef<VectorX<Scalar>>> masses) {
    require(masses.size() == laplacian.rows(), "bilaplacian: ", masses.size(), " masses, expected ", laplacian.rows());
    for (Index v = 0; v < masses.size(); ++v) {
        require(masses(v) > Scalar(0) && std::isfinite(masses(v)), "bilaplacian: mass of vertex ", v, " is ", masses(v),
                ", expected > 0");
    }
    const Eigen::SparseMatrix<Scalar> scaled = masses.cwiseInverse().asDiagonal() * laplacian;
    return laplacian * scaled;
}

}  // namespace softtissue
