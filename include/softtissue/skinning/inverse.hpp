// SPDX-License-Identifier: MIT
/// @file
/// Inverse skinning: from posed positions back to rest space, and how safe that is.
///
/// What        unposed positions; detection of blended transforms that are near singular.
/// Equation    u_i = A_i^-1 (x_i - t_i) - delta_i
/// Shapes      positions 3 x vertices [m]; one transform per vertex.
/// Valid       where the smallest singular value of A_i is well above zero: errors and forces of u grow by its
///             inverse. Rigid blends (DualQuaternion) have 1; LinearBlend of two joints of equal weight a twist of
///             angle a apart has cos(a/2), and blends of more joints can mirror (negative value).
/// Source      Romero et al. 2020, sec. 4.2
/// Cost        unposed: 60 flop per vertex; check: the eigenvalues of a 3x3 matrix in closed form per vertex
/// Tests       tests/unit/skinning/inverse_test.cpp, laws: tests/laws/skinning_laws_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/linalg/cofactor.hpp>
#include <softtissue/linalg/symmetric_eigen.hpp>
#include <softtissue/skinning/posed_body.hpp>

#include <Eigen/Eigenvalues>

#include <cmath>
#include <limits>
#include <span>
#include <type_traits>

namespace softtissue {

/// Blends below this are reported: two joints of equal weight 168 degrees apart, forces amplified tenfold.
template <RealScalar S>
inline constexpr S near_singular_blend = S(0.1);

/// The worst of a body's blended transforms.
template <RealScalar S>
struct BlendReport {
    Index vertex = 0;
    S smallest_singular_value = S(0);  ///< negative where the transform mirrors
    bool near_singular = false;
    Index num_near_singular = 0;
};

namespace detail {

/// C = cofactor(A), largest eigenvalue of C^T C: |C|_2 = s1 s2 and s3 = det A / |C|_2, without cancellation near s3 = 0.
template <RealScalar S>
S singular_value_from_cofactor(const Matrix3<S>& A, const Matrix3<S>& C, S gram_eigenvalue) {
    return gram_eigenvalue <= S(0) ? S(0) : determinant(A, C) / std::sqrt(gram_eigenvalue);
}

/// The same in closed form: five times faster, relative error up to about sqrt(epsilon).
template <RealScalar S>
S smallest_singular_value_estimate(const Matrix3<S>& A) {
    const Matrix3<S> C = cofactor(A);
    const Matrix3<S> gram = C.transpose() * C;
    Eigen::SelfAdjointEigenSolver<Matrix3<S>> solver;
    solver.computeDirect(gram, Eigen::EigenvaluesOnly);
    return singular_value_from_cofactor(A, C, solver.eigenvalues()(2));
}

}  // namespace detail

/// Smallest singular value with the sign of the determinant, to rounding.
template <RealScalar S>
S signed_smallest_singular_value(const Matrix3<S>& A) {
    const Matrix3<S> C = cofactor(A);
    const Matrix3<S> gram = C.transpose() * C;
    return detail::singular_value_from_cofactor(A, C, symmetric_eigen<S, 3>(gram).values.maxCoeff());
}

/// Finds the vertex whose blended transform is closest to singular (of several within sqrt(epsilon), any), and how
/// many are below `threshold`.
template <RealScalar S>
BlendReport<S> check_blends(std::span<const AffineTransform<S>> transforms,
                            std::type_identity_t<S> threshold = near_singular_blend<S>) {
    require(!transforms.empty(), "check_blends: no transforms, expected one per vertex");
    BlendReport<S> report;
    S smallest = std::numeric_limits<S>::infinity();
    for (size_t v = 0; v < transforms.size(); ++v) {
        const S value = detail::smallest_singular_value_estimate(transforms[v].linear);
        if (!(value >= smallest) && !std::isnan(smallest)) {  // a transform that is not finite is the worst
            smallest = value;
            report.vertex = Index(v);
        }
        report.num_near_singular += value >= threshold ? 0 : 1;
    }
    report.smallest_singular_value = signed_smallest_singular_value(transforms[size_t(report.vertex)].linear);
    report.near_singular = report.num_near_singular > 0;
    return report;
}

/// Throws InvalidInput naming the worst vertex where a blended transform is below `threshold`.
template <RealScalar S>
void require_invertible_blends(const PosedBody<S>& posed,
                               std::type_identity_t<S> threshold = near_singular_blend<S>) {
    const BlendReport<S> report = check_blends<S>(posed.transforms, threshold);
    require(!report.near_singular, "inverse skinning: blended transform of vertex ", report.vertex,
            " has smallest singular value ", report.smallest_singular_value, ", expected >= ", threshold, " (",
            report.num_near_singular, " such vertices)");
}

/// Writes u_i = A_i^-1 (x_i - t_i) - delta_i; allocates nothing. x and unposed may be the same array.
template <RealScalar S, Executor Exec = SequentialExecutor>
void unposed_into(const PosedBody<S>& posed, ConstRef<Matrix3X<std::type_identity_t<S>>> x,
                  Eigen::Ref<Matrix3X<std::type_identity_t<S>>> unposed, const Exec& executor = {}) {
    require(x.cols() == posed.num_vertices() && unposed.cols() == posed.num_vertices(), "inverse skinning: ",
            x.cols(), " positions into ", unposed.cols(), ", expected ", posed.num_vertices());
    executor.for_each_range(x.cols(), [&](Index begin, Index end) {
        for (Index v = begin; v < end; ++v) {
            const AffineTransform<S>& T = posed.transforms[size_t(v)];
            const Matrix3<S> C = cofactor(T.linear);
            const Vector3<S> d = x.col(v) - T.translation;
            unposed.col(v) = C.transpose() * d / determinant(T.linear, C) - posed.offsets.col(v);
        }
    });
}

/// u_i = A_i^-1 (x_i - t_i) - delta_i, 3 x vertices [m].
template <RealScalar S>
Matrix3X<S> unposed(const PosedBody<S>& posed, ConstRef<Matrix3X<std::type_identity_t<S>>> x) {
    Matrix3X<S> result(3, x.cols());
    unposed_into(posed, x, result);
    return result;
}

}  // namespace softtissue
