// SPDX-License-Identifier: MIT
/// @file
/// The five invariants on which every energy of a hinge depends, with their derivatives.
///
/// What        polynomials of the hinge's edge vectors e = x_j - x_i, a = x_k - x_i, b = x_l - x_i: smooth for every shape,
///             triangles without area included.
/// Equation    N1 = e x a, N2 = b x e  (area vectors of (i,j,k) and (j,i,l), twice the area long)
///             values = (N1.N2, -det(e,a,b), N1.N1, N2.N2, e.e)
///             angle = atan2(|e| values[1], values[0]): 0 where flat, positive where convex seen from outside
/// Shapes      edges 3x3 (columns e, a, b); jacobian 5x9 and the contracted Hessian 9x9 on column-major vec(edges)
/// Packs       of hinges too, the angle lane by lane
/// Source      angle: Grinspun et al. 2003
/// Tests       tests/unit/energy/hinge_invariants_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Geometry>

#include <cmath>

namespace softtissue {

/// Places of the invariants in HingeInvariants::values.
enum HingeInvariant : int { hinge_cosine, hinge_sine, hinge_first_area, hinge_second_area, hinge_length };

/// What a measure's Hessian by the edges is at least about: J^T roots roots^T J + (moment d2theta)+, see angle_curvature.hpp.
template <RealLanes S, int num_roots>
struct HingeConvexPart {
    Eigen::Matrix<S, 5, num_roots> roots;  ///< by the invariants
    S moment;                              ///< derivative by the angle where that is all that counts, else 0
};

template <RealLanes S>
class HingeInvariants {
public:
    using Scalar = S;
    static constexpr int size = 5;
    using Values = Eigen::Matrix<Scalar, size, 1>;
    using SquareMatrix = Eigen::Matrix<Scalar, size, size>;
    using Jacobian = Eigen::Matrix<Scalar, size, 9>;

    explicit HingeInvariants(const Matrix3<Scalar>& edges)
        : edges_(edges), first_normal_(e().cross(a())), second_normal_(b().cross(e())) {
        values_ << first_normal_.dot(second_normal_), -first_normal_.dot(b()), first_normal_.squaredNorm(),
            second_normal_.squaredNorm(), e().squaredNorm();
    }

    const Values& values() const { return values_; }

    /// In (-pi, pi].
    Scalar angle() const {
        using std::sqrt;
        const Scalar y = sqrt(values_(hinge_length)) * values_(hinge_sine);
        const auto angle_of = [](auto sine, auto cosine) { return std::atan2(sine, cosine); };
        if constexpr (RealScalar<Scalar>) {
            return angle_of(y, values_(hinge_cosine));
        } else {
            return Scalar::map_lanes(angle_of, y, values_(hinge_cosine));
        }
    }

    Jacobian jacobian() const {
        const Vector3<Scalar>& n1 = first_normal_;
        const Vector3<Scalar>& n2 = second_normal_;
        Jacobian J = Jacobian::Zero();
        J.row(hinge_cosine) << (a().cross(n2) + n1.cross(b())).transpose(), n2.cross(e()).transpose(),
            e().cross(n1).transpose();
        J.row(hinge_sine) << b().cross(a()).transpose(), -n2.transpose(), -n1.transpose();
        J.row(hinge_first_area).template head<6>() << Scalar(2) * a().cross(n1).transpose(),
            Scalar(2) * n1.cross(e()).transpose();
        J.row(hinge_second_area).template head<3>() = Scalar(2) * n2.cross(b()).transpose();
        J.row(hinge_second_area).template tail<3>() = Scalar(2) * e().cross(n2).transpose();
        J.row(hinge_length).template head<3>() = Scalar(2) * e().transpose();
        return J;
    }

    /// sum_i c_i d2 values_i / d vec(edges)^2
    Matrix9<Scalar> contracted_hessian(const Values& c) const {
        const Scalar cosine = c(hinge_cosine), first = Scalar(2) * c(hinge_first_area),
                     second = Scalar(2) * c(hinge_second_area);
        const Scalar ee = e().squaredNorm(), ea = e().dot(a()), eb = e().dot(b());
        const Scalar corner = first * a().squaredNorm() + second * b().squaredNorm() +
                              Scalar(2) * (c(hinge_length) - cosine * a().dot(b()));
        const Matrix3<Scalar> across_e = c(hinge_sine) * cross_matrix(e()),
                              across_a = c(hinge_sine) * cross_matrix(a()),
                              across_b = c(hinge_sine) * cross_matrix(b());
        Matrix9<Scalar> H;
        for (int j = 0; j < 3; ++j) {  // plain loops: expressions of packs take long to compile
            for (int i = 0; i < 3; ++i) {
                const Scalar e_i = edges_(i, 0), a_i = edges_(i, 1), b_i = edges_(i, 2);
                const Scalar e_j = edges_(j, 0), a_j = edges_(j, 1), b_j = edges_(j, 2);
                const Scalar one = i == j ? Scalar(1) : Scalar(0);
                H(i, j) = cosine * (a_i * b_j + b_i * a_j) - first * (a_i * a_j) - second * (b_i * b_j) + one * corner;
                H(3 + i, 3 + j) = first * (one * ee - e_i * e_j);
                H(6 + i, 6 + j) = second * (one * ee - e_i * e_j);
                H(i, 3 + j) = cosine * (b_i * e_j - Scalar(2) * (e_i * b_j) + one * eb) +
                              first * (Scalar(2) * (e_i * a_j) - a_i * e_j - one * ea) + across_b(i, j);
                H(i, 6 + j) = cosine * (a_i * e_j - Scalar(2) * (e_i * a_j) + one * ea) +
                              second * (Scalar(2) * (e_i * b_j) - b_i * e_j - one * eb) - across_a(i, j);
                H(3 + i, 6 + j) = cosine * (e_i * e_j - one * ee) + across_e(i, j);
                H(3 + j, i) = H(i, 3 + j);
                H(6 + j, i) = H(i, 6 + j);
                H(6 + j, 3 + i) = H(3 + i, 6 + j);
            }
        }
        return H;
    }

private:
    using Column = typename Matrix3<Scalar>::ConstColXpr;
    Column e() const { return edges_.col(0); }
    Column a() const { return edges_.col(1); }
    Column b() const { return edges_.col(2); }

    /// [v]x w = v x w
    static Matrix3<Scalar> cross_matrix(const Vector3<Scalar>& v) {
        Matrix3<Scalar> M;
        M << Scalar(0), -v(2), v(1), v(2), Scalar(0), -v(0), -v(1), v(0), Scalar(0);
        return M;
    }

    Matrix3<Scalar> edges_;
    Vector3<Scalar> first_normal_;
    Vector3<Scalar> second_normal_;
    Values values_;
};

}  // namespace softtissue
