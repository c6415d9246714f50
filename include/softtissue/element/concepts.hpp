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
///   E::position(X, xi)              sum_i X_i N_i(xi)
///   E::natural_coordinates(X, p)    the inverse of position()
///   E::smallest_jacobian_bound(X)   > 0 is sufficient for a positive Jacobian everywhere in the cell
///   E::faces / E::num_faces         outward faces, for boundaries and tests
///
/// Laws (softtissue/testing/element_laws.hpp): partition of unity (sum_i g_i = 0), linear reproduction
/// (sum_i X_i g_i^T = I), shape integrals sum to the volume, invariance under rotation and translation.
#pragma once

#include <softtissue/core/notation.hpp>

#include <concepts>

namespace softtissue {

/// Node positions of one cell, 3 x num_nodes.
template <class Element, class Scalar>
using NodePositions = Eigen::Matrix<Scalar, 3, Element::num_nodes>;

/// One value per node of a cell.
template <class Element, class Scalar>
using NodeValues = Eigen::Matrix<Scalar, Element::num_nodes, 1>;

/// One constant deformation gradient per cell; see the file comment for the members and the laws.
template <class E, class Scalar = double>
concept Element = std::is_empty_v<E> && requires(const NodePositions<E, Scalar>& X, const Vector3<Scalar>& p) {
    { E::num_nodes } -> std::convertible_to<int>;
    { E::rest_volume(X) } -> std::same_as<Scalar>;
    { E::gradient_operator(X) } -> std::same_as<NodePositions<E, Scalar>>;
    { E::shape_integrals(X) } -> std::same_as<NodeValues<E, Scalar>>;
    { E::shape_values(p) } -> std::same_as<NodeValues<E, Scalar>>;
    { E::position(X, p) } -> std::same_as<Vector3<Scalar>>;
    { E::smallest_jacobian_bound(X) } -> std::same_as<Scalar>;
};

}  // namespace softtissue
