// SPDX-License-Identifier: MIT
#include <softtissue/energy/angle_curvature.hpp>

#include <softtissue/core/pack.hpp>
#include <softtissue/energy/hinge_invariants.hpp>
#include <softtissue/testing/random_states.hpp>

#include <support/hinge_measure_laws.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>

using namespace softtissue;
using namespace softtissue_test;

namespace {

template <class S>
using Roots = Eigen::Matrix<S, 9, 4>;

/// d2theta by central differences of the angle's gradient, which the measure's invariants give.
Matrix9<double> angle_hessian(const Matrix3<double>& edges) {
    const auto gradient = [](const Matrix3<double>& at) -> Vector9<double> {
        const HingeInvariants<double> hinge(at);
        const double L = std::sqrt(hinge.values()(hinge_length)), X = hinge.values()(hinge_cosine);
        const double D = hinge.values()(hinge_sine), squared = X * X + L * L * D * D;
        HingeInvariants<double>::Values by_invariants = HingeInvariants<double>::Values::Zero();
        by_invariants(hinge_cosine) = -L * D / squared;
        by_invariants(hinge_sine) = X * L / squared;
        by_invariants(hinge_length) = X * D / (2 * L * squared);
        return hinge.jacobian().transpose() * by_invariants;
    };
    Matrix9<double> H;
    const double h = 1e-5;
    for (int k = 0; k < 9; ++k) {
        Matrix3<double> step = Matrix3<double>::Zero();
        step(k % 3, k / 3) = h;
        H.col(k) = (gradient(edges + step) - gradient(edges - step)) / (2 * h);
    }
    return H;
}

template <class S>
Matrix9<S> square(const Roots<S>& R) {
    return R * R.transpose();
}

/// Hinges of all shapes, in any place: flat, folded, obtuse triangles, slivers.
std::array<Matrix3<double>, 8> hinges() {
    RandomGenerator random(4);
    std::array<Matrix3<double>, 8> result{hinge_edges<double>(0.0),       hinge_edges<double>(0.4),
                                          hinge_edges<double>(-2.0, 0.3), hinge_edges<double>(3.1, 0.8, 2.0),
                                          hinge_edges<double>(1.0, 0.05), hinge_edges<double>(-0.5, 4.0, 0.1)};
    result[6] = random_normal<Matrix3<double>>(random);
    result[7] = hinge_edges<double>(0.7);
    result[7](0, 1) = 3;  // both triangles hang over an end of the hinge
    result[7](0, 2) = -2;
    for (Matrix3<double>& edges : result) {
        edges = (random_rotation<double>(random) * edges).eval();
    }
    return result;
}

}  // namespace

TEST_CASE("the parts of both signs differ by the angle's second derivative") {
    for (const Matrix3<double>& edges : hinges()) {
        for (const double moment : {1.0, 0.3}) {
            const Matrix9<double> plus = square(angle_curvature_roots<double>(edges, moment));
            const Matrix9<double> minus = square(angle_curvature_roots<double>(edges, -moment));
            const Matrix9<double> H = moment * angle_hessian(edges);
            CHECK((plus - minus - H).norm() < 1e-7 * H.norm());
            CHECK(plus.norm() < 2 * H.norm());
        }
    }
}

TEST_CASE("each triangle's parts are orthogonal over its vertices: the spectral ones") {
    for (const Matrix3<double>& edges : hinges()) {
        const Roots<double> plus = angle_curvature_roots<double>(edges, 1.0);
        const Roots<double> minus = angle_curvature_roots<double>(edges, -1.0);
        for (const int first : {0, 2}) {
            const auto at_vertices = [&](const Roots<double>& R) {
                const Eigen::Matrix<double, 9, 2> columns = R.middleCols<2>(first);
                Eigen::Matrix<double, 12, 2> all;
                all << -(columns.topRows<3>() + columns.middleRows<3>(3) + columns.bottomRows<3>()), columns;
                return all;
            };
            const Eigen::Matrix<double, 12, 2> p = at_vertices(plus), m = at_vertices(minus);
            CHECK((p.transpose() * m).norm() < 1e-12 * p.norm() * m.norm());
            const int other = first == 0 ? 6 : 3;  // the other triangle's third vertex
            CHECK(plus.block<3, 2>(other, first).norm() == 0.0);
        }
    }
}

TEST_CASE_TEMPLATE("lanes of a pack are hinges of their own; no moment, no curvature, whatever the shape", S, float,
                   double) {
    constexpr int width = natural_lanes<S>;
    using Lanes = Pack<S, width>;
    const std::array<Matrix3<double>, 8> all = hinges();
    const auto edges_of = [&](int i) -> Matrix3<S> {
        return i % 5 == 4 ? Matrix3<S>(Matrix3<S>::Zero()) : Matrix3<S>(all[size_t(i % 4)].template cast<S>());
    };
    const auto moment_of = [](int i) { return i % 5 == 4 ? S(0) : S(i % 3 - 1) * S(0.7) + S(0.1); };
    const Roots<Lanes> packed =
        angle_curvature_roots<Lanes>(packed_matrix<width>(edges_of), Lanes::from_lanes(moment_of));
    for (int i = 0; i < width; ++i) {
        const Roots<S> single = angle_curvature_roots<S>(edges_of(i), moment_of(i));
        CHECK((lane(packed, i) - single).norm() <= 64 * std::numeric_limits<S>::epsilon() * single.norm());
    }
    Matrix3<S> collapsed = hinge_edges<S>(0.3, 0.0);
    for (const Matrix3<S>& edges : {collapsed, Matrix3<S>(Matrix3<S>::Zero()), hinge_edges<S>(0.5)}) {
        CHECK(angle_curvature_roots<S>(edges, S(0)).norm() == S(0));
    }
    // edges of a micrometre
    const Roots<S> unit = angle_curvature_roots<S>(edges_of(1), S(1));
    const Roots<S> small = angle_curvature_roots<S>(Matrix3<S>(S(0x1p-20) * edges_of(1)), S(1));
    CHECK((S(0x1p-20) * small - unit).norm() <= 16 * std::numeric_limits<S>::epsilon() * unit.norm());
}
