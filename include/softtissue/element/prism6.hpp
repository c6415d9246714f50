// SPDX-License-Identifier: MIT
/// @file
/// Linear triangular prism (wedge): two facing triangles, three bilinear sides.
///
/// What        exact volume, best-fit gradient operator, shape functions and their inverse map
/// Equation    N_i = lambda_i (1 - zeta) / 2, N_{i+3} = lambda_i (1 + zeta) / 2, i = 0, 1, 2;
///             det dX/d(lambda_1, lambda_2, s) = sum_k sum_i B_k(s) lambda_i n_k . d_i, s = (1 + zeta) / 2, B_k the
///             quadratic Bernstein polynomials, d_i = X_{i+3} - X_i, n_0 and n_2 the normals (e_1 x e_2) of the two
///             triangles and n_1 their mixed product;  V = sum_k sum_i n_k . d_i / 18;
///             g_i = M^-1 int N_i (X - c) dX, M = int (X - c)(X - c)^T dX: the gradient of the affine map that fits the
///             cell's own map best over the rest cell. All integrals are closed forms of the nine n_k . d_i, exact.
/// Shapes      X 3x6 [m]; natural coordinates xi = (lambda_1, lambda_2, zeta), lambda_0 = 1 - lambda_1 - lambda_2,
///             zeta in [-1, 1]
/// Node order  0-2 one triangle, counter-clockwise seen from the other; 3-5 the nodes facing them
/// Valid       every X whose nine n_k . d_i are positive (sufficient, not necessary), however thin: the fit is done in
///             the frame of the mean prism, where M is well conditioned. CellMesh::validate refuses the others.
/// Limits      one gradient a cell leaves six hourglass modes: 9 of the 18 nodal freedoms are seen, 3 are translations.
///             g is not the volume average of dN/dX: they agree for right prisms only.
/// Source      Nolte et al. 2026, eq. (1)-(3), with the fit integrated over the cell
/// Cost        gradient operator about 900 flop, no branch, no loop over quadrature points
/// Tests       tests/unit/element/prism6_test.cpp, tests/laws/element_laws_prism6_test.cpp
#pragma once

#include <softtissue/element/concepts.hpp>

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/cubic_roots.hpp>
#include <softtissue/linalg/dual_basis.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace softtissue {

struct Prism6 {
    static constexpr int num_nodes = 6;
    static constexpr std::array<ElementFace, 5> faces{{
        {3, {0, 2, 1, -1}},
        {3, {3, 4, 5, -1}},
        {4, {0, 1, 4, 3}},
        {4, {1, 2, 5, 4}},
        {4, {2, 0, 3, 5}},
    }};
    /// Three rotations; and top for bottom, with the triangle's order reversed.
    static constexpr std::array<std::array<int, 6>, 6> symmetries{{
        {0, 1, 2, 3, 4, 5},
        {1, 2, 0, 4, 5, 3},
        {2, 0, 1, 5, 3, 4},
        {3, 5, 4, 0, 2, 1},
        {5, 4, 3, 2, 1, 0},
        {4, 3, 5, 1, 0, 2},
    }};

    template <class Scalar>
    using Nodes = Eigen::Matrix<Scalar, 3, num_nodes>;
    template <class Scalar>
    using Values = Eigen::Matrix<Scalar, num_nodes, 1>;

    /// The volume between the bilinear sides; not that of a split into tets.
    template <class Scalar>
    static Scalar rest_volume(const Nodes<Scalar>& X) {
        return normals(X).rowwise().sum().dot(thicknesses(X).rowwise().sum()) / Scalar(18);
    }

    template <class Scalar>
    static Nodes<Scalar> gradient_operator(const Nodes<Scalar>& X) {
        const Vector3<Scalar> middle = X.rowwise().sum() / Scalar(6);
        const Matrix3<Scalar> dual = dual_basis(mean_frame(X));
        Nodes<Scalar> Y;  // in the frame of the mean prism
        for (int i = 0; i < num_nodes; ++i) {
            const Vector3<Scalar> local = X.col(i) - middle;
            Y.col(i) = dual.transpose() * local;
        }
        const Values<Scalar> integrals = shape_integrals(Y);
        Vector3<Scalar> centroid = Vector3<Scalar>::Zero();
        for (int i = 0; i < num_nodes; ++i) {
            centroid += integrals(i) * Y.col(i);
        }
        centroid /= integrals.sum();
        for (int i = 0; i < num_nodes; ++i) {
            Y.col(i) -= centroid;
        }
        const Nodes<Scalar> moments = first_moments(Y);
        Matrix3<Scalar> M = Matrix3<Scalar>::Zero();
        for (int i = 0; i < num_nodes; ++i) {
            for (int a = 0; a < 3; ++a) {
                M.col(a) += Y(a, i) * moments.col(i);
            }
        }
        const Matrix3<Scalar> to_world = dual * dual_basis(M);
        return to_world * moments;
    }

    template <class Scalar>
    static Values<Scalar> shape_integrals(const Nodes<Scalar>& X) {
        const Matrix3<Scalar> jacobian = bernstein_jacobians(X);
        // int B_k (1 - s) ds = (3, 2, 1) / 12, reversed for s; int lambda_i lambda_l dlambda = (1 + delta_il) / 24.
        Vector3<Scalar> bottom;
        Vector3<Scalar> top;
        for (int i = 0; i < 3; ++i) {
            const Scalar middle = Scalar(2) * jacobian(1, i);
            bottom(i) = (Scalar(3) * jacobian(0, i) + middle + jacobian(2, i)) / Scalar(288);
            top(i) = (jacobian(0, i) + middle + Scalar(3) * jacobian(2, i)) / Scalar(288);
        }
        const Scalar bottom_sum = bottom(0) + bottom(1) + bottom(2);
        const Scalar top_sum = top(0) + top(1) + top(2);
        Values<Scalar> integrals;
        for (int i = 0; i < 3; ++i) {
            integrals(i) = bottom_sum + bottom(i);
            integrals(i + 3) = top_sum + top(i);
        }
        return integrals;
    }

    template <class Scalar>
    static Values<Scalar> shape_values(const Vector3<Scalar>& xi) {
        const Vector3<Scalar> lambda(Scalar(1) - xi(0) - xi(1), xi(0), xi(1));
        Values<Scalar> N;
        N.template head<3>() = lambda * ((Scalar(1) - xi(2)) / Scalar(2));
        N.template tail<3>() = lambda * ((Scalar(1) + xi(2)) / Scalar(2));
        return N;
    }

    template <class Scalar>
    static Nodes<Scalar> shape_gradients(const Nodes<Scalar>& X, const Vector3<Scalar>& xi) {
        const Scalar bottom = (Scalar(1) - xi(2)) / Scalar(2);
        const Scalar top = (Scalar(1) + xi(2)) / Scalar(2);
        const Vector3<Scalar> lambda(Scalar(1) - xi(0) - xi(1), xi(0), xi(1));
        Nodes<Scalar> natural = Nodes<Scalar>::Zero();  // row a: dN/dxi_a
        for (int a = 0; a < 2; ++a) {
            natural(a, 0) = -bottom;
            natural(a, a + 1) = bottom;
            natural(a, 3) = -top;
            natural(a, a + 4) = top;
        }
        natural.row(2) << -lambda.transpose() / Scalar(2), lambda.transpose() / Scalar(2);
        const Nodes<Scalar> local = X.colwise() - X.col(0);  // far from the origin, the sum would cancel
        const Matrix3<Scalar> dX_dxi = local * natural.transpose();
        return dual_basis(dX_dxi) * natural;
    }

    template <class Scalar>
    static Vector3<Scalar> position(const Nodes<Scalar>& X, const Vector3<Scalar>& xi) {
        return X * shape_values(xi);
    }

    /// Every point of the cell is found, and points outside where the cell's map continued reaches them within 32
    /// thicknesses: p lies in the plane of the triangle at s, a cubic in s. Of several roots the one deepest inside
    /// counts.
    template <FieldScalar Scalar>
    static NaturalCoordinates<Scalar> natural_coordinates(const Nodes<Scalar>& X, const Vector3<Scalar>& p) {
        using Real = RealOf<Scalar>;
        constexpr Real reach = Real(32);
        const Nodes<Scalar> Y = X.colwise() - p;
        const std::array<Scalar, 4> height = plane_distance(Y);
        const Cubic<Real> height_value{value_of(height[0]), value_of(height[1]), value_of(height[2]),
                                       value_of(height[3])};
        const CubicRoots<Real> roots = cubic_roots(height_value, -reach, Real(1) + reach);

        NaturalCoordinates<Scalar> best{Vector3<Scalar>::Zero(), false};
        Real best_depth = -std::numeric_limits<Real>::infinity();
        for (int r = 0; r < roots.count; ++r) {
            Scalar s(roots.values[std::size_t(r)]);
            // One more Newton step in Scalar: carries derivatives through the root, and polishes it.
            s = s - (height[0] + s * (height[1] + s * (height[2] + s * height[3]))) /
                        (height[1] + s * (Scalar(2) * height[2] + s * Scalar(3) * height[3]));
            const Vector3<Scalar> xi = coordinates_in_plane(Y, s);
            const Real lambda_1 = value_of(xi(0));
            const Real lambda_2 = value_of(xi(1));
            const Real depth =
                std::min({lambda_1, lambda_2, Real(1) - lambda_1 - lambda_2, value_of(s), Real(1) - value_of(s)});
            if (depth > best_depth) {  // false for NaN
                best = {xi, true};
                best_depth = depth;
            }
        }
        return best;
    }

    /// The smallest of the nine Bernstein coefficients of det dX/d(lambda_1, lambda_2, s).
    template <class Scalar>
    static Scalar smallest_jacobian_bound(const Nodes<Scalar>& X) {
        return bernstein_jacobians(X).minCoeff();
    }

    /// n_k . d_i in row k, column i: the Bernstein coefficients of det dX/d(lambda_1, lambda_2, s).
    template <class Scalar>
    static Matrix3<Scalar> bernstein_jacobians(const Nodes<Scalar>& X) {
        return normals(X).transpose() * thicknesses(X);
    }

    /// Columns n_0, n_1, n_2: Bernstein coefficients of the normal of the triangle at s.
    template <class Scalar>
    static Matrix3<Scalar> normals(const Nodes<Scalar>& X) {
        const Vector3<Scalar> a1 = X.col(1) - X.col(0);
        const Vector3<Scalar> a2 = X.col(2) - X.col(0);
        const Vector3<Scalar> b1 = X.col(4) - X.col(3);
        const Vector3<Scalar> b2 = X.col(5) - X.col(3);
        Matrix3<Scalar> n;
        n.col(0) = a1.cross(a2);
        n.col(1) = (a1.cross(b2) + b1.cross(a2)) / Scalar(2);
        n.col(2) = b1.cross(b2);
        return n;
    }

private:
    /// Columns d_i.
    template <class Scalar>
    static Matrix3<Scalar> thicknesses(const Nodes<Scalar>& X) {
        return X.template rightCols<3>() - X.template leftCols<3>();
    }

    /// dX/d(lambda_1, lambda_2, s) at the middle of the cell.
    template <class Scalar>
    static Matrix3<Scalar> mean_frame(const Nodes<Scalar>& X) {
        const Matrix3<Scalar> twice = X.template leftCols<3>() + X.template rightCols<3>();
        Matrix3<Scalar> frame;
        frame.col(0) = (twice.col(1) - twice.col(0)) / Scalar(2);
        frame.col(1) = (twice.col(2) - twice.col(0)) / Scalar(2);
        frame.col(2) = thicknesses(X).rowwise().sum() / Scalar(3);
        return frame;
    }

    /// int N_i Y dY: int B_k s^p (1-s)^(2-p) ds = (12, 6, 2 | 3, 4, 3 | 2, 6, 12) / 60 for p = 0, 1, 2, and
    /// int lambda_i lambda_j lambda_l dlambda = (1 + delta_ij)(1 + delta_il + delta_jl) / 120.
    template <class Scalar>
    static Nodes<Scalar> first_moments(const Nodes<Scalar>& Y) {
        const Matrix3<Scalar> jacobian = bernstein_jacobians(Y);
        constexpr std::array<std::array<int, 3>, 3> weights{{{12, 6, 2}, {3, 4, 3}, {2, 6, 12}}};
        Nodes<Scalar> moments = Nodes<Scalar>::Zero();
        for (int p = 0; p < 3; ++p) {
            const std::array<int, 3>& w = weights[std::size_t(p)];
            Vector3<Scalar> q;
            for (int i = 0; i < 3; ++i) {
                q(i) = (Scalar(w[0]) * jacobian(0, i) + Scalar(w[1]) * jacobian(1, i) + Scalar(w[2]) * jacobian(2, i)) /
                       Scalar(7200);
            }
            const Scalar sum = q(0) + q(1) + q(2);
            for (int i = 0; i < 3; ++i) {
                for (int j = 0; j < 3; ++j) {
                    const Scalar product = (sum + q(i) + q(j)) * Scalar(i == j ? 2 : 1);
                    // p = 0: both nodes below, 2: both above, 1: one of each.
                    moments.col(i + 3 * (p / 2)) += product * Y.col(j + 3 * ((p + 1) / 2));
                    if (p == 1) {
                        moments.col(i + 3) += product * Y.col(j);
                    }
                }
            }
        }
        return moments;
    }

    /// n(s) . Y_0(s) in ascending powers of s: zero where the plane of the triangle at s holds the origin.
    template <class Scalar>
    static std::array<Scalar, 4> plane_distance(const Nodes<Scalar>& Y) {
        const Matrix3<Scalar> n = normals(Y);
        const Vector3<Scalar> bottom = n.transpose() * Y.col(0);
        const Vector3<Scalar> rise = n.transpose() * (Y.col(3) - Y.col(0));
        // n(s) = n_0 + 2 s (n_1 - n_0) + s^2 (n_0 - 2 n_1 + n_2), and the same for the two products.
        const Scalar bottom_1 = Scalar(2) * (bottom(1) - bottom(0));
        const Scalar bottom_2 = bottom(0) - Scalar(2) * bottom(1) + bottom(2);
        const Scalar rise_1 = Scalar(2) * (rise(1) - rise(0));
        const Scalar rise_2 = rise(0) - Scalar(2) * rise(1) + rise(2);
        return {bottom(0), bottom_1 + rise(0), bottom_2 + rise_1, rise_2};
    }

    /// Natural coordinates of the origin, which lies in the plane of the triangle at s.
    template <class Scalar>
    static Vector3<Scalar> coordinates_in_plane(const Nodes<Scalar>& Y, const Scalar& s) {
        const Matrix3<Scalar> triangle = (Scalar(1) - s) * Y.template leftCols<3>() + s * Y.template rightCols<3>();
        const Vector3<Scalar> e1 = triangle.col(1) - triangle.col(0);
        const Vector3<Scalar> e2 = triangle.col(2) - triangle.col(0);
        const Vector3<Scalar> n = e1.cross(e2);
        const Vector3<Scalar> scaled = n / n.squaredNorm();
        return {-triangle.col(0).cross(e2).dot(scaled), -e1.cross(triangle.col(0)).dot(scaled),
                Scalar(2) * s - Scalar(1)};
    }
};

}  // namespace softtissue
