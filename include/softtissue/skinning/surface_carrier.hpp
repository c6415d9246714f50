// SPDX-License-Identifier: MIT
/// @file
/// Carries what a skinned surface knows per vertex into a volume that shares vertices with it.
///
/// What        skinning weights, shape and pose blend shapes for the vertices of a volume.
/// Equation    Z = L W, V_s = L S_s, V_p = L S_p with L the interpolation from the matched vertices
/// Shapes      as in skinning/smpl_body.hpp. The interpolator maps one row per match, in the order of the matches,
///             to one row per volume vertex (mesh/harmonic.hpp makes one; any callable will do).
/// Valid       matched vertices take the surface's rows exactly, whatever the interpolator returns for them.
/// Refuses     matches out of range or twice, interpolated values of another size or not finite, a vertex that is
///             left without weight (InvalidInput names the vertex); more than 32-bit indices can number.
/// Source      Romero et al. 2020, eq. (2)
/// Departs     Cotangent interpolation may give small negative weights: these and those below smallest_weight are
///             dropped and the rest is normalised. Interpolated pose blend shapes below smallest_pose_direction are
///             dropped. Both keep the rows sparse: harmonic functions vanish nowhere.
/// Tests       tests/unit/skinning/surface_carrier_test.cpp
#pragma once

#include <softtissue/core/checked_index.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/skinning/smpl_body.hpp>
#include <softtissue/skinning/weights.hpp>

#include <Eigen/SparseCore>

#include <cmath>
#include <concepts>
#include <span>
#include <vector>

namespace softtissue {

/// A vertex of a volume that is a vertex of the surface.
struct VertexMatch {
    std::int32_t volume;
    std::int32_t surface;
};

/// What is left out of interpolated rows; with zeros only weights that are not positive are.
template <RealScalar S>
struct CarryOptions {
    S smallest_weight = S(1e-4);          ///< a dropped weight moves a vertex by 1e-4 of the joints' relative motion
    S smallest_pose_direction = S(1e-6);  ///< [m], times an entry of R - I (at most 2)
};

/// Extends values known at some vertices (one row each) to all vertices of a volume.
template <class I, class S>
concept FieldInterpolator = requires(const I& interpolate, const MatrixX<S>& known) {
    { interpolate(known) } -> std::convertible_to<MatrixX<S>>;
};

template <RealScalar S, FieldInterpolator<S> Interpolator>
class SurfaceCarrier {
public:
    using SparseMatrix = typename SmplBody<S>::SparseMatrix;

    /// Keeps references to `matches` and `interpolate`.
    SurfaceCarrier(Index num_surface_vertices, Index num_volume_vertices, std::span<const VertexMatch> matches,
                   const Interpolator& interpolate, CarryOptions<S> options = {})
        : num_surface_(checked_index(num_surface_vertices, "surface carrier: vertices of the surface")),
          num_volume_(num_volume_vertices),
          matches_(matches),
          is_matched_(size_t(checked_index(3 * num_volume_vertices, "surface carrier: coordinates of the volume") / 3),
                      false),
          interpolate_(interpolate),
          options_(options) {
        for (const VertexMatch& match : matches) {
            require(
                match.volume >= 0 && match.volume < num_volume_ && match.surface >= 0 && match.surface < num_surface_,
                "surface carrier: match of volume vertex ", match.volume, " with surface vertex ", match.surface,
                ", expected below ", num_volume_, " and ", num_surface_);
            require(!is_matched_[size_t(match.volume)], "surface carrier: volume vertex ", match.volume,
                    " is matched twice");
            is_matched_[size_t(match.volume)] = true;
        }
    }

    /// Rows of the surface's vertices to rows of the volume's.
    MatrixX<S> rows(const MatrixX<S>& surface) const {
        MatrixX<S> known(Index(matches_.size()), surface.cols());
        for (size_t m = 0; m < matches_.size(); ++m) {
            known.row(Index(m)) = surface.row(matches_[m].surface);
        }
        MatrixX<S> result = interpolate_(known);
        require(result.rows() == num_volume_ && result.cols() == surface.cols(), "surface carrier: interpolation is ",
                result.rows(), " x ", result.cols(), ", expected ", num_volume_, " x ", surface.cols());
        for (const VertexMatch& match : matches_) {
            result.row(match.volume) = surface.row(match.surface);
        }
        for (Index v = 0; v < num_volume_; ++v) {
            require(result.row(v).allFinite(), "surface carrier: interpolated value at volume vertex ", v,
                    " is not finite");
        }
        return result;
    }

    SkinningWeights<S> weights(const SkinningWeights<S>& surface) const {
        MatrixX<S> dense = rows(surface.dense());
        for (Index v = 0; v < num_volume_; ++v) {
            if (is_matched_[size_t(v)]) {
                continue;
            }
            for (Index j = 0; j < dense.cols(); ++j) {
                if (dense(v, j) < options_.smallest_weight || dense(v, j) < S(0)) {
                    dense(v, j) = S(0);
                }
            }
            const S sum = dense.row(v).sum();
            require(sum > S(0), "surface carrier: interpolated weights of volume vertex ", v, " sum to ", sum,
                    ", expected > 0");
            dense.row(v) /= sum;
        }
        return SkinningWeights<S>(dense);
    }

    /// 3n x shapes.
    MatrixX<S> shape_directions(const MatrixX<S>& surface) const {
        MatrixX<S> values(num_surface_, 3 * surface.cols());  // one row per vertex: column 3 s + d
        for (Index s = 0; s < surface.cols(); ++s) {
            const Eigen::Map<const Matrix3X<S>> direction(surface.col(s).data(), 3, num_surface_);
            values.middleCols(3 * s, 3) = direction.transpose();
        }
        const MatrixX<S> carried = rows(values);
        MatrixX<S> result(3 * num_volume_, surface.cols());
        for (Index s = 0; s < surface.cols(); ++s) {
            Eigen::Map<Matrix3X<S>>(result.col(s).data(), 3, num_volume_) = carried.middleCols(3 * s, 3).transpose();
        }
        return result;
    }

    /// 3n x 9 (joints - 1), a joint at a time: 27 dense columns instead of 27 (joints - 1).
    SparseMatrix pose_directions(const SparseMatrix& surface) const {
        using ByColumn = Eigen::SparseMatrix<S, Eigen::ColMajor>;
        const ByColumn columns = surface;
        std::vector<Eigen::Triplet<S>> entries;
        for (Index block = 0; block < columns.cols(); block += 9) {
            MatrixX<S> values = MatrixX<S>::Zero(num_surface_, 27);  // column 3 k + d
            for (Index k = 0; k < 9; ++k) {
                for (typename ByColumn::InnerIterator entry(columns, block + k); entry; ++entry) {
                    values(entry.row() / 3, 3 * k + entry.row() % 3) = entry.value();
                }
            }
            const MatrixX<S> carried = rows(values);
            for (Index v = 0; v < num_volume_; ++v) {
                const S smallest = is_matched_[size_t(v)] ? S(0) : options_.smallest_pose_direction;
                for (Index c = 0; c < 27; ++c) {
                    const S value = carried(v, c);
                    if (value != S(0) && std::abs(value) >= smallest) {
                        entries.emplace_back(int(3 * v + c % 3), int(block + c / 3), value);
                    }
                }
            }
        }
        checked_index(Index(entries.size()), "surface carrier: entries of pose directions");
        SparseMatrix result(3 * num_volume_, columns.cols());
        result.setFromTriplets(entries.begin(), entries.end());
        return result;
    }

private:
    Index num_surface_;
    Index num_volume_;
    std::span<const VertexMatch> matches_;
    std::vector<bool> is_matched_;
    const Interpolator& interpolate_;
    CarryOptions<S> options_;
};

}  // namespace softtissue
