// SPDX-License-Identifier: MIT
/// @file
/// Builds the soft-tissue layer of a skinned body, with no inverted cell at rest, whatever the body.
///
/// What        make_soft_layer(): region, directions and default thickness; with_thickness(): the same layer, other thickness.
/// Method      region without extremities -> closest points p on the bones, smoothed along the skeleton -> directions
///             (p - t) / |p - t|, moved into the validity cones of the skin -> thickness, thinned towards the cuts ->
///             reduced where cells would be invalid or the inner surface would cross. The skin itself is never moved.
/// Thickness   h_i is meant away from the cuts and bounded by [minimum_thickness, |p - t| - bone_radius] (where the interval
///             is empty by its lower end); built is  minimum + (h_i - minimum) smoothstep(distance to the cut / decay_distance).
///             Reduction may go below minimum_thickness: validity comes first, the report tells.
/// Refuses     skin that is no closed surface; a region or skeleton that is refused (see there); options out of range;
///             under ThicknessPolicy::refuse a thickness out of bounds or that makes a cell invalid (InvalidInput names
///             vertex or triangle of the body).
/// Source      Romero et al. 2020, section 3.2 and eq. (2).
/// Departs     cones, guarded reduction and a fixed number of smoothing rounds are added: as published, the construction
///             inverts cells at groin, armpit and between the buttocks. The thickness decays to a few millimetres, not zero.
/// Tests       tests/unit/anatomy/make_soft_layer_test.cpp
#pragma once

#include <softtissue/anatomy/simulated_region.hpp>
#include <softtissue/anatomy/skeleton_projection.hpp>
#include <softtissue/anatomy/soft_layer.hpp>
#include <softtissue/anatomy/thickness_guard.hpp>
#include <softtissue/anatomy/validity_cone.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/surface_normals.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>
#include <softtissue/mesh/validate_surface.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>
#include <softtissue/skinning/smpl_body.hpp>
#include <softtissue/skinning/weights.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace softtissue {

namespace detail {

template <RealScalar S>
void validate_options(const SoftLayerOptions<S>& options) {
    const auto check = [](bool condition, const char* name, auto value, const char* expectation) {
        require(condition, "soft layer: ", name, " = ", value, ", expected ", expectation);
    };
    check(options.num_layers >= 1, "num_layers", options.num_layers, ">= 1");
    const auto is_positive = [](S value) { return std::isfinite(value) && value > S(0); };
    check(is_positive(options.minimum_thickness), "minimum_thickness", options.minimum_thickness, "> 0");
    check(std::isfinite(options.full_thickness) && options.full_thickness >= options.minimum_thickness,
          "full_thickness", options.full_thickness, ">= minimum_thickness");
    check(options.bone_fraction > S(0) && options.bone_fraction < S(1), "bone_fraction", options.bone_fraction,
          "a value between 0 and 1");
    check(std::isfinite(options.bone_radius) && options.bone_radius >= S(0), "bone_radius", options.bone_radius,
          ">= 0");
    check(is_positive(options.decay_distance), "decay_distance", options.decay_distance, "> 0");
    check(options.projection_rounds >= 0, "projection_rounds", options.projection_rounds, ">= 0");
    check(options.validity_margin > S(0) && options.validity_margin < S(1), "validity_margin", options.validity_margin,
          "a value between 0 and 1");
    check(options.wanted_cosine > S(0) && options.wanted_cosine < S(1), "wanted_cosine", options.wanted_cosine,
          "a value between 0 and 1");
    check(options.smallest_cosine > S(0) && options.smallest_cosine < S(1), "smallest_cosine", options.smallest_cosine,
          "a value between 0 and 1");
}

/// The region, grown smaller until every vertex has a validity cone; sets vertices_without_cone and smallest_cone_cosine.
template <RealScalar S>
SimulatedRegion<S> region_with_cones(const Matrix3X<S>& positions, const TriangleMesh& body,
                                     const SkinningWeights<S>& weights, const SoftLayerOptions<S>& options,
                                     SoftLayerReport<S>& report) {
    const Matrix3X<S> normals = triangle_normals(positions, body.triangles());
    RegionOptions region_options = options.region;
    for (;;) {
        SimulatedRegion<S> region = make_simulated_region(positions, body, weights, region_options);
        const TriangleMesh mesh(region.triangles, region.num_vertices());
        Matrix3X<S> region_normals(3, region.num_triangles());
        for (Index t = 0; t < region.num_triangles(); ++t) {
            region_normals.col(t) = normals.col(region.body_triangles[size_t(t)]);
        }
        report.smallest_cone_cosine = S(1);
        Index excluded = 0;
        for (Index v = 0; v < region.num_vertices(); ++v) {
            const S cosine = best_inward_direction<S>(incident_columns<S>(mesh, region_normals, v)).cosine;
            report.smallest_cone_cosine = std::min(report.smallest_cone_cosine, cosine);
            if (cosine < options.smallest_cosine) {
                region_options.excluded_vertices.push_back(region.body_vertices[size_t(v)]);
                ++excluded;
            }
        }
        if (excluded == 0) {
            return region;
        }
        report.vertices_without_cone += excluded;
    }
}

/// Directions towards the smoothed projections, inside the cones; sets directions, skeleton_distance and the report.
template <RealScalar S>
void set_directions(SoftLayer<S>& layer, const TriangleMesh& mesh, const BoneSegments<S>& bones) {
    const Matrix3X<S>& skin = layer.skin_positions;
    const Matrix3X<S> normals = triangle_normals(skin, mesh.triangles());
    const Matrix3X<S> targets = project_to_skeleton(mesh, skin, bones, layer.options.projection_rounds);
    layer.directions = targets - skin;
    layer.skeleton_distance = layer.directions.colwise().norm().transpose();
    for (Index v = 0; v < skin.cols(); ++v) {
        const Matrix3X<S> incident = incident_columns<S>(mesh, normals, v);
        const InwardDirection<S> best = best_inward_direction<S>(incident);
        const Vector3<S> towards =
            layer.skeleton_distance(v) > S(0) ? layer.directions.col(v).normalized() : best.direction;
        const S wanted = std::min(layer.options.wanted_cosine, S(0.85) * best.cosine);
        layer.directions.col(v) = moved_into_cone<S>(incident, towards, best.direction, wanted);
        layer.report.vertices_redirected += layer.directions.col(v) != towards ? 1 : 0;
    }
}

/// Thickness of the default map, before bounds and decay.
template <RealScalar S>
VectorX<S> default_thickness(const SoftLayer<S>& layer) {
    return (layer.options.bone_fraction * layer.skeleton_distance).cwiseMin(layer.options.full_thickness);
}

/// Largest thickness of each region vertex: up to bone_radius before the skeleton, at least minimum_thickness.
template <RealScalar S>
VectorX<S> largest_thickness(const SoftLayer<S>& layer) {
    return (layer.skeleton_distance.array() - layer.options.bone_radius).max(layer.options.minimum_thickness);
}

template <RealScalar S>
VectorX<S> thinned_towards_cuts(const SoftLayer<S>& layer, const VectorX<S>& thickness) {
    VectorX<S> thinned(thickness.size());
    const S rim = layer.options.minimum_thickness;
    for (Index v = 0; v < thickness.size(); ++v) {
        thinned(v) = rim + (thickness(v) - rim) * layer.region.fade(v, layer.options.decay_distance);
    }
    return thinned;
}

/// Throws if `guarded` had to change the thickness, and says where and why.
template <RealScalar S>
void refuse_reduction(const SoftLayer<S>& layer, const TriangleMesh& mesh, const LayerColumns<S>& columns,
                      const VectorX<S>& wanted, const GuardedThickness<S>& guarded) {
    for (Index t = 0; t < mesh.num_triangles(); ++t) {
        const S jacobian = relative_jacobian<S>(columns, mesh.triangles().col(t), wanted);
        require(jacobian >= layer.options.validity_margin,
                "soft layer: the thickness makes the cells below body triangle ",
                layer.region.body_triangles[size_t(t)], " invalid (relative Jacobian ", jacobian,
                ", expected >= ", layer.options.validity_margin, ")");
    }
    for (Index v = 0; v < wanted.size(); ++v) {
        require(guarded.thickness(v) >= wanted(v), "soft layer: with the thickness ", wanted(v), " of body vertex ",
                layer.region.body_vertices[size_t(v)], " the inner surface crosses itself or the skin");
    }
}

/// Fills mesh, prescribed vertices and the thickness part of the report from layer.thickness.
template <RealScalar S>
void set_mesh(SoftLayer<S>& layer) {
    const PrismLayers& layers = layer.layers;
    const LayerColumns<S> columns{layer.skin_positions, layer.directions, layers.num_layers};
    layer.mesh.cells = layers.prisms(layer.region.triangles);
    layer.mesh.rest_positions.resize(3, layers.num_vertices());
    layer.prescribed_vertices.clear();
    for (Index i = 0; i < layers.num_columns; ++i) {
        for (Index level = 0; level < layers.num_levels(); ++level) {
            const S s = S(1) - S(level) / S(layers.num_layers);
            layer.mesh.rest_positions.col(layers.vertex(i, level)) =
                columns.position(static_cast<std::int32_t>(i), layer.thickness(i), s);
            if (level == 0 || layer.region.is_rim(i)) {
                layer.prescribed_vertices.push_back(static_cast<std::int32_t>(layers.vertex(i, level)));
            }
        }
    }
    SoftLayerReport<S>& report = layer.report;
    report.thickness_min = layer.thickness.minCoeff();
    report.thickness_mean = layer.thickness.mean();
    report.thickness_max = layer.thickness.maxCoeff();
    report.smallest_relative_jacobian = S(1);
    for (Index t = 0; t < layer.region.num_triangles(); ++t) {
        report.smallest_relative_jacobian =
            std::min(report.smallest_relative_jacobian,
                     relative_jacobian<S>(columns, layer.region.triangles.col(t), layer.thickness));
    }
}

}  // namespace detail

/// The layer with another thickness [m] per region vertex; region and directions stay. Cost: about a tenth of a build.
template <RealScalar S>
SoftLayer<S> with_thickness(SoftLayer<S> layer, const std::type_identity_t<VectorX<S>>& thickness,
                            ThicknessPolicy policy = ThicknessPolicy::reduce) {
    require(thickness.size() == layer.num_columns(), "soft layer: ", thickness.size(),
            " values of thickness, expected one for each of the ", layer.num_columns(), " vertices of the region");
    const VectorX<S> largest = detail::largest_thickness(layer);
    VectorX<S> bounded = thickness;
    layer.report.vertices_clamped = 0;
    for (Index v = 0; v < thickness.size(); ++v) {
        require(std::isfinite(thickness(v)), "soft layer: thickness of body vertex ",
                layer.region.body_vertices[size_t(v)], " is not finite");
        bounded(v) = std::clamp(thickness(v), layer.options.minimum_thickness, largest(v));
        require(policy == ThicknessPolicy::reduce || bounded(v) == thickness(v),
                "soft layer: thickness of body vertex ", layer.region.body_vertices[size_t(v)], " = ", thickness(v),
                ", expected ", layer.options.minimum_thickness, " to ", largest(v));
        layer.report.vertices_clamped += bounded(v) != thickness(v) ? 1 : 0;
    }
    const VectorX<S> wanted = detail::thinned_towards_cuts(layer, bounded);
    const TriangleMesh mesh(layer.region.triangles, layer.num_columns());
    const LayerColumns<S> columns{layer.skin_positions, layer.directions, layer.layers.num_layers};
    const ThicknessGuard<S> guard(mesh, columns, layer.options.validity_margin);
    const GuardedThickness<S> guarded = guard.reduce(wanted);
    if (policy == ThicknessPolicy::refuse) {
        detail::refuse_reduction(layer, mesh, columns, wanted, guarded);
    }
    layer.thickness = guarded.thickness;
    layer.report.reduction_rounds = guarded.rounds;
    layer.report.vertices_reduced = (guarded.thickness.array() < wanted.array()).count();
    layer.report.crossings_left = guarded.crossings_left;
    detail::set_mesh(layer);
    return layer;
}

/// The layer of a body with skin `positions` (3 x n) and `joints` (3 x num_joints) at rest.
template <RealScalar S>
SoftLayer<S> make_soft_layer(const Matrix3X<S>& positions, const Triangles& faces, const SkinningWeights<S>& weights,
                             const KinematicTree& tree, const Matrix3X<S>& joints,
                             const SoftLayerOptions<S>& options = {}) {
    detail::validate_options(options);
    validate_closed_surface(positions, faces, "soft layer: skin");
    const TriangleMesh body(faces, positions.cols(), "soft layer: skin");
    const BoneSegments<S> bones(tree, joints);
    SoftLayer<S> layer;
    layer.options = options;
    layer.region = detail::region_with_cones(positions, body, weights, options, layer.report);
    layer.layers = {layer.region.num_vertices(), options.num_layers};
    layer.skin_positions = layer.region.gather(positions);
    detail::set_directions(layer, TriangleMesh(layer.region.triangles, layer.region.num_vertices()), bones);
    const VectorX<S> thickness = detail::default_thickness(layer);
    return with_thickness(std::move(layer), thickness);
}

/// The layer of a body's template.
template <RealScalar S>
SoftLayer<S> make_soft_layer(const SmplBody<S>& body, const SoftLayerOptions<S>& options = {}) {
    const Matrix3X<S> joints = (body.joint_regressor * body.template_vertices.transpose()).transpose();
    return make_soft_layer(body.template_vertices, body.faces, body.weights, body.tree, joints, options);
}

}  // namespace softtissue
