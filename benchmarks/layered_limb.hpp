// SPDX-License-Identifier: MIT
/// @file
/// A limb of the paper's size and its Poisson system as sparse matrices, for the solvers that are compared.
///
/// What        limb(): two layers of prisms around a bone; limb_poisson(): G^T W G and G^T W of its free vertices
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/energy/rest_operators.hpp>
#include <softtissue/mesh/cell_mesh.hpp>
#include <softtissue/mesh/prism_layers.hpp>

#include <Eigen/SparseCore>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace benchmarks {

using namespace softtissue;

/// Triangles of a tube, `around` x `along` columns.
inline Triangles tube_triangles(Index around, Index along) {
    Triangles triangles(3, 2 * around * (along - 1));
    for (Index j = 0, t = 0; j + 1 < along; ++j) {
        for (Index i = 0; i < around; ++i, t += 2) {
            const auto column = [&](Index x, Index y) { return std::int32_t(y * around + x % around); };
            triangles.col(t) << column(i, j), column(i + 1, j), column(i, j + 1);
            triangles.col(t + 1) << column(i + 1, j), column(i + 1, j + 1), column(i, j + 1);
        }
    }
    return triangles;
}

/// Three levels of vertices around a bone; the innermost is prescribed.
struct Limb {
    PrismLayers layers;
    CellMesh<Prism6, double> mesh;
    std::vector<std::int32_t> bone;

    Limb(Index around, Index along) : layers{around * along, 2} {
        mesh.cells = layers.prisms(tube_triangles(around, along));
        mesh.rest_positions.resize(3, layers.num_vertices());
        for (Index c = 0; c < layers.num_columns; ++c) {
            const double angle = 2 * std::numbers::pi * double(c % around) / double(around);
            for (Index level = 0; level < 3; ++level) {
                const double radius = 0.03 + 0.01 * double(level);
                mesh.rest_positions.col(layers.vertex(c, level)) << radius * std::cos(angle), radius * std::sin(angle),
                    2 * std::numbers::pi * 0.04 / double(around) * double(c / around);
            }
            bone.push_back(std::int32_t(layers.vertex(c, 0)));
        }
    }

    template <class Scalar>
    CellMesh<Prism6, Scalar> mesh_of() const {
        return {mesh.rest_positions.cast<Scalar>(), mesh.cells};
    }
};

/// The paper's size: 26,752 free vertices.
inline const Limb& limb() {
    static const Limb result(64, 209);
    return result;
}

struct LimbPoisson {
    using RowMajor = Eigen::SparseMatrix<double, Eigen::RowMajor>;

    Eigen::SparseMatrix<double> matrix;  ///< free x free
    RowMajor gradient_transpose;         ///< G^T W: free x 3 cells
    RowMajor gradient;                   ///< G: 3 cells x vertices, the free ones first

    explicit LimbPoisson(const Limb& limb) {
        const CellMesh<Prism6, double>& mesh = limb.mesh;
        const PrescribedVertices prescribed(mesh.num_vertices(), limb.bone);
        const auto rest = RestOperators<Prism6, double>::at(mesh, mesh.rest_positions);
        std::vector<Eigen::Triplet<double>> products, rows, columns;
        std::vector<std::int32_t> place(size_t(mesh.num_vertices()));
        std::int32_t next_fixed = std::int32_t(prescribed.num_free());
        for (Index v = 0; v < mesh.num_vertices(); ++v) {
            place[size_t(v)] = prescribed.is_prescribed(v) ? next_fixed++ : prescribed.free_index(v);
        }
        for (Index c = 0; c < mesh.num_cells(); ++c) {
            const Eigen::Matrix<double, 3, 6> g = rest.cell_gradients(c);
            for (int a = 0; a < 6; ++a) {
                const std::int32_t row = prescribed.free_index(mesh.cells(a, c));
                for (int d = 0; d < 3; ++d) {
                    columns.emplace_back(std::int32_t(3 * c + d), place[size_t(mesh.cells(a, c))], g(d, a));
                    if (row != PrescribedVertices::prescribed) {
                        rows.emplace_back(row, std::int32_t(3 * c + d), rest.volumes(c) * g(d, a));
                    }
                }
                for (int b = 0; b < 6 && row != PrescribedVertices::prescribed; ++b) {
                    const std::int32_t column = prescribed.free_index(mesh.cells(b, c));
                    if (column != PrescribedVertices::prescribed) {
                        products.emplace_back(row, column, rest.volumes(c) * g.col(a).dot(g.col(b)));
                    }
                }
            }
        }
        matrix.resize(prescribed.num_free(), prescribed.num_free());
        matrix.setFromTriplets(products.begin(), products.end());
        gradient_transpose.resize(prescribed.num_free(), 3 * mesh.num_cells());
        gradient_transpose.setFromTriplets(rows.begin(), rows.end());
        gradient.resize(3 * mesh.num_cells(), mesh.num_vertices());
        gradient.setFromTriplets(columns.begin(), columns.end());
    }
};

inline const LimbPoisson& limb_poisson() {
    static const LimbPoisson result(limb());
    return result;
}

}  // namespace benchmarks
