// SPDX-License-Identifier: MIT
/// @file
/// The curvature of a hinge's angle as a function of its edges, made positive semi-definite in closed form.
///
/// What        angle_curvature_roots(edges, moment): R with R R^T = sum over both triangles of (moment K_T)+
/// Equation    d2theta/dx2 = sum_T K_T,  K_T = N B^T + B N^T,
///             N = (n (x) p, n (x) q),  B = (t (x) q + m (x) p / 2, m (x) q),
///             where (x) puts a direction in front of one number for each vertex of T; n normal, t along the hinge, m = from the
///             hinge to the third vertex; p and q are the components by t and m of the gradients of the barycentric coordinates.
///             n is orthogonal to t and m, hence |K_T| = N Z N^T + B Z^-1 B^T with the geometric mean
///             Z = (N^T N)^-1 # (B^T B), 2x2, and K_T+ = (K_T + |K_T|) / 2 = r r^T, r = (N C + B C^-T) / sqrt(2), Z = C C^T.
///             For a negative moment the sign of B turns.
/// Shapes      edges 3x3 (columns e, a, b, see hinge_invariants.hpp); R 9x4 on column-major vec(edges)
/// Convex      exact for each triangle alone, in the metric of its vertices; the sum is at least the positive part of the sum
/// Valid       triangles with area where the moment is not 0; without moment R is 0 for every shape. Packs: lane by lane.
/// Source      2x2 means: Bhatia 2007, "Positive Definite Matrices", prop. 4.1.12
/// Cost        about 250 flop, no iteration
/// Tests       tests/unit/energy/angle_curvature_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Geometry>

#include <cmath>

namespace softtissue {

namespace detail {

/// Of the triangle with the hinge e and the edge c from the hinge's first vertex to the third: the columns of r in the rows of e
/// and of c. `half_root` = sqrt(|moment| / 2), `sign` that of the moment.
template <RealLanes S>
struct TriangleCurvature {
    Vector3<S> at_hinge[2], at_third[2];

    TriangleCurvature(const Vector3<S>& e, const Vector3<S>& c, const S& half_root, const S& sign) {
        using std::sqrt;
        const auto is_active = half_root > S(0);
        const Vector3<S> area = e.cross(c);
        const S squared_length = select(is_active, e.squaredNorm(), S(1));
        const S inverse_length = S(1) / sqrt(squared_length);
        const S inverse_area = S(1) / sqrt(select(is_active, area.squaredNorm(), S(1)));
        const S inverse_height = inverse_area * squared_length * inverse_length;
        const S foot = e.dot(c) / squared_length;
        const Vector3<S> t = inverse_length * e, n = inverse_area * area, m = inverse_height * (c - foot * e);

        const S pp = S(2) * inverse_length * inverse_length;
        const S pq = (S(1) - S(2) * foot) * inverse_length * inverse_height;
        const S squared_inverse_height = inverse_height * inverse_height;
        const S qq = squared_inverse_height * (S(2) * foot * (foot - S(1)) + S(2));
        const S det_N = S(1.5) * pp * squared_inverse_height;  // pp qq - pq^2
        const S det_B = qq * qq + S(0.25) * det_N;
        // Z = mean (adj(N^T N) / sqrt(det_N) + B^T B / sqrt(det_B)), det Z = sqrt(det_B / det_N)
        const S root_N = S(1) / sqrt(det_N), root_B = S(1) / sqrt(det_B);
        const S Z00 = root_N * qq + root_B * (qq + S(0.25) * pp);
        const S Z10 = (S(0.5) * root_B - root_N) * pq;
        const S Z11 = root_N * pp + root_B * qq;
        const S root_det = sqrt(sqrt(det_B / det_N));
        const S scale = root_det / sqrt(Z00 * Z11 - Z10 * Z10);
        const S C00 = sqrt(scale * Z00), C10 = scale * Z10 / C00, C11 = root_det / C00;

        // C^-T = (1 / C00, -C10 / root_det; 0, 1 / C11)
        const Vector3<S> first = (half_root * C00) * n, second = (half_root * C10) * n, third = (half_root * C11) * n;
        const S inverse_sign = sign * half_root;
        const Vector3<S> t_first = (inverse_sign / C00) * t, m_first = (S(0.5) * inverse_sign / C00) * m;
        const S mixed = -C10 / root_det * inverse_sign;
        const Vector3<S> t_second = mixed * t, m_second = S(0.5) * mixed * m, m_last = (inverse_sign / C11) * m;
        const auto fill = [&](const S& p, const S& q, Vector3<S>(&columns)[2]) {
            columns[0] = p * (first + m_first) + q * (second + t_first);
            columns[1] = p * m_second + q * (third + t_second + m_last);
        };
        fill(inverse_length, -foot * inverse_height, at_hinge);
        fill(S(0), inverse_height, at_third);
    }
};

}  // namespace detail

/// See the file comment.
template <RealLanes S>
Eigen::Matrix<S, 9, 4> angle_curvature_roots(const Matrix3<S>& edges, const S& moment) {
    using std::abs;
    using std::sqrt;
    const S half_root = sqrt(S(0.5) * abs(moment));
    const S sign = select(moment < S(0), S(-1), S(1));
    const Vector3<S> e = edges.col(0), a = edges.col(1), b = edges.col(2);
    const detail::TriangleCurvature<S> first(e, a, half_root, sign);
    const detail::TriangleCurvature<S> second(e, b, half_root, -sign);  // its normal, e x b, points the other way
    Eigen::Matrix<S, 9, 4> R;
    for (int k = 0; k < 2; ++k) {
        R.col(k) << first.at_hinge[k], first.at_third[k], Vector3<S>(S(0), S(0), S(0));
        R.col(2 + k) << second.at_hinge[k], Vector3<S>(S(0), S(0), S(0)), second.at_third[k];
    }
    return R;
}

}  // namespace softtissue
