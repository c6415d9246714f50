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
///             g is not the volume average of dN/dX: they agree for right prisms and differ by up to 60 % on sheared
///             ones.
/// Source      Nolte et al. 2026, eq. (1)-(3), with the fit integrated over the cell
/// Cost        gradient operator about 900 flop, no branch, no loop over quadrature points
/// Tests       tests/unit/element/prism6_test.cpp, tests/laws/element_laws_test.cpp
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
        Nodes<Scalar> Y = dual.transpose() * (X.colwise() - middle);
        const Eigen::Matrix<Scalar, 6, 6> mass = shape_products(Y);
        const Values<Scalar> integrals = mass.rowwise().sum();
        const Vector3<Scalar> centroid = Y * integrals / integrals.sum();
        Y.colwise() -= centroid;
        const Nodes<Scalar> first_moments = Y * mass;
        const Matrix3<Scalar> M = first_moments * Y.transpose();
        return dual * (dual_basis(M) * first_moments);
    }

    template <class Scalar>
    static Values<Scalar> shape_integrals(const Nodes<Scalar>& X) {
        const Matrix3<Scalar> jacobian = bernstein_jacobians(X);
        // int B_k (1 - s) ds = (3, 2, 1) / 12, reversed for s; int lambda_i lambda_l dlambda = (1 + delta_il) / 24.
        Eigen::Matrix<Scalar, 2, 3> weights;
        weights << Scalar(3), Scalar(2), Scalar(1), Scalar(1), Scalar(2), Scalar(3);
        const Eigen::Matrix<Scalar, 3, 2> q = (weights * jacobian).transpose() / Scalar(288);
        Values<Scalar> integrals;
        integrals.template head<3>() = q.col(0).array() + q.col(0).sum();
        integrals.template tail<3>() = q.col(1).array() + q.col(1).sum();
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

private:
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

    /// int N_i N_j dX: int B_k s^p (1-s)^(2-p) ds = (12, 6, 2 | 3, 4, 3 | 2, 6, 12) / 60 for p = 0, 1, 2, and
    /// int lambda_i lambda_j lambda_l dlambda = (1 + delta_ij)(1 + delta_il + delta_jl) / 120.
    template <class Scalar>
    static Eigen::Matrix<Scalar, 6, 6> shape_products(const Nodes<Scalar>& X) {
        Matrix3<Scalar> weights;
        weights << Scalar(12), Scalar(6), Scalar(2), Scalar(3), Scalar(4), Scalar(3), Scalar(2), Scalar(6), Scalar(12);
        const Matrix3<Scalar> q = (weights * bernstein_jacobians(X)) / Scalar(7200);
        Eigen::Matrix<Scalar, 6, 6> mass;
        for (int p = 0; p < 3; ++p) {
            Matrix3<Scalar> block;
            for (int i = 0; i < 3; ++i) {
                for (int j = 0; j < 3; ++j) {
                    const Scalar entry = q.row(p).sum() + q(p, i) + q(p, j);
                    block(i, j) = i == j ? entry + entry : entry;
                }
            }
            mass.template block<3, 3>(3 * (p / 2), 3 * ((p + 1) / 2)) = block;
        }
        mass.template bottomLeftCorner<3, 3>() = mass.template topRightCorner<3, 3>();
        return mass;
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
