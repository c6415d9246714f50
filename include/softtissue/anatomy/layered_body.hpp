// SPDX-License-Identifier: MIT
/// @file
/// A body in layers: bone wrap, muscle wrap and skin with the same triangles, prisms between them; options and report.
///
/// What        LayeredBody as make_layered_body() returns it.
/// Order       PrismLayers with two layers: vertex(column, level), column = region vertex, level 0 = bone wrap B, 1 = muscle
///             wrap M, 2 = skin. Cells: the muscle prisms (B to M) of all region triangles, then the fat prisms (M to skin).
/// Prescribed  the bone wrap, and all levels of the columns on a cut, ascending: they follow linear blend skinning with
///             `weights`, which on a cut are the skin's own, so that the skin stays joined to what is not simulated.
/// Display     skin = level 2 + skin_offsets: where no layer could exist below the skin, it was moved (see repair_skin()).
/// Units       m, m^3
/// Source      Nolte et al. 2026, section 3.1
/// Tests       tests/unit/anatomy/layered_body_test.cpp
#pragma once

#include <softtissue/anatomy/body_anatomy.hpp>
#include <softtissue/anatomy/prism_quality.hpp>
#include <softtissue/anatomy/simulated_region.hpp>
#include <softtissue/anatomy/skin_repair.hpp>
#include <softtissue/anatomy/wrap_cleanup.hpp>
#include <softtissue/anatomy/wrap_flow.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/mesh/cell_mesh.hpp>
#include <softtissue/mesh/crossing_triangles.hpp>
#include <softtissue/mesh/prism_layers.hpp>
#include <softtissue/mesh/surface_normals.hpp>
#include <softtissue/skinning/weights.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace softtissue {

template <RealScalar S>
struct LayeredBodyOptions {
    RegionOptions region = {};
    BodyAnatomy anatomy = smpl_anatomy();
    /// Fat per body vertex and depth of the bone wrap per body vertex, both below the skin and away from the cuts [m];
    /// empty: from the anatomy. What is given is refused where less than `accepted_share` of it could be built.
    VectorX<S> fat_thickness = {};
    VectorX<S> bone_depth = {};
    S accepted_share = S(0.5);
    /// Both layers thin towards a cut over this distance, to these depths at the cut.
    S decay_distance = S(0.08);
    S cut_fat = S(0.0018);
    S cut_muscle = S(0.0022);
    S smallest_depth = S(0.012);
    S smallest_fat = S(0.003);
    /// Rounds of smoothing of the skin's weights before they choose bones and fat, and of those of the result: the skin's own
    /// weights would fold the bone wrap in poses.
    int tissue_weight_rounds = 10;
    int weight_rounds = 16;
    /// A skin whose best cosine stays below this after the repair is refused.
    S smallest_cosine = S(0.1);
    /// A body with a layer that is anywhere thinner than this is refused.
    S thinnest = S(0.0001);
    /// Cosine of the ways to the targets with the skin's inward normals, where the skin allows it.
    S target_cosine = S(0.3);
    SkinRepairOptions<S> repair = {};
    WrapFlowOptions<S> flow = {};
    WrapCleanupOptions<S> cleanup = {};

    /// Throws InvalidInput unless all values can be worked with, for a body of so many vertices.
    void validate(Index num_body_vertices) const {
        require_positive(decay_distance, "decay_distance");
        require_positive(cut_fat, "cut_fat");
        require_positive(cut_muscle, "cut_muscle");
        require_positive(smallest_depth, "smallest_depth");
        require_positive(smallest_fat, "smallest_fat");
        require_positive(smallest_cosine, "smallest_cosine");
        require_positive(thinnest, "thinnest");
        require_positive(target_cosine, "target_cosine");
        require_positive(flow.threshold, "flow.threshold");
        require_positive(cleanup.threshold, "cleanup.threshold");
        require(cleanup.short_column >= S(0), "layered body: cleanup.short_column = ", cleanup.short_column,
                ", expected >= 0");
        require(cleanup.largest_fat_fraction > S(0) && cleanup.largest_fat_fraction < S(1),
                "layered body: cleanup.largest_fat_fraction = ", cleanup.largest_fat_fraction,
                ", expected a value between 0 and 1");
        require(accepted_share >= S(0) && accepted_share <= S(1), "layered body: accepted_share = ", accepted_share,
                ", expected 0 to 1");
        require(tissue_weight_rounds >= 0 && weight_rounds >= 0, "layered body: rounds of smoothing ",
                tissue_weight_rounds, " and ", weight_rounds, ", expected >= 0");
        require_map(fat_thickness, "fat_thickness", num_body_vertices);
        require_map(bone_depth, "bone_depth", num_body_vertices);
    }

private:
    static void require_positive(S value, const char* name) {
        require(std::isfinite(value) && value > S(0), "layered body: ", name, " = ", value, ", expected > 0");
    }

    static void require_map(const VectorX<S>& map, const char* name, Index num_body_vertices) {
        require(map.size() == 0 || map.size() == num_body_vertices, "layered body: ", map.size(), " values of ", name,
                ", expected one for each of the ", num_body_vertices, " vertices of the body, or none");
        for (Index v = 0; v < map.size(); ++v) {
            require(std::isfinite(map(v)) && map(v) > S(0), "layered body: ", name, " of body vertex ", v, " = ",
                    map(v), ", expected a finite value > 0");
        }
    }
};

/// One of the two layers at rest.
template <RealScalar S>
struct LayerReport {
    Index inverted_cells = 0;  // of a body that is returned: 0
    S smallest_scaled_jacobian = S(0);
    S smallest_relative_coefficient = S(0);
    S thinnest = S(0);  // lengths of the columns
    S thickest = S(0);
    S volume = S(0);
    Index crossings = 0;  // pairs of triangles of its lower surface
};

template <RealScalar S>
struct LayeredBodyReport {
    LayerReport<S> muscle;
    LayerReport<S> fat;
    S bone_volume = S(0);  // inside the bone wrap, its openings closed by fans
    Index repaired_vertices = 0;
    S largest_repair = S(0);
    S smallest_cosine = S(0);  // of the validity cones of the repaired skin
    int repair_rounds = 0;
    Index redirected_targets = 0;
    int redirection_rounds = 0;
    int cleanup_sweeps = 0;
};

template <RealScalar S>
struct LayeredBody {
    using Scalar = S;

    SimulatedRegion<S> region;
    PrismLayers layers{0, 2};
    CellMesh<Prism6, S> mesh;
    Matrix3X<S> skin_offsets;              // 3 x columns
    SkinningWeights<S> weights;            // one row per mesh vertex, equal on the three levels of a column
    std::vector<std::int32_t> prescribed;  // of mesh, ascending
    LayeredBodyReport<S> report;

    Index num_columns() const { return layers.num_columns; }
    Index num_muscle_cells() const { return region.num_triangles(); }
    Index num_fat_cells() const { return region.num_triangles(); }

    /// Rest positions of one level, 3 x columns: 0 bone wrap, 1 muscle wrap, 2 skin.
    Matrix3X<S> level_positions(Index level) const { return layers.level_positions(mesh.rest_positions, level); }

    /// Weights of the columns, one row each; those of every level.
    SkinningWeights<S> column_weights() const {
        MatrixX<S> dense = MatrixX<S>::Zero(num_columns(), weights.num_joints());
        for (Index c = 0; c < num_columns(); ++c) {
            for (const auto& [joint, weight] : weights.row(layers.vertex(c, 0))) {
                dense(c, joint) = weight;
            }
        }
        return SkinningWeights<S>(dense);
    }
};

/// Volume inside an open surface whose boundary loops are closed by fans around their centres [m^3].
template <RealScalar S>
S capped_volume(const Matrix3X<S>& positions, const Triangles& triangles,
                const std::vector<std::vector<std::int32_t>>& loops) {
    S volume = enclosed_volume(positions, triangles);
    const Vector3<S> origin = positions.col(0);
    for (const std::vector<std::int32_t>& loop : loops) {
        Vector3<S> centre = Vector3<S>::Zero();
        for (const std::int32_t v : loop) {
            centre += positions.col(v) / S(loop.size());
        }
        for (size_t k = 0; k < loop.size(); ++k) {  // against the direction of the loop, which runs with the surface
            const Vector3<S> a = positions.col(loop[(k + 1) % loop.size()]) - origin;
            const Vector3<S> b = positions.col(loop[k]) - origin;
            volume += (centre - origin).dot(a.cross(b)) / S(6);
        }
    }
    return volume;
}

/// Measures the prisms between two surfaces; inverse_sines of the skin (inverse_corner_sines()).
template <RealScalar S>
LayerReport<S> measure_layer(const Triangles& triangles, const Matrix3X<S>& lower, const Matrix3X<S>& upper,
                             const Matrix3X<S>& inverse_sines) {
    LayerReport<S> report;
    report.smallest_scaled_jacobian = report.smallest_relative_coefficient = std::numeric_limits<S>::infinity();
    for (Index t = 0; t < triangles.cols(); ++t) {
        const Prism6::Nodes<S> X = nodes_between(triangles, t, lower, upper);
        report.inverted_cells += Prism6::smallest_jacobian_bound(X) > S(0) ? 0 : 1;
        report.smallest_scaled_jacobian = std::min(report.smallest_scaled_jacobian, scaled_jacobian<S>(X));
        report.smallest_relative_coefficient = std::min(report.smallest_relative_coefficient,
                                                        relative_coefficients<S>(X, inverse_sines.col(t)).minCoeff());
        report.volume += Prism6::rest_volume(X);
    }
    const VectorX<S> lengths = (upper - lower).colwise().norm().transpose();
    report.thinnest = lengths.minCoeff();
    report.thickest = lengths.maxCoeff();
    report.crossings = static_cast<Index>(crossing_triangles<S>(lower, triangles).size());
    return report;
}

}  // namespace softtissue
