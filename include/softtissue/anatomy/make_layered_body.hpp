// SPDX-License-Identifier: MIT
/// @file
/// Builds a layered body with no inverted prism at rest from a skinned surface.
///
/// What        make_layered_body(): bone wrap and muscle wrap inside the skin, all with the skin's triangles.
/// Method      region without extremities -> skin moved where no layer could exist (repair_skin) -> targets on the bones
///             (BoneTargets), thinned towards the cuts -> ways to them turned into the skin's validity cones
///             (project_targets) -> bone wrap by guarded steps (flow_to_targets) -> muscle wrap at a part of the way
///             (fat_thickness) -> both improved under a barrier (WrapCleanup) -> checked.
/// Equation    depth at distance d from a cut:  cut + (full - cut) (3 s^2 - 2 s^3),  s = min(d / decay_distance, 1)
/// Refuses     skin that is no closed surface; a skeleton other than the anatomy's; options out of range; skin that cannot be
///             repaired or leaves no room in a fold; thicknesses given that cannot be built (InvalidInput names vertex, joint, what was asked and what is
///             possible).
/// Source      Nolte et al. 2026, sections 3.1 and 4.1
/// Departs     built from skin and skeleton alone, by targets and guarded steps, instead of a fit of scanned anatomy: any
///             body in SMPL's form gets its layers, and every prism is proven positive.
/// Cost        seconds; the same bits for any number of threads
/// Tests       tests/unit/anatomy/make_layered_body_test.cpp
#pragma once

#include <softtissue/anatomy/bone_targets.hpp>
#include <softtissue/anatomy/fat_thickness.hpp>
#include <softtissue/anatomy/layered_body.hpp>
#include <softtissue/anatomy/prism_quality.hpp>
#include <softtissue/anatomy/project_targets.hpp>
#include <softtissue/anatomy/simulated_region.hpp>
#include <softtissue/anatomy/skin_repair.hpp>
#include <softtissue/anatomy/wrap_cleanup.hpp>
#include <softtissue/anatomy/wrap_flow.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>
#include <softtissue/mesh/umbrella_mean.hpp>
#include <softtissue/mesh/validate_surface.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>
#include <softtissue/skinning/smpl_body.hpp>
#include <softtissue/skinning/weights.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace softtissue {

namespace detail {

/// Weights of the region's vertices, joints x columns.
template <RealScalar S>
MatrixX<S> region_weights(const SimulatedRegion<S>& region, const SkinningWeights<S>& weights) {
    MatrixX<S> dense = MatrixX<S>::Zero(weights.num_joints(), region.num_vertices());
    for (Index v = 0; v < region.num_vertices(); ++v) {
        for (const auto& [joint, weight] : weights.row(region.body_vertices[size_t(v)])) {
            dense(joint, v) = weight;
        }
    }
    return dense;
}

/// The steps of the construction, each filling a part of the body.
template <RealScalar S>
class LayeredBodyBuilder {
public:
    LayeredBodyBuilder(const Matrix3X<S>& positions, const Triangles& faces, const SkinningWeights<S>& weights,
                       const Matrix3X<S>& joints, const LayeredBodyOptions<S>& options)
        : options_(options),
          joints_(joints),
          region_(make_simulated_region(positions, TriangleMesh(faces, positions.cols(), "layered body: skin"), weights,
                                        options.region)),
          mesh_(region_.triangles, region_.num_vertices()),
          original_skin_(region_.gather(positions)),
          skin_weights_(region_weights(region_, weights)),
          tissue_weights_(umbrella_smoothed<S, Eigen::Dynamic>(mesh_, skin_weights_, options.tissue_weight_rounds)) {}

    LayeredBody<S> build() {
        repair();
        const BoneTargets<S> bones(options_.anatomy, joints_, skin_.positions, tissue_weights_);
        const Matrix3X<S> full_targets = targets_at_depth(bones.targets(skin_.positions));
        const ProjectedTargets<S> projected =
            project_targets(mesh_, skin_, thinned(full_targets), options_.target_cosine);
        report_.redirected_targets = projected.redirected;
        report_.redirection_rounds = projected.rounds;
        bone_ = flow_to_targets(mesh_, skin_.positions, skin_.directions, projected.points, options_.flow);
        set_fat(bones, full_targets);
        set_muscle();
        WrapCleanup<S> cleanup(mesh_, skin_.positions, projected.points, fat_, options_.cleanup);
        report_.cleanup_sweeps = cleanup.improve(bone_, muscle_);
        measure();
        refuse_thin("muscle", bone_, muscle_);
        refuse_thin("fat", muscle_, skin_.positions);
        refuse_unbuilt(options_.fat_thickness, "fat_thickness", fat_, skin_.positions - muscle_);
        refuse_unbuilt(options_.bone_depth, "bone_depth",
                       (projected.points - skin_.positions).colwise().norm().transpose(), skin_.positions - bone_);
        return assembled();
    }

private:
    void repair() {
        skin_ = repair_skin(mesh_, original_skin_, options_.repair);
        Index worst = 0;
        report_.smallest_cosine = skin_.cosines.minCoeff(&worst);
        require(report_.smallest_cosine >= options_.smallest_cosine, "layered body: below body vertex ",
                region_.body_vertices[size_t(worst)], " (joint ", main_joint(worst),
                ") no layer can exist: best cosine with its inward normals ", report_.smallest_cosine,
                " after the repair of the skin, expected >= ", options_.smallest_cosine);
        if (!skin_.crossings.empty()) {
            const auto [s, t] = skin_.crossings.front();
            throw_invalid_input("layered body: body triangles ", region_.body_triangles[size_t(s)], " and ",
                                region_.body_triangles[size_t(t)], " cross, and the repair of the skin leaves ",
                                skin_.crossings.size(), " such pairs, expected none");
        }
        const VectorX<S> moved = (skin_.positions - original_skin_).colwise().norm().transpose();
        report_.repaired_vertices = (moved.array() > S(0)).count();
        report_.largest_repair = moved.maxCoeff();
        report_.repair_rounds = skin_.rounds;
    }

    std::int32_t main_joint(Index column) const {
        Index joint = 0;
        skin_weights_.col(column).maxCoeff(&joint);
        return static_cast<std::int32_t>(joint);
    }

    /// `targets` no nearer to the skin than allowed, or at the depth that was given.
    Matrix3X<S> targets_at_depth(const Matrix3X<S>& targets) const {
        Matrix3X<S> result = targets;
        for (Index v = 0; v < targets.cols(); ++v) {
            const Vector3<S> way = targets.col(v) - skin_.positions.col(v);
            const S depth = options_.bone_depth.size() == 0 ? std::max(way.norm(), options_.smallest_depth)
                                                            : options_.bone_depth(region_.body_vertices[size_t(v)]);
            result.col(v) = skin_.positions.col(v) + way * (depth / way.norm());
        }
        return result;
    }

    Matrix3X<S> thinned(const Matrix3X<S>& targets) const {
        Matrix3X<S> result = targets;
        const S cut = options_.cut_fat + options_.cut_muscle;
        for (Index v = 0; v < targets.cols(); ++v) {
            const Vector3<S> way = targets.col(v) - skin_.positions.col(v);
            const S full = way.norm();
            const S depth = cut + (full - cut) * region_.fade(v, options_.decay_distance);
            result.col(v) = skin_.positions.col(v) + way * (depth / full);
        }
        return result;
    }

    void set_fat(const BoneTargets<S>& bones, const Matrix3X<S>& targets) {
        if (options_.fat_thickness.size() == 0) {
            fat_ = fat_thickness(options_.anatomy, bones, skin_.positions, targets, tissue_weights_,
                                 options_.smallest_fat);
        } else {
            fat_.resize(region_.num_vertices());
            for (Index v = 0; v < fat_.size(); ++v) {
                fat_(v) = options_.fat_thickness(region_.body_vertices[size_t(v)]);
            }
        }
        for (Index v = 0; v < fat_.size(); ++v) {
            fat_(v) = options_.cut_fat + (fat_(v) - options_.cut_fat) * region_.fade(v, options_.decay_distance);
        }
    }

    /// The muscle wrap at the wanted parts of the ways from skin to bone wrap. Equal parts everywhere cut every prism into
    /// valid ones, so the parts are evened out until all are.
    void set_muscle() {
        const Matrix3X<S> ways = bone_ - skin_.positions;
        VectorX<S> parts(ways.cols());
        for (Index v = 0; v < ways.cols(); ++v) {
            parts(v) = fat_fraction(fat_(v), ways.col(v).norm(), options_.cleanup.largest_fat_fraction);
        }
        const S mean = parts.mean();
        constexpr int max_rounds = 60;
        for (int round = 0; round < max_rounds; ++round) {
            muscle_ = skin_.positions + ways * parts.asDiagonal();
            if (is_valid(bone_, muscle_) && is_valid(muscle_, skin_.positions)) {
                return;
            }
            parts.array() += (mean - parts.array()) / S(2);
        }
    }

    bool is_valid(const Matrix3X<S>& lower, const Matrix3X<S>& upper) const {
        for (Index t = 0; t < mesh_.num_triangles(); ++t) {
            if (!(Prism6::smallest_jacobian_bound(nodes_between(mesh_.triangles(), t, lower, upper)) > S(0))) {
                return false;
            }
        }
        return true;
    }

    void measure() {
        const Matrix3X<S> inverse_sines = inverse_corner_sines(skin_.positions, mesh_.triangles());
        report_.muscle = measure_layer(mesh_.triangles(), bone_, muscle_, inverse_sines);
        report_.fat = measure_layer(mesh_.triangles(), muscle_, skin_.positions, inverse_sines);
        report_.bone_volume = capped_volume(bone_, mesh_.triangles(), region_.loops);
        require(report_.muscle.inverted_cells + report_.fat.inverted_cells == 0,
                "layered body: ", report_.muscle.inverted_cells, " muscle and ", report_.fat.inverted_cells,
                " fat prisms are inverted, expected none");
    }

    void refuse_thin(const char* layer, const Matrix3X<S>& lower, const Matrix3X<S>& upper) const {
        Index v = 0;
        const S thickness = (upper - lower).colwise().norm().minCoeff(&v);
        require(thickness >= options_.thinnest, "layered body: below body vertex ", region_.body_vertices[size_t(v)],
                " (joint ", main_joint(v), ") the skin leaves ", thickness, " m for the ", layer,
                ", expected >= ", options_.thinnest);
    }

    void refuse_unbuilt(const VectorX<S>& given, const char* name, const VectorX<S>& asked,
                        const Matrix3X<S>& built) const {
        for (Index v = 0; v < built.cols() && given.size() > 0; ++v) {
            require(built.col(v).norm() >= options_.accepted_share * asked(v), "layered body: ", name,
                    " of body vertex ", region_.body_vertices[size_t(v)], " (joint ", main_joint(v), "): asked ",
                    asked(v), ", possible ", built.col(v).norm());
        }
    }

    LayeredBody<S> assembled() {
        LayeredBody<S> body;
        body.layers = {region_.num_vertices(), 2};
        body.mesh.rest_positions.resize(3, body.layers.num_vertices());
        const MatrixX<S> weights = smoothed_weights();
        MatrixX<S> dense(body.layers.num_vertices(), weights.rows());
        for (Index v = 0; v < body.num_columns(); ++v) {
            for (Index level = 0; level < 3; ++level) {
                const Index vertex = body.layers.vertex(v, level);
                const Matrix3X<S>& surface = level == 0 ? bone_ : level == 1 ? muscle_ : skin_.positions;
                body.mesh.rest_positions.col(vertex) = surface.col(v);
                dense.row(vertex) = weights.col(v).transpose();
                if (level == 0 || region_.is_rim(v)) {
                    body.prescribed.push_back(static_cast<std::int32_t>(vertex));
                }
            }
        }
        body.weights = SkinningWeights<S>(dense);
        const Connectivity<6> interleaved = body.layers.prisms(region_.triangles);
        body.mesh.cells.resize(6, interleaved.cols());
        for (Index t = 0; t < region_.num_triangles(); ++t) {
            body.mesh.cells.col(t) = interleaved.col(2 * t);
            body.mesh.cells.col(region_.num_triangles() + t) = interleaved.col(2 * t + 1);
        }
        body.skin_offsets = original_skin_ - skin_.positions;
        body.report = report_;
        body.region = std::move(region_);
        return body;
    }

    /// The skin's weights smoothed, those on the cuts held.
    MatrixX<S> smoothed_weights() const {
        std::vector<bool> is_rim(size_t(region_.num_vertices()));
        for (Index v = 0; v < region_.num_vertices(); ++v) {
            is_rim[size_t(v)] = region_.is_rim(v);
        }
        return umbrella_smoothed<S, Eigen::Dynamic>(mesh_, skin_weights_, options_.weight_rounds, is_rim);
    }

    const LayeredBodyOptions<S>& options_;
    const Matrix3X<S>& joints_;
    SimulatedRegion<S> region_;
    TriangleMesh mesh_;
    Matrix3X<S> original_skin_;
    MatrixX<S> skin_weights_;
    MatrixX<S> tissue_weights_;
    RepairedSkin<S> skin_;
    VectorX<S> fat_;
    Matrix3X<S> bone_;
    Matrix3X<S> muscle_;
    LayeredBodyReport<S> report_;
};

}  // namespace detail

/// The layers of a body with skin `positions` (3 x n) and `joints` (3 x num_joints) at rest.
template <RealScalar S>
LayeredBody<S> make_layered_body(const Matrix3X<S>& positions, const Triangles& faces,
                                 const SkinningWeights<S>& weights, const KinematicTree& tree,
                                 const Matrix3X<S>& joints, const LayeredBodyOptions<S>& options = {}) {
    options.validate(positions.cols());
    options.anatomy.require_tree(tree);
    require(joints.cols() == tree.num_joints() && joints.allFinite(), "layered body: ", joints.cols(),
            " joint positions, expected ", tree.num_joints(), " finite ones");
    validate_closed_surface(positions, faces, "layered body: skin");
    return detail::LayeredBodyBuilder<S>(positions, faces, weights, joints, options).build();
}

/// The layers of a body's template.
template <RealScalar S>
LayeredBody<S> make_layered_body(const SmplBody<S>& body, const LayeredBodyOptions<S>& options = {}) {
    const Matrix3X<S> joints = (body.joint_regressor * body.template_vertices.transpose()).transpose();
    return make_layered_body(body.template_vertices, body.faces, body.weights, body.tree, joints, options);
}

}  // namespace softtissue
