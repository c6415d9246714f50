// SPDX-License-Identifier: MIT
/// @file
/// Conforming split of a prism mesh into tets, three a prism.
///
/// What        the same vertices; tets 3c, 3c+1, 3c+2 are those of prism c
/// Method      every side is cut by the diagonal that starts at its smallest vertex index, so the prisms on both sides
///             of it cut it alike; the smallest of a prism's six indices decides two of its three sides, which always
///             leaves one of two valid patterns.
/// Volume      a flat cut replaces each bilinear side, so a prism and its tets differ in volume; what one prism
///             loses its neighbour gains, and a mesh without free sides (a closed layer) keeps its volume exactly.
/// Valid       prisms with positive corner Jacobians give two positive tets for certain, and a positive third one unless
///             they are strongly twisted or sheared: validate() of the result names a tet that is not.
/// Source      Dompierre, Labbe, Vallet, Camarero 1999, "How to subdivide pyramids, prisms and hexahedra into
///             tetrahedra"
/// Tests       tests/unit/mesh/split_prisms_test.cpp
#pragma once

#include <softtissue/mesh/cell_mesh.hpp>

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace softtissue {

inline constexpr int tets_per_prism = 3;

/// The tets of one prism, one a column.
inline Eigen::Matrix<std::int32_t, 4, tets_per_prism> split_prism(const Eigen::Matrix<std::int32_t, 6, 1>& prism) {
    // The node order of the same prism that starts at the smallest index.
    Eigen::Matrix<std::int32_t, 6, 1> v = prism;
    for (const std::array<int, 6>& order : Prism6::symmetries) {
        if (prism(order[0]) == prism.minCoeff()) {
            for (int i = 0; i < 6; ++i) {
                v(i) = prism(order[std::size_t(i)]);
            }
        }
    }
    Eigen::Matrix<std::int32_t, 4, tets_per_prism> tets;
    if (std::min(v(1), v(5)) < std::min(v(2), v(4))) {
        tets.col(0) << v(0), v(1), v(2), v(5);
        tets.col(1) << v(0), v(1), v(5), v(4);
    } else {
        tets.col(0) << v(0), v(1), v(2), v(4);
        tets.col(1) << v(0), v(4), v(2), v(5);
    }
    tets.col(2) << v(0), v(4), v(5), v(3);
    return tets;
}

/// The tet mesh on the vertices of `prisms`.
template <RealScalar Scalar>
CellMesh<Tet4, Scalar> split_prisms(const CellMesh<Prism6, Scalar>& prisms) {
    CellMesh<Tet4, Scalar> tets{prisms.rest_positions, Connectivity<4>(4, tets_per_prism * prisms.num_cells())};
    for (Index c = 0; c < prisms.num_cells(); ++c) {
        tets.cells.template middleCols<tets_per_prism>(tets_per_prism * c) = split_prism(prisms.cells.col(c));
    }
    return tets;
}

}  // namespace softtissue
