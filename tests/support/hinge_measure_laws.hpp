// SPDX-License-Identifier: MIT
// The derivatives of hinge measures, through the shape of the hinge: its invariants are not independent.
#pragma once

#include <softtissue/energy/hinge_invariants.hpp>
#include <softtissue/testing/random_states.hpp>
#include <softtissue/testing/taylor_rate.hpp>

#include <doctest/doctest.h>

namespace softtissue_test {

using namespace softtissue;

template <class Measure, class S = typename Measure::Scalar>
Vector9<S> gradient_by_edges(const Measure& measure, const Matrix3<S>& edges) {
    const HingeInvariants<S> hinge(edges);
    return hinge.jacobian().transpose() * measure.gradient(hinge);
}

template <class Measure, class S = typename Measure::Scalar>
Matrix9<S> hessian_by_edges(const Measure& measure, const Matrix3<S>& edges) {
    const HingeInvariants<S> hinge(edges);
    const Eigen::Matrix<S, 5, 9> J = hinge.jacobian();
    return hinge.contracted_hessian(measure.gradient(hinge)) + J.transpose() * measure.hessian(hinge) * J;
}

/// Both derivatives along D; |D| = 1 should be a large change of the shape.
template <class Measure, class S = typename Measure::Scalar>
void check_hinge_derivatives(const Measure& measure, const Matrix3<S>& edges, const Matrix3<S>& D) {
    const auto energy = [&](S h) { return measure.energy(HingeInvariants<S>(edges + h * D)); };
    const S slope = gradient_by_edges(measure, edges).dot(vec<S>(D));
    const TaylorRate of_energy = taylor_rate(energy, slope);
    CAPTURE(of_energy.order);
    CHECK(of_energy.is_at_least(2));
    const auto gradient = [&](S h) -> Vector9<S> { return gradient_by_edges<Measure, S>(measure, edges + h * D); };
    const Vector9<S> change = hessian_by_edges(measure, edges) * vec<S>(D);
    const TaylorRate of_gradient = taylor_rate(gradient, change);
    CAPTURE(of_gradient.order);
    CHECK(of_gradient.is_at_least(2));
}

/// A hinge over an edge of length 1 with the given heights, its second triangle bent down by `angle`.
template <class S>
Matrix3<S> hinge_edges(double angle, double height = 0.8, double second_height = 0.7) {
    Matrix3<S> edges;
    edges << S(1), S(0.4), S(0.55),                                      //
        S(0), S(height), S(-second_height * std::cos(angle)),            //
        S(0), S(0), S(-second_height * std::sin(angle));
    return edges;
}

}  // namespace softtissue_test
