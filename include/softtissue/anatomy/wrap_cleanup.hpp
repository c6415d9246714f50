// SPDX-License-Identifier: MIT
/// @file
/// Improves the shape of the prisms of a layered body, its skin held.
///
/// What        WrapCleanup: bone wrap B and muscle wrap M under a barrier against bad prisms, near their targets.
/// Equation    per vertex i:  sum over the prisms around, of both layers, of the PrismBarrier
///             + w_T |B_i - T_i|^2 + w_L mean_j |e_i - e_j|^2  (e = B - T)   or   + w_M |M_i - (s_i + lambda_i (B_i - s_i))|^2,
///             lambda_i = min(fat_i / |B_i - s_i|, largest_fat_fraction).
/// Method      Gauss-Seidel over the vertices in random order, B and M in turn: one Newton step with the 3x3 Hessian's
///             eigenvalues taken absolute, at most max_step long, halved until the energy falls. Stops when a sweep moves no
///             vertex by more than `negligible`. Coefficients do not feel how long a column is: below deep folds of the skin
///             a layer may vanish. Where an edge from surface to surface ends shorter than L_0 = short_column, all begins
///             again with (L_0 / L - 1)^2 for each edge that is shorter; not at first, as short columns turn more easily.
/// Valid       starts from positive coefficients and keeps them: the barrier is infinite elsewhere.
/// Tests       tests/unit/anatomy/wrap_cleanup_test.cpp
#pragma once

#include <softtissue/anatomy/prism_barrier.hpp>
#include <softtissue/anatomy/prism_quality.hpp>
#include <softtissue/anatomy/shuffled_order.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace softtissue {

template <RealScalar S>
struct WrapCleanupOptions {
    S threshold = S(0.45);  // coefficients below are pushed upwards
    S target_weight = S(2e3);
    S smoothing_weight = S(4e3);
    S fraction_weight = S(2e4);
    S largest_fat_fraction = S(0.45);
    S short_column = S(0.0012);  // L_0: edges between two surfaces that end shorter are pushed apart
    S max_step = S(0.005);
    S negligible = S(1e-4);
    int max_sweeps = 30;
};

/// lambda_i: the part of the way from the skin to the bone wrap where the muscle wrap is wanted.
template <RealScalar S>
S fat_fraction(S fat, S depth, S largest) {
    return std::min(fat / depth, largest);
}

/// Holds references to mesh, skin, targets and fat.
template <RealScalar S>
class WrapCleanup {
public:
    WrapCleanup(const TriangleMesh& mesh, const Matrix3X<S>& skin, const Matrix3X<S>& targets, const VectorX<S>& fat,
                const WrapCleanupOptions<S>& options)
        : mesh_(mesh),
          skin_(skin),
          targets_(targets),
          fat_(fat),
          inverse_sines_(inverse_corner_sines(skin, mesh.triangles())),
          barrier_{options.threshold},
          options_(options) {}

    /// Improves both wraps, which must give positive prisms; returns the number of sweeps.
    int improve(Matrix3X<S>& bone, Matrix3X<S>& muscle) {
        short_column_ = S(0);
        int sweeps = sweep_from(bone, muscle);
        if (shortest_column() < options_.short_column) {
            short_column_ = options_.short_column;
            sweeps += sweep_from(bone, muscle);
        }
        bone = bone_;
        muscle = muscle_;
        return sweeps;
    }

private:
    /// A quadratic energy of one vertex, w |x - centre|^2 + constant.
    struct Spring {
        S weight;
        Vector3<S> centre;
    };

    int sweep_from(const Matrix3X<S>& bone, const Matrix3X<S>& muscle) {
        bone_ = bone;
        muscle_ = muscle;
        ShuffledOrder order(mesh_.num_vertices());
        int sweep = 0;
        for (S moved = std::numeric_limits<S>::infinity(); sweep < options_.max_sweeps && moved > options_.negligible;
             ++sweep) {
            moved = S(0);
            for (const std::int32_t v : order.next()) {
                moved = std::max(moved, move_bone(v));
            }
            for (const std::int32_t v : order.next()) {
                moved = std::max(moved, move_muscle(v));
            }
        }
        return sweep;
    }

    S shortest_column() const {
        return std::min((muscle_ - bone_).colwise().norm().minCoeff(), (skin_ - muscle_).colwise().norm().minCoeff());
    }

    S move_bone(std::int32_t v) {
        Vector3<S> mean_error = Vector3<S>::Zero();
        for (const std::int32_t w : mesh_.neighbours(v)) {
            mean_error += bone_.col(w) - targets_.col(w);
        }
        mean_error /= S(mesh_.neighbours(v).size());
        const S weight = options_.target_weight + options_.smoothing_weight;
        const Vector3<S> centre = targets_.col(v) + (options_.smoothing_weight / weight) * mean_error;
        return newton_step(bone_, v, {weight, centre});
    }

    S move_muscle(std::int32_t v) {
        const Vector3<S> way = bone_.col(v) - skin_.col(v);
        const S fraction = fat_fraction(fat_(v), way.norm(), options_.largest_fat_fraction);
        return newton_step(muscle_, v, {options_.fraction_weight, skin_.col(v) + fraction * way});
    }

    /// Returns how far the vertex moved.
    S newton_step(Matrix3X<S>& wrap, std::int32_t v, const Spring& spring) {
        const Vector3<S> before = wrap.col(v);
        Vector3<S> gradient = S(2) * spring.weight * (before - spring.centre);
        Matrix3<S> hessian = Matrix3<S>::Zero();
        for_each_prism(wrap, v, [&](const Prism6::Nodes<S>& X, const Vector3<S>& inverse_sines, int node) {
            barrier_.add_derivatives(X, inverse_sines, node, gradient, hessian);
        });
        for_each_column(wrap, v, [&](const Vector3<S>& way) { add_column_derivatives(way, gradient, hessian); });
        hessian.diagonal().array() += S(2) * spring.weight;
        Vector3<S> step = solution(filtered<S, 3>(hessian, PsdFilter::absolute), -gradient);
        const S length = step.norm();
        // A hundredth of what ends the sweeps: not worth an evaluation.
        if (!(length > S(0.01) * options_.negligible)) {
            return S(0);
        }
        step *= std::min(S(1), options_.max_step / length);
        constexpr int max_halvings = 12;
        const S start = energy(wrap, v, spring);
        for (int halving = 0; halving <= max_halvings; ++halving) {
            wrap.col(v) = before + step;
            if (energy(wrap, v, spring) < start) {
                return step.norm();
            }
            step /= S(2);
        }
        wrap.col(v) = before;
        return S(0);
    }

    /// Of L L^T x = b, in place of `b`; plain loops, because Eigen's cost seconds to compile. Not finite where H is not definite.
    static Vector3<S> solution(Matrix3<S> H, Vector3<S> b) {
        for (int k = 0; k < 3; ++k) {
            for (int i = k; i < 3; ++i) {
                S sum(0);
                for (int j = 0; j < k; ++j) {
                    sum += H(i, j) * H(k, j);
                }
                H(i, k) = i == k ? std::sqrt(H(k, k) - sum) : (H(i, k) - sum) / H(k, k);
            }
        }
        for (int k = 0; k < 3; ++k) {
            S sum(0);
            for (int j = 0; j < k; ++j) {
                sum += H(k, j) * b(j);
            }
            b(k) = (b(k) - sum) / H(k, k);
        }
        for (int k = 2; k >= 0; --k) {
            S sum(0);
            for (int j = k + 1; j < 3; ++j) {
                sum += H(j, k) * b(j);
            }
            b(k) = (b(k) - sum) / H(k, k);
        }
        return b;
    }

    S energy(const Matrix3X<S>& wrap, std::int32_t v, const Spring& spring) const {
        S sum = spring.weight * (wrap.col(v) - spring.centre).squaredNorm();
        for_each_prism(wrap, v, [&](const Prism6::Nodes<S>& X, const Vector3<S>& inverse_sines, int) {
            sum += barrier_.energy(X, inverse_sines);
        });
        for_each_column(wrap, v, [&](const Vector3<S>& way) {
            const S excess = std::max(short_column_ / way.norm() - S(1), S(0));
            sum += excess * excess;
        });
        return sum;
    }

    void add_column_derivatives(const Vector3<S>& way, Vector3<S>& gradient, Matrix3<S>& hessian) const {
        const S length = way.norm(), ratio = short_column_ / length;
        if (ratio > S(1)) {
            const Vector3<S> direction = way / length;
            const S slope = S(-2) * (ratio - S(1)) * ratio / length;
            const S curvature = S(2) * ratio * (S(3) * ratio - S(2)) / (length * length);
            gradient += slope * direction;
            hessian += (curvature - slope / length) * direction * direction.transpose();
            hessian.diagonal().array() += slope / length;
        }
    }

    /// Calls body(way to vertex v of `wrap` from the same vertex of the next surface).
    template <class Body>
    void for_each_column(const Matrix3X<S>& wrap, std::int32_t v, const Body& body) const {
        body(Vector3<S>(wrap.col(v) - (&wrap == &muscle_ ? bone_ : muscle_).col(v)));
        if (&wrap == &muscle_) {
            body(Vector3<S>(wrap.col(v) - skin_.col(v)));
        }
    }

    /// Calls body(nodes, inverse sines, node of v) for the prisms that contain vertex v of `wrap`.
    template <class Body>
    void for_each_prism(const Matrix3X<S>& wrap, std::int32_t v, const Body& body) const {
        const bool is_muscle = &wrap == &muscle_;
        for (const std::int32_t t : mesh_.vertex_triangles(v)) {
            int corner = 0;
            while (mesh_.triangles()(corner, t) != v) {
                ++corner;
            }
            const Vector3<S> inverse_sines = inverse_sines_.col(t);
            body(nodes_between(mesh_.triangles(), t, bone_, muscle_), inverse_sines, is_muscle ? corner + 3 : corner);
            if (is_muscle) {
                body(nodes_between(mesh_.triangles(), t, muscle_, skin_), inverse_sines, corner);
            }
        }
    }

    const TriangleMesh& mesh_;
    const Matrix3X<S>& skin_;
    const Matrix3X<S>& targets_;
    const VectorX<S>& fat_;
    Matrix3X<S> inverse_sines_;
    PrismBarrier<S> barrier_;
    WrapCleanupOptions<S> options_;
    S short_column_ = S(0);
    Matrix3X<S> bone_;
    Matrix3X<S> muscle_;
};

}  // namespace softtissue
