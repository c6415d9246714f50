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
/// Source      angle: Grinspun et al. 2003
/// Tests       tests/unit/energy/hinge_invariants_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Geometry>

#include <cmath>

namespace softtissue {

/// Places of the invariants in HingeInvariants::values.
enum HingeInvariant : int { hinge_cosine, hinge_sine, hinge_first_area, hinge_second_area, hinge_length };

template <RealScalar S>
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
        return std::atan2(sqrt(values_(hinge_length)) * values_(hinge_sine), values_(hinge_cosine));
    }

    Jacobian jacobian() const {
        const Vector3<Scalar>& n1 = first_normal_;
        const Vector3<Scalar>& n2 = second_normal_;
        Jacobian J = Jacobian::Zero();
        J.row(hinge_cosine) << (a().cross(n2) + n1.cross(b())).transpose(), n2.cross(e()).transpose(), e().cross(n1).transpose();
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
        const Matrix3<Scalar> gram = edges_.transpose() * edges_;
        const Matrix3<Scalar> ee = e() * e().transpose(), ea = e() * a().transpose(), eb = e() * b().transpose(),
                              ab = a() * b().transpose();
        Matrix9<Scalar> H = Matrix9<Scalar>::Zero();
        H.template block<3, 3>(0, 0) = cosine * (ab + ab.transpose()) - first * a() * a().transpose() -
                                       second * b() * b().transpose() +
                                       diagonal(first * gram(1, 1) + second * gram(2, 2) +
                                                Scalar(2) * (c(hinge_length) - cosine * gram(1, 2)));
        H.template block<3, 3>(3, 3) = diagonal(first * gram(0, 0)) - first * ee;
        H.template block<3, 3>(6, 6) = diagonal(second * gram(0, 0)) - second * ee;
        H.template block<3, 3>(0, 3) = cosine * (eb.transpose() - Scalar(2) * eb) +
                                       first * (Scalar(2) * ea - ea.transpose()) +
                                       diagonal(cosine * gram(0, 2) - first * gram(0, 1)) + c(hinge_sine) * cross_matrix(b());
        H.template block<3, 3>(0, 6) = cosine * (ea.transpose() - Scalar(2) * ea) +
                                       second * (Scalar(2) * eb - eb.transpose()) +
                                       diagonal(cosine * gram(0, 1) - second * gram(0, 2)) - c(hinge_sine) * cross_matrix(a());
        H.template block<3, 3>(3, 6) = cosine * ee - diagonal(cosine * gram(0, 0)) + c(hinge_sine) * cross_matrix(e());
        H.template block<3, 3>(3, 0) = H.template block<3, 3>(0, 3).transpose();
        H.template block<3, 3>(6, 0) = H.template block<3, 3>(0, 6).transpose();
        H.template block<3, 3>(6, 3) = H.template block<3, 3>(3, 6).transpose();
        return H;
    }

private:
    using Column = typename Matrix3<Scalar>::ConstColXpr;
    Column e() const { return edges_.col(0); }
    Column a() const { return edges_.col(1); }
    Column b() const { return edges_.col(2); }

    static Matrix3<Scalar> diagonal(Scalar value) { return value * Matrix3<Scalar>::Identity(); }

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
