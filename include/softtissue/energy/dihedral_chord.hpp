// SPDX-License-Identifier: MIT
/// @file
/// Smooth hinge measure: the squared chord between current and rest angle on the unit circle.
///
/// What        agrees with DihedralDifference to second order around rest, has no jump at pi, and keeps energy, gradient and
///             Hessian bounded where a triangle turns over or collapses.
/// Equation    f = w/2 |v - V|^2,  v = (n1.n2, (n1 x n2).t),  V its value at rest;  v = (cos theta, sin theta), hence
///             f = w (1 - cos(theta - Theta)), wherever n1, n2, t are unit vectors.
///             n1, n2, t are N1, N2, e divided by their length; below a quarter of its rest value the inverse of the length is
///             continued by its quadratic Taylor polynomial in the squared length. The length of such a vector then is
///             y (15 - 10 y^2 + 3 y^4)/8, y = 4 x current / rest: the smooth step from 0 to 1. An energy with a triangle
///             turned over grows monotonically through the state without area.
///             w = 6 / (r_1 + r_2) prod_i min(1, 10 h_i)^2,  r_i = max(h_i, 1/10), h_i = height_i / L at rest: L^2/A of the
///             literature where both triangles are at least a tenth as high as the edge is long. For slivers the weight is
///             lowered, such that w and the stiffness against lifting a vertex off the hinge, w/height^2, stay bounded: by 30
///             and by 3000/L^2.
/// Valid       every shape; C2 everywhere. Slivers and triangles without area at rest included (weight 0 in the limit).
/// Limits      periodic and smooth implies a maximum: the restoring moment grows up to 90 degrees from rest, then falls.
/// Source      after Nolte et al. 2026, eq. (5)
/// Departs     chord instead of angle, as above
/// Tests       tests/unit/energy/dihedral_chord_test.cpp
#pragma once

#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/hinge_invariants.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace softtissue {

namespace detail {

/// q^(-1/2) for q >= threshold, below its quadratic Taylor polynomial there; with two derivatives.
template <RealLanes Scalar>
struct BoundedInverseRoot {
    Scalar value, first, second;

    BoundedInverseRoot(Scalar q, Scalar threshold) {
        using std::max;
        using std::sqrt;
        const Scalar base = max(q, threshold);
        const Scalar root = Scalar(1) / sqrt(base);
        const Scalar t = (q - base) / base;
        value = root * (Scalar(1) + t * (Scalar(-0.5) + Scalar(0.375) * t));
        first = root / base * (Scalar(-0.5) + Scalar(0.75) * t);
        second = Scalar(0.75) * root / (base * base);
    }
};

}  // namespace detail

template <RealLanes S>
class DihedralChord {
public:
    using Scalar = S;
    using Invariants = HingeInvariants<Scalar>;
    using Values = typename Invariants::Values;
    using SquareMatrix = typename Invariants::SquareMatrix;
    template <RealLanes T>
    using Over = DihedralChord<T>;

    /// The measure whose rest shape is `rest`.
    explicit DihedralChord(const Invariants& rest) {
        using std::max;
        using std::min;
        using std::sqrt;
        const Scalar squared_length = rest.values()(hinge_length);
        const auto threshold_of = [](const Scalar& squared, const Scalar& unit) -> Scalar {
            // a rest triangle without area has a weight of zero; the floor keeps its derivatives finite
            return max(Scalar(squared / Scalar(16)), Scalar(std::numeric_limits<RealOf<Scalar>>::epsilon() * unit));
        };
        length_threshold_ = threshold_of(squared_length, squared_length);
        weight_ = Scalar(6);
        Scalar heights(0);
        for (int i = 0; i < 2; ++i) {
            const Scalar squared_area = rest.values()(hinge_first_area + i);
            area_thresholds_[size_t(i)] = threshold_of(squared_area, squared_length * squared_length);
            const Scalar height = sqrt(squared_area) / squared_length;
            heights += max(height, Scalar(sliver_height));
            const Scalar lowering = min(Scalar(1), Scalar(height / sliver_height));
            weight_ *= lowering * lowering;
        }
        weight_ /= heights;
        const UnitCircle at_rest(*this, rest.values());
        rest_[0] = at_rest.cosine();
        rest_[1] = at_rest.sine();
    }

    Scalar weight() const { return weight_; }

    Scalar energy(const Invariants& hinge) const {
        const UnitCircle v(*this, hinge.values());
        const Scalar x = v.cosine() - rest_[0];
        const Scalar y = v.sine() - rest_[1];
        return Scalar(0.5) * weight_ * (x * x + y * y);
    }

    /// By the invariants.
    Values gradient(const Invariants& hinge) const {
        const UnitCircle v(*this, hinge.values());
        return weight_ * ((v.cosine() - rest_[0]) * v.cosine_gradient() + (v.sine() - rest_[1]) * v.sine_gradient());
    }

    SquareMatrix hessian(const Invariants& hinge) const {
        const UnitCircle v(*this, hinge.values());
        const Values x = v.cosine_gradient();
        const Values y = v.sine_gradient();
        return weight_ * (x * x.transpose() + y * y.transpose() + (v.cosine() - rest_[0]) * v.cosine_hessian() +
                          (v.sine() - rest_[1]) * v.sine_hessian());
    }

    /// See HasConvexPart. Where v is a unit vector the energy depends on the angle alone, with second derivative w v.V.
    HingeConvexPart<Scalar, 2> convex_part(const Invariants& hinge) const {
        using std::max;
        using std::sqrt;
        const Values& p = hinge.values();
        const UnitCircle v(*this, p);
        const auto is_regular = (p(hinge_first_area) >= area_thresholds_[0]) &
                                (p(hinge_second_area) >= area_thresholds_[1]) & (p(hinge_length) >= length_threshold_);
        const Scalar x = v.cosine(), y = v.sine();
        const Scalar second = select(is_regular, max(Scalar(x * rest_[0] + y * rest_[1]), Scalar(0)), Scalar(1));
        const Scalar root = sqrt(weight_ * second);
        HingeConvexPart<Scalar, 2> part;
        part.roots.col(0) = root * v.cosine_gradient();
        part.roots.col(1) = root * v.sine_gradient();
        part.moment = select(is_regular, weight_ * (y * rest_[0] - x * rest_[1]), Scalar(0));
        return part;
    }

private:
    static constexpr RealOf<Scalar> sliver_height = RealOf<Scalar>(0.1);

    /// cosine = r1 r2 P, sine = r1 r2 q r(q) D with P, D, q1, q2, q the invariants and r the bounded inverse root.
    struct UnitCircle {
        const Values& p;
        detail::BoundedInverseRoot<Scalar> first, second, root;

        UnitCircle(const DihedralChord& chord, const Values& invariants)
            : p(invariants),
              first(p(hinge_first_area), chord.area_thresholds_[0]),
              second(p(hinge_second_area), chord.area_thresholds_[1]),
              root(p(hinge_length), chord.length_threshold_) {}

        Scalar cosine() const { return first.value * second.value * p(hinge_cosine); }
        Scalar sine() const { return first.value * second.value * length() * p(hinge_sine); }

        Values cosine_gradient() const {
            Values numerator = Values::Zero();
            numerator(hinge_cosine) = Scalar(1);
            return product_gradient(p(hinge_cosine), numerator);
        }

        Values sine_gradient() const { return product_gradient(length() * p(hinge_sine), sine_numerator_gradient()); }

        SquareMatrix cosine_hessian() const {
            Values numerator = Values::Zero();
            numerator(hinge_cosine) = Scalar(1);
            return product_hessian(p(hinge_cosine), numerator);
        }

        SquareMatrix sine_hessian() const {
            SquareMatrix H = product_hessian(length() * p(hinge_sine), sine_numerator_gradient());
            const Scalar factor = first.value * second.value;
            H(hinge_length, hinge_length) += factor * length_second() * p(hinge_sine);
            H(hinge_length, hinge_sine) += factor * length_first();
            H(hinge_sine, hinge_length) += factor * length_first();
            return H;
        }

        /// q r(q) = |e| above the threshold.
        Scalar length() const { return p(hinge_length) * root.value; }
        Scalar length_first() const { return root.value + p(hinge_length) * root.first; }
        Scalar length_second() const { return Scalar(2) * root.first + p(hinge_length) * root.second; }

        Values sine_numerator_gradient() const {
            Values numerator = Values::Zero();
            numerator(hinge_sine) = length();
            numerator(hinge_length) = length_first() * p(hinge_sine);
            return numerator;
        }

        /// Of r1 r2 z.
        Values product_gradient(Scalar z, const Values& dz) const {
            Values g = first.value * second.value * dz;
            g(hinge_first_area) += first.first * second.value * z;
            g(hinge_second_area) += first.value * second.first * z;
            return g;
        }

        /// Of r1 r2 z, without the second derivatives of z.
        SquareMatrix product_hessian(Scalar z, const Values& dz) const {
            Values factor = Values::Zero();
            factor(hinge_first_area) = first.first * second.value;
            factor(hinge_second_area) = first.value * second.first;
            SquareMatrix H = factor * dz.transpose() + dz * factor.transpose();
            H(hinge_first_area, hinge_first_area) += first.second * second.value * z;
            H(hinge_second_area, hinge_second_area) += first.value * second.second * z;
            H(hinge_first_area, hinge_second_area) += first.first * second.first * z;
            H(hinge_second_area, hinge_first_area) += first.first * second.first * z;
            return H;
        }
    };

    Scalar weight_;
    Scalar length_threshold_;
    std::array<Scalar, 2> area_thresholds_;
    std::array<Scalar, 2> rest_;
};

}  // namespace softtissue
