// SPDX-License-Identifier: MIT
/// @file
/// Linear tetrahedron: four nodes, the usual constant gradient.
///
/// What        volume, gradient operator, shape functions and their inverse map
/// Equation    N_0 = 1 - xi_1 - xi_2 - xi_3, N_k = xi_k;  V = det[X_1-X_0, X_2-X_0, X_3-X_0] / 6
/// Shapes      X 3x4 [m]; natural coordinates xi = barycentric coordinates of nodes 1, 2, 3
/// Node order  positive: seen from node 3, nodes 0, 1, 2 run counter-clockwise
/// Valid       every X with V != 0; a flat cell gives infinities or NaN (CellMesh::validate refuses it)
/// Tests       tests/unit/element/tet4_test.cpp, tests/laws/element_laws_tet4_test.cpp
#pragma once

#include <softtissue/element/concepts.hpp>

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/dual_basis.hpp>

#include <Eigen/Geometry>

#include <array>

namespace softtissue {

struct Tet4 {
    static constexpr int num_nodes = 4;
    static constexpr std::array<ElementFace, 4> faces{{
        {3, {0, 2, 1, -1}},
        {3, {0, 1, 3, -1}},
        {3, {1, 2, 3, -1}},
        {3, {2, 0, 3, -1}},
    }};
    /// The even permutations of the four nodes.
    static constexpr std::array<std::array<int, 4>, 12> symmetries{{
        {0, 1, 2, 3},
        {0, 2, 3, 1},
        {0, 3, 1, 2},
        {1, 0, 3, 2},
        {1, 2, 0, 3},
        {1, 3, 2, 0},
        {2, 0, 1, 3},
        {2, 1, 3, 0},
        {2, 3, 0, 1},
        {3, 0, 2, 1},
        {3, 1, 0, 2},
        {3, 2, 1, 0},
    }};

    template <class Scalar>
    using Nodes = Eigen::Matrix<Scalar, 3, num_nodes>;
    template <class Scalar>
    using Values = Eigen::Matrix<Scalar, num_nodes, 1>;

    template <class Scalar>
    static Scalar rest_volume(const Nodes<Scalar>& X) {
        return smallest_jacobian_bound(X) / Scalar(6);
    }

    template <class Scalar>
    static Nodes<Scalar> gradient_operator(const Nodes<Scalar>& X) {
        Nodes<Scalar> g;
        g.template rightCols<3>() = dual_basis(edges(X));
        g.col(0) = -(g.col(1) + g.col(2) + g.col(3));
        return g;
    }

    template <class Scalar>
    static Values<Scalar> shape_integrals(const Nodes<Scalar>& X) {
        return Values<Scalar>::Constant(rest_volume(X) / Scalar(4));
    }

    template <class Scalar>
    static Values<Scalar> shape_values(const Vector3<Scalar>& xi) {
        return Values<Scalar>(Scalar(1) - xi(0) - xi(1) - xi(2), xi(0), xi(1), xi(2));
    }

    /// Constant in the cell: the gradient operator.
    template <class Scalar>
    static Nodes<Scalar> shape_gradients(const Nodes<Scalar>& X, const Vector3<Scalar>&) {
        return gradient_operator(X);
    }

    template <class Scalar>
    static Vector3<Scalar> position(const Nodes<Scalar>& X, const Vector3<Scalar>& xi) {
        return X * shape_values(xi);
    }

    /// Found for every cell that is not flat.
    template <FieldScalar Scalar>
    static NaturalCoordinates<Scalar> natural_coordinates(const Nodes<Scalar>& X, const Vector3<Scalar>& p) {
        const bool is_solid = value_of(smallest_jacobian_bound(X)) != RealOf<Scalar>(0);
        return {dual_basis(edges(X)).transpose() * (p - X.col(0)), is_solid};
    }

    /// det dX/dxi = 6 V, exact.
    template <class Scalar>
    static Scalar smallest_jacobian_bound(const Nodes<Scalar>& X) {
        const Matrix3<Scalar> E = edges(X);
        return E.col(0).cross(E.col(1)).dot(E.col(2));
    }

private:
    /// dX/dxi.
    template <class Scalar>
    static Matrix3<Scalar> edges(const Nodes<Scalar>& X) {
        return X.template rightCols<3>().colwise() - X.col(0);
    }
};

}  // namespace softtissue
