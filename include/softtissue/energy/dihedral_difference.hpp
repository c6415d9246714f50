// SPDX-License-Identifier: MIT
/// @file
/// Hinge measure of the literature: the squared difference of the dihedral angles.
///
/// Equation    f = 1/2 (L^2/A) (theta - Theta)^2,  A = (A_1 + A_2)/3, capital letters at rest
/// Valid       triangles with area and |theta| < pi. The angle is not wrapped: where the hinge passes pi, the energy jumps; where
///             a triangle loses its area, the gradient grows without bound. DihedralChord has neither fault.
/// Refuses     rest triangles without area
/// Source      Nolte et al. 2026, eq. (5); Grinspun et al. 2003
/// Tests       tests/unit/energy/dihedral_difference_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/hinge_invariants.hpp>

#include <cmath>

namespace softtissue {

template <RealLanes S>
class DihedralDifference {
public:
    using Scalar = S;
    using Invariants = HingeInvariants<Scalar>;
    using Values = typename Invariants::Values;
    using SquareMatrix = typename Invariants::SquareMatrix;
    template <RealLanes T>
    using Over = DihedralDifference<T>;

    /// The measure whose rest shape is `rest`.
    explicit DihedralDifference(const Invariants& rest) : rest_angle_(rest.angle()) {
        using std::sqrt;
        const Scalar first = sqrt(rest.values()(hinge_first_area));
        const Scalar second = sqrt(rest.values()(hinge_second_area));
        require(all_of(first > Scalar(0)) && all_of(second > Scalar(0)), "a rest triangle has no area");
        weight_ = Scalar(6) * rest.values()(hinge_length) / (first + second);
    }

    Scalar weight() const { return weight_; }
    Scalar rest_angle() const { return rest_angle_; }

    Scalar energy(const Invariants& hinge) const {
        const Scalar difference = hinge.angle() - rest_angle_;
        return Scalar(0.5) * weight_ * difference * difference;
    }

    /// By the invariants.
    Values gradient(const Invariants& hinge) const {
        return weight_ * (hinge.angle() - rest_angle_) * AngleDerivatives(hinge).first;
    }

    SquareMatrix hessian(const Invariants& hinge) const {
        const AngleDerivatives angle(hinge);
        return weight_ * (angle.first * angle.first.transpose() + (hinge.angle() - rest_angle_) * angle.second);
    }

    /// See HasConvexPart.
    HingeConvexPart<Scalar, 1> convex_part(const Invariants& hinge) const {
        using std::sqrt;
        return {sqrt(weight_) * AngleDerivatives(hinge).first, weight_ * (hinge.angle() - rest_angle_)};
    }

private:
    /// theta = atan2(Y, X) with X = values[0] and Y = sqrt(q) D.
    struct AngleDerivatives {
        Values first = Values::Zero();
        SquareMatrix second = SquareMatrix::Zero();

        explicit AngleDerivatives(const Invariants& hinge) {
            const Values& p = hinge.values();
            using std::sqrt;
            const Scalar root = sqrt(p(hinge_length));
            const Scalar X = p(hinge_cosine);
            const Scalar Y = root * p(hinge_sine);
            const Scalar squared_radius = X * X + Y * Y;
            const Scalar by_X = -Y / squared_radius;
            const Scalar by_Y = X / squared_radius;
            Values dY = Values::Zero();
            dY(hinge_sine) = root;
            dY(hinge_length) = Scalar(0.5) * p(hinge_sine) / root;
            first = by_Y * dY;
            first(hinge_cosine) = by_X;

            SquareMatrix ddY = SquareMatrix::Zero();
            ddY(hinge_sine, hinge_length) = ddY(hinge_length, hinge_sine) = Scalar(0.5) / root;
            ddY(hinge_length, hinge_length) = Scalar(-0.25) * p(hinge_sine) / (root * p(hinge_length));
            Values dX = Values::Zero();
            dX(hinge_cosine) = Scalar(1);
            const Scalar by_XX = Scalar(-2) * by_X * by_Y;
            const Scalar by_XY = by_X * by_X - by_Y * by_Y;
            second = by_Y * ddY + by_XX * (dX * dX.transpose() - dY * dY.transpose()) +
                     by_XY * (dX * dY.transpose() + dY * dX.transpose());
        }
    };

    Scalar rest_angle_;
    Scalar weight_;
};

}  // namespace softtissue
