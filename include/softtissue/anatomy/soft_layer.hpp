// SPDX-License-Identifier: MIT
/// @file
/// The soft-tissue layer of a skinned body: prisms between the skin and an inner surface, its options and its report.
///
/// What        SoftLayer as make_soft_layer() and with_thickness() return it.
/// Equation    b_i = t_i + h_i u_i: inner vertex, skin vertex, thickness, inward unit direction.
/// Order       PrismLayers: vertex(column, level), column = region vertex, level 0 = inner surface, level num_layers = skin.
///             The vertices of a column lie on the straight line from b_i to t_i, evenly spaced.
/// Prescribed  the inner surface, and every level of the columns on a cut, so that the skin stays joined to what is not
///             simulated.
/// Units       m
/// Source      Romero et al. 2020, section 3.2.
/// Tests       tests/unit/anatomy/soft_layer_test.cpp
#pragma once

#include <softtissue/anatomy/simulated_region.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/mesh/cell_mesh.hpp>
#include <softtissue/mesh/prism_layers.hpp>

#include <cstdint>
#include <vector>

namespace softtissue {

/// What happens to a thickness that leaves its bounds or would invert cells.
enum class ThicknessPolicy {
    reduce,  ///< clamp it, then reduce it around the cells until they are valid; the report tells
    refuse   ///< InvalidInput names the vertex or the triangle
};

template <RealScalar S>
struct SoftLayerOptions {
    RegionOptions region = {};
    Index num_layers = 2;
    /// Default map: min(full_thickness, bone_fraction |p - t|), within [minimum_thickness, |p - t| - bone_radius].
    S full_thickness = S(0.025);
    S bone_fraction = S(0.5);
    S minimum_thickness = S(0.003);
    S bone_radius = S(0.008);
    /// The layer thins towards a cut over this distance, to minimum_thickness at the cut.
    S decay_distance = S(0.08);
    /// Rounds of smoothing along the skeleton; hundreds more let the projections slide together.
    int projection_rounds = 200;
    /// Cosine towards every incident skin triangle that a direction is given, where the skin allows it.
    S wanted_cosine = S(0.3);
    /// A skin vertex whose best possible cosine is below this has no room for a layer and leaves the region.
    S smallest_cosine = S(0.02);
    /// Every Jacobian coefficient of a prism, and every tet of its split, is at least this fraction of its limit for a
    /// vanishing thickness.
    S validity_margin = S(0.2);
};

template <RealScalar S>
struct SoftLayerReport {
    Index vertices_without_cone = 0;  ///< left the region: no layer exists there
    Index vertices_redirected = 0;    ///< direction moved into the validity cone of the skin
    Index vertices_clamped = 0;       ///< thickness brought into its bounds
    Index vertices_reduced = 0;       ///< thickness reduced because cells would have been invalid
    int reduction_rounds = 0;
    /// Pairs of triangles of the inner surface that cross it or the skin; only where the skin crosses itself.
    Index crossings_left = 0;
    S smallest_cone_cosine = S(0);        ///< over the region: best possible cosine of the worst vertex
    S smallest_relative_jacobian = S(0);  ///< over the cells, in the measure of validity_margin
    S thickness_min = S(0);
    S thickness_mean = S(0);
    S thickness_max = S(0);
};

template <RealScalar S>
struct SoftLayer {
    using Scalar = S;

    SimulatedRegion<S> region;
    PrismLayers layers;            // num_columns = region vertices
    Matrix3X<S> skin_positions;    // 3 x region vertices: t
    Matrix3X<S> directions;        // 3 x region vertices: u, inwards, unit
    VectorX<S> skeleton_distance;  // |p - t| per region vertex
    VectorX<S> thickness;          // h, as built
    CellMesh<Prism6, S> mesh;
    std::vector<std::int32_t> prescribed_vertices;  // of mesh, ascending
    SoftLayerOptions<S> options;
    SoftLayerReport<S> report;

    Index num_columns() const { return layers.num_columns; }
    /// The mesh vertex at the skin end of a column.
    Index skin_vertex(Index column) const { return layers.vertex(column, layers.num_layers); }
    /// The body vertex above a mesh vertex.
    std::int32_t body_vertex(Index vertex) const { return region.body_vertices[size_t(layers.column(vertex))]; }
    Matrix3X<S> inner_positions() const { return skin_positions + directions * thickness.asDiagonal(); }
};

}  // namespace softtissue
