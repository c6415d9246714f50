// SPDX-License-Identifier: MIT
/// @file
/// The skin's normals carried into the volume below it.
///
/// What        a unit vector per mesh vertex: the given normals at the skin, harmonic inside, normalised.
/// Equation    components harmonic (cotangent Laplacian of the tets), natural condition on all other boundary.
/// Shapes      skin_vertices: mesh vertices; skin_normals 3 x as many; result 3 x mesh vertices.
/// Refuses     as HarmonicInterpolation.
/// Source      Romero et al. 2020, section 3.3 (interpolation matrix), section 4.3 (normal direction).
/// Tests       tests/unit/anatomy/volume_normals_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/mesh/cell_mesh.hpp>
#include <softtissue/mesh/harmonic.hpp>
#include <softtissue/mesh/laplacian.hpp>
#include <softtissue/mesh/surface_normals.hpp>

#include <cstdint>
#include <span>

namespace softtissue {

template <RealScalar S>
Matrix3X<S> interpolate_normals(const CellMesh<Tet4, S>& mesh, std::span<const std::int32_t> skin_vertices,
                                const Matrix3X<S>& skin_normals) {
    require(skin_normals.cols() == Index(skin_vertices.size()), "normals: ", skin_normals.cols(), " for ",
            skin_vertices.size(), " skin vertices, expected equal numbers");
    const HarmonicInterpolation<S> from_skin(cotangent_laplacian(mesh), skin_vertices);
    const Eigen::Map<const MatrixX<S>> rows(skin_normals.data(), skin_normals.size(), 1);
    const MatrixX<S> inside = from_skin.interpolate(rows);
    Matrix3X<S> normals = Eigen::Map<const Matrix3X<S>>(inside.data(), 3, mesh.num_vertices());
    detail::normalise_columns(normals);
    return normals;
}

}  // namespace softtissue
