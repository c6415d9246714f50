// SPDX-License-Identifier: MIT
/// @file
/// An energy that keeps a prism away from inversion, with its derivatives by one node.
///
/// What        PrismBarrier: zero where all nine relative_coefficients() r are above a threshold, infinite where one is <= 0.
/// Equation    sum over the nine of b(r / threshold),  b(q) = -(1 - q)^2 ln q for q < 1, else 0 (twice continuously
///             differentiable). With l = ln r = ln(n_k . d_i) - sum of logarithms of lengths:
///             db/dl = 2 q (1 - q) ln q - (1 - q)^2,  d2b/dl2 = q (2 (1 - 2 q) ln q + 4 (1 - q)).
///             As functions of one node all nine n_k . d_i are affine.
/// Shapes      X 3x6 [m]; gradient 3 [1/m], Hessian 3x3 [1/m^2], symmetric, indefinite.
/// Source      the function b: Li et al. 2020, "Incremental Potential Contact", eq. (6)
/// Cost        about 300 flop for the value; 100 more for the derivatives of each active coefficient
/// Tests       tests/unit/anatomy/prism_barrier_test.cpp
#pragma once

#include <softtissue/anatomy/prism_quality.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/element/prism6.hpp>

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <limits>

namespace softtissue {

template <RealScalar S>
struct PrismBarrier {
    S threshold;

    /// Infinity if a coefficient is not positive.
    S energy(const Prism6::Nodes<S>& X, const Vector3<S>& inverse_sines) const {
        using std::log;
        const Matrix3<S> q = relative_coefficients<S>(X, inverse_sines) / threshold;
        S sum(0);
        for (int entry = 0; entry < 9; ++entry) {
            const S value = q.data()[entry];
            if (!(value > S(0))) {
                return std::numeric_limits<S>::infinity();
            }
            if (value < S(1)) {
                sum -= (S(1) - value) * (S(1) - value) * log(value);
            }
        }
        return sum;
    }

    /// Adds the derivatives by the position of `node` of a prism with positive coefficients.
    void add_derivatives(const Prism6::Nodes<S>& X, const Vector3<S>& inverse_sines, int node, Vector3<S>& gradient,
                         Matrix3<S>& hessian) const {
        using std::log;
        const Matrix3<S> q = relative_coefficients<S>(X, inverse_sines) / threshold;
        if (q.minCoeff() >= S(1)) {
            return;
        }
        const NodeDerivatives derivatives(X, node);
        for (int i = 0; i < 3; ++i) {
            for (int k = 0; k < 3; ++k) {
                const S value = q(k, i);
                if (value >= S(1)) {
                    continue;
                }
                const S log_q = log(value);
                const S first = S(2) * value * (S(1) - value) * log_q - (S(1) - value) * (S(1) - value);
                const S second = value * (S(2) * (S(1) - S(2) * value) * log_q + S(4) * (S(1) - value));
                Vector3<S> g;
                Matrix3<S> H;
                derivatives.of_logarithm(k, i, g, H);
                gradient += first * g;
                hessian += second * g * g.transpose() + first * H;
            }
        }
    }

private:
    /// What the nine logarithms of r share, for one moving node.
    struct NodeDerivatives {
        Matrix3<S> values;                 // n_k . d_i
        std::array<Matrix3<S>, 3> slopes;  // column i of slopes[k]: derivative of n_k . d_i
        std::array<Vector3<S>, 3>
            length_gradients;  // of ln of the edge to the next corner, from the previous one, column
        std::array<Matrix3<S>, 3> length_hessians;
        int corner;
        int own_triangle;  // 0 below, 2 above

        NodeDerivatives(const Prism6::Nodes<S>& X, int node)
            : values(Prism6::bernstein_jacobians(X)), corner(node % 3), own_triangle(node < 3 ? 0 : 2) {
            const int next = (corner + 1) % 3;
            const int previous = (corner + 2) % 3;
            const Vector3<S> below = X.col(previous) - X.col(next);
            const Vector3<S> above = X.col(previous + 3) - X.col(next + 3);
            const Matrix3<S> columns = X.template rightCols<3>() - X.template leftCols<3>();
            // The moving node turns its own normal by (opposite edge) x step, the mixed one by half the facing triangle's
            // opposite edge x step, the facing one not at all.
            const Vector3<S> own = own_triangle == 0 ? below : above;
            const Vector3<S> mixed = S(0.5) * (own_triangle == 0 ? above : below);
            for (int i = 0; i < 3; ++i) {
                slopes[size_t(own_triangle)].col(i) = columns.col(i).cross(own);
                slopes[1].col(i) = columns.col(i).cross(mixed);
                slopes[size_t(2 - own_triangle)].col(i).setZero();
            }
            const S sign = own_triangle == 0 ? S(-1) : S(1);
            const Matrix3<S> n = Prism6::normals(X);
            for (int k = 0; k < 3; ++k) {
                slopes[size_t(k)].col(corner) += sign * n.col(k);
            }
            set_length(0, X.col(node) - X.col(next + node - corner));
            set_length(1, X.col(node) - X.col(previous + node - corner));
            set_length(2, X.col(node) - X.col((node + 3) % 6));
        }

        void of_logarithm(int k, int i, Vector3<S>& g, Matrix3<S>& H) const {
            const Vector3<S> slope = slopes[size_t(k)].col(i) / values(k, i);
            g = slope;
            H = -slope * slope.transpose();
            const S share = k == 1 ? S(0.5) : k == own_triangle ? S(1) : S(0);
            // The edge to the next corner bounds the corners `corner` and next, the other one `corner` and previous.
            if (i != (corner + 2) % 3) {
                subtract(0, share, g, H);
            }
            if (i != (corner + 1) % 3) {
                subtract(1, share, g, H);
            }
            if (i == corner) {
                subtract(2, S(1), g, H);
            }
        }

    private:
        void set_length(size_t which, const Vector3<S>& edge) {
            const S inverse = S(1) / edge.squaredNorm();
            length_gradients[which] = inverse * edge;
            length_hessians[which] =
                inverse * Matrix3<S>::Identity() - S(2) * length_gradients[which] * length_gradients[which].transpose();
        }

        void subtract(size_t which, S share, Vector3<S>& g, Matrix3<S>& H) const {
            g -= share * length_gradients[which];
            H -= share * length_hessians[which];
        }
    };
};

}  // namespace softtissue
