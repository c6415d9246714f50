// SPDX-License-Identifier: MIT
/// @file
/// Where the displaced vertices are in the world: x = p + A d, per vertex.
///
/// What        turns the solver's displacement d into world positions, and world forces back into forces on d.
/// Equation    x_i = p_i + A_i d_i;  dE/dd_i = A_i^T dE/dx_i
/// Shapes      origins p 3 x vertices [m]; maps A 3 x 3 vertices, or empty for the identity
/// Source      Romero et al. 2020, sec. 4.2 (inverse skinning u = P^-1 x with u = rest + d)
/// Tests       tests/unit/energy/placement_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

namespace softtissue {

template <RealScalar S>
struct Placement {
    using Scalar = S;

    Matrix3X<Scalar> origins;
    Matrix3X<Scalar> maps;

    Index num_vertices() const { return origins.cols(); }
    bool has_maps() const { return maps.cols() > 0; }

    /// A_i; only if has_maps().
    auto map(Index vertex) const { return maps.template middleCols<3>(3 * vertex); }

    /// A_i d.
    Vector3<Scalar> displacement(Index vertex, const Vector3<Scalar>& d) const {
        return has_maps() ? Vector3<Scalar>(map(vertex) * d) : d;
    }

    /// p_i + A_i d.
    Vector3<Scalar> position(Index vertex, const Vector3<Scalar>& d) const {
        return origins.col(vertex) + displacement(vertex, d);
    }

    /// A_i^T f: the force on d of a world force f.
    Vector3<Scalar> pull_back(Index vertex, const Vector3<Scalar>& f) const {
        return has_maps() ? Vector3<Scalar>(map(vertex).transpose() * f) : f;
    }

    /// All positions, 3 x vertices.
    void positions_into(const Matrix3X<Scalar>& d, Matrix3X<Scalar>& x) const {
        x.resize(3, num_vertices());
        for (Index v = 0; v < num_vertices(); ++v) {
            x.col(v) = position(v, d.col(v));
        }
    }
};

}  // namespace softtissue
