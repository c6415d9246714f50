// SPDX-License-Identifier: MIT
/// @file
/// Moves an inner surface from just below the skin towards its targets, every prism between valid at every step.
///
/// What        flow_to_targets(): the inner surface, which shares the skin's triangles.
/// Method      Starts at the skin moved inwards a little along the best directions. Targets recede from the skin to their
///             final places in `stages`; for each a few Gauss-Seidel sweeps in random order move every vertex by a share of its
///             error e_i, in every second sweep also by a share of e_i - mean_j e_j. A step is halved until all
///             relative_coefficients() of the prisms around are >= threshold, or none is worse than before; else not made.
/// Valid       the result has no prism with a coefficient below min(threshold, that of the start). Targets that cannot be
///             reached are approached as far as the neighbours' columns allow.
/// Refuses     nothing: where the start is not valid (a skin without cones) `smallest_coefficient` is <= 0.
/// Cost        (3 stages + final_sweeps) sweeps
/// Tests       tests/unit/anatomy/wrap_flow_test.cpp
#pragma once

#include <softtissue/anatomy/prism_quality.hpp>
#include <softtissue/anatomy/shuffled_order.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>
#include <softtissue/mesh/umbrella_mean.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace softtissue {

template <RealScalar S>
struct WrapFlowOptions {
    S threshold = S(0.2);
    int stages = 60;
    int sweeps_per_stage = 3;
    int final_sweeps = 40;
    S start_depth = S(0.0005);
    S max_step = S(0.002);
};

namespace detail {

template <RealScalar S>
class WrapFlow {
public:
    WrapFlow(const TriangleMesh& mesh, const Matrix3X<S>& skin, const Matrix3X<S>& directions,
             const WrapFlowOptions<S>& options)
        : mesh_(mesh),
          skin_(skin),
          inverse_sines_(inverse_corner_sines(skin, mesh.triangles())),
          options_(options),
          order_(mesh.num_vertices()) {
        // Below a sliver even half a millimetre can be too deep.
        constexpr int max_halvings = 10;
        S depth = options.start_depth;
        x_ = skin + depth * directions;
        for (int halving = 0; halving < max_halvings && smallest_of_all() < options.threshold; ++halving) {
            depth /= S(2);
            x_ = skin + depth * directions;
        }
    }

    Matrix3X<S> run(const Matrix3X<S>& targets) {
        for (int stage = 1; stage <= options_.stages; ++stage) {
            const S part = S(stage) / S(options_.stages);
            const Matrix3X<S> stage_targets = skin_ + part * (targets - skin_);
            for (int k = 0; k < options_.sweeps_per_stage; ++k) {
                sweep(stage_targets, k % 2 == 1);
            }
        }
        for (int k = 0; k < options_.final_sweeps; ++k) {
            sweep(targets, k % 2 == 1);
        }
        return x_;
    }

private:
    S smallest(std::int32_t triangle) const {
        const Prism6::Nodes<S> X = nodes_between(mesh_.triangles(), triangle, x_, skin_);
        return relative_coefficients<S>(X, inverse_sines_.col(triangle)).minCoeff();
    }

    S smallest_around(std::int32_t vertex) const {
        S result = std::numeric_limits<S>::infinity();
        for (const std::int32_t t : mesh_.vertex_triangles(vertex)) {
            result = std::min(result, smallest(t));
        }
        return result;
    }

    S smallest_of_all() const {
        S result = std::numeric_limits<S>::infinity();
        for (Index t = 0; t < mesh_.num_triangles(); ++t) {
            result = std::min(result, smallest(static_cast<std::int32_t>(t)));
        }
        return result;
    }

    void sweep(const Matrix3X<S>& targets, bool is_smoothing) {
        constexpr S negligible = S(1e-5);
        for (const std::int32_t v : order_.next()) {
            const Vector3<S> error = targets.col(v) - x_.col(v);
            if (error.squaredNorm() < negligible * negligible) {
                continue;
            }
            Vector3<S> step = S(0.6) * error;
            if (is_smoothing) {
                step += S(0.3) * (error - (umbrella_mean<S, 3>(mesh_, targets, v) - umbrella_mean<S, 3>(mesh_, x_, v)));
            }
            const S length = step.norm();
            if (length > options_.max_step) {
                step *= options_.max_step / length;
            }
            make_step(v, step);
        }
    }

    void make_step(std::int32_t v, Vector3<S> step) {
        constexpr int max_halvings = 4;
        const Vector3<S> before = x_.col(v);
        const S needed = std::min(options_.threshold, smallest_around(v));
        for (int halving = 0; halving <= max_halvings; ++halving) {
            x_.col(v) = before + step;
            if (smallest_around(v) >= needed) {
                return;
            }
            step /= S(2);
        }
        x_.col(v) = before;
    }

    const TriangleMesh& mesh_;
    const Matrix3X<S>& skin_;
    Matrix3X<S> inverse_sines_;
    WrapFlowOptions<S> options_;
    ShuffledOrder order_;
    Matrix3X<S> x_;
};

}  // namespace detail

/// The inner surface, 3 x n; directions: inwards, unit, inside the cones of the skin.
template <RealScalar S>
Matrix3X<S> flow_to_targets(const TriangleMesh& mesh, const Matrix3X<S>& skin, const Matrix3X<S>& directions,
                            const Matrix3X<S>& targets, const WrapFlowOptions<S>& options = {}) {
    return detail::WrapFlow<S>(mesh, skin, directions, options).run(targets);
}

}  // namespace softtissue
