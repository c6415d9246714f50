// SPDX-License-Identifier: MIT
/// @file
/// What an element is: an empty type with the geometry of one cell, templated on its scalar.
///
/// An element E offers, for node positions X (3 x num_nodes, [m]):
///   E::num_nodes                    number of nodes
///   E::rest_volume(X)               exact signed volume [m^3], positive for the documented node order
///   E::gradient_operator(X)         3 x num_nodes [1/m], columns g_i with F = sum_i x_i g_i^T (one F per cell)
///   E::shape_integrals(X)           num_nodes [m^3], integral of N_i over the cell; they sum to the volume
///   E::shape_values(xi)             N_i at natural coordinates xi (3-vector, see the element)
///   E::shape_gradients(X, xi)       3 x num_nodes [1/m], columns dN_i/dX at xi
///   E::position(X, xi)              sum_i X_i N_i(xi)
///   E::natural_coordinates(X, p)    the inverse of position(), with whether it was found
///   E::smallest_jacobian_bound(X)   [m^3], a lower bound of det dX/dxi up to a positive factor of the element: > 0 is
///                                   sufficient for a positive Jacobian everywhere in the cell
/// and, optionally, for boundaries and for the laws:
///   E::faces                        array of ElementFace
///   E::symmetries                   node orders of the same cell: node k of order s is node symmetries[s][k] of the
///                                   first
///
/// Laws (softtissue/testing/element_laws.hpp): partition of unity (sum_i g_i = 0), linear reproduction
/// (sum_i X_i g_i^T = I), shape integrals sum to the volume, shape gradients are the derivatives of the
/// shape values, invariance under rigid motions and symmetries, faces outward and closed.
#pragma once

#include <softtissue/core/notation.hpp>

#include <array>
#include <concepts>
#include <type_traits>

namespace softtissue {

/// Node positions of one cell, 3 x num_nodes.
template <class Element, class Scalar>
using NodePositions = Eigen::Matrix<Scalar, 3, Element::num_nodes>;

/// One value per node of a cell.
template <class Element, class Scalar>
using NodeValues = Eigen::Matrix<Scalar, Element::num_nodes, 1>;

/// Where a point lies in a cell; `coordinates` mean something only if `converged`.
template <class Scalar>
struct NaturalCoordinates {
    Vector3<Scalar> coordinates;
    bool converged;
};

/// A triangle (num_nodes = 3) or quadrilateral (4) of an element, counter-clockwise seen from outside.
struct ElementFace {
    int num_nodes;
    std::array<int, 4> nodes;
};

/// One constant deformation gradient per cell; see the file comment for the members and the laws.
template <class E, class Scalar = double>
concept Element = std::is_empty_v<E> && requires(const NodePositions<E, Scalar>& X, const Vector3<Scalar>& p) {
    { E::num_nodes } -> std::convertible_to<int>;
    { E::rest_volume(X) } -> std::same_as<Scalar>;
    { E::gradient_operator(X) } -> std::same_as<NodePositions<E, Scalar>>;
    { E::shape_integrals(X) } -> std::same_as<NodeValues<E, Scalar>>;
    { E::shape_values(p) } -> std::same_as<NodeValues<E, Scalar>>;
    { E::shape_gradients(X, p) } -> std::same_as<NodePositions<E, Scalar>>;
    { E::position(X, p) } -> std::same_as<Vector3<Scalar>>;
    { E::natural_coordinates(X, p) } -> std::same_as<NaturalCoordinates<Scalar>>;
    { E::smallest_jacobian_bound(X) } -> std::same_as<Scalar>;
};

}  // namespace softtissue
