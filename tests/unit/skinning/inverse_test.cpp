// SPDX-License-Identifier: MIT
#include <softtissue/skinning/inverse.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <numbers>

using namespace softtissue;

namespace {

/// A body of random well-conditioned transforms.
template <class S>
PosedBody<S> random_body(Index num_vertices) {
    RandomGenerator random(11);
    PosedBody<S> posed;
    posed.resize(num_vertices, 1);
    for (Index v = 0; v < num_vertices; ++v) {
        AffineTransform<S>& T = posed.transforms[size_t(v)];
        T = {random_state<S>(StateClass::general, random), random_unit<Vector3<S>>(random)};
        posed.offsets.col(v) = S(0.1) * random_unit<Vector3<S>>(random);
        posed.positions.col(v) = random_unit<Vector3<S>>(random);
    }
    return posed;
}

/// Mean of a joint at rest and one twisted by `angle`.
template <class S>
AffineTransform<S> twisted_mean(S angle) {
    const Matrix3<S> R = rotation_matrix_from_rotation_vector(Vector3<S>(angle, 0, 0));
    return {(Matrix3<S>::Identity() + R) / S(2), Vector3<S>::Zero()};
}

}  // namespace

TEST_CASE_TEMPLATE("inverse skinning undoes skinning, in place too", S, float, double) {
    const PosedBody<S> posed = random_body<S>(100);
    RandomGenerator random(12);
    Matrix3X<S> rest(3, 100), x(3, 100);
    for (Index v = 0; v < 100; ++v) {
        rest.col(v) = random_unit<Vector3<S>>(random);
        x.col(v) = posed.transforms[size_t(v)](rest.col(v) + posed.offsets.col(v));
    }
    const Matrix3X<S> u = unposed(posed, x);
    // singular values 0.5 to 1.6, |x| <= 5
    CHECK((u - rest).colwise().norm().maxCoeff() <= 100 * std::numeric_limits<S>::epsilon());
    unposed_into(posed, x, x);
    CHECK(x == u);
}

TEST_CASE("same bits for any number of threads") {
    const PosedBody<double> posed = random_body<double>(1001);
    const Matrix3X<double> u = unposed(posed, posed.positions);
    for (const int threads : {1, 2, 7}) {
        Matrix3X<double> parallel(3, 1001);
        unposed_into(posed, posed.positions, parallel, ThreadExecutor(threads));
        CHECK(parallel == u);
    }
}

TEST_CASE_TEMPLATE("smallest singular value, signed, on every kind of matrix", S, float, double) {
    RandomGenerator random(3);
    for (const StateClass kind : all_state_classes) {
        for (int i = 0; i < 20; ++i) {
            const Matrix3<S> A = random_state<S>(kind, random);
            const Eigen::JacobiSVD<Eigen::Matrix3d> svd(A.template cast<double>());
            const double expected =
                svd.singularValues()(2) * (A.template cast<double>().determinant() < 0 ? -1 : 1);
            // det and cofactors round by eps |A|^3 and eps |A|^2
            const double tolerance = 50 * double(std::numeric_limits<S>::epsilon()) * double(A.norm());
            CAPTURE(name_of(kind));
            CHECK(std::abs(double(signed_smallest_singular_value(A)) - expected) <= tolerance);
        }
    }
    CHECK(signed_smallest_singular_value<S>(Matrix3<S>::Zero()) == S(0));
    CHECK(signed_smallest_singular_value<S>(Vector3<S>(1, 0, 0).asDiagonal()) == S(0));
}

TEST_CASE_TEMPLATE("near-singular blends are found, on both sides of the threshold", S, float, double) {
    const S border = 2 * std::acos(near_singular_blend<S>);  // cos(border/2) = 0.1: 168.5 degrees
    CHECK(border == doctest::Approx(168.5 * std::numbers::pi / 180).epsilon(1e-3));
    for (const S angle : {S(0.99) * border, S(1.01) * border}) {
        std::vector<AffineTransform<S>> transforms(5);
        transforms[1] = twisted_mean(S(1));
        transforms[3] = twisted_mean(angle);
        const BlendReport<S> report = check_blends<S>(transforms);
        CHECK(report.vertex == 3);
        CHECK(std::abs(report.smallest_singular_value - std::cos(angle / 2)) <= 10 * std::numeric_limits<S>::epsilon());
        CHECK(report.near_singular == (angle > border));
        CHECK(report.num_near_singular == (angle > border ? 1 : 0));
    }
    const std::vector<AffineTransform<S>> transforms(5, twisted_mean(S(1)));
    CHECK(check_blends<S>(transforms, S(0.9)).num_near_singular == 5);
    CHECK_FALSE(check_blends<S>(transforms, S(0.8)).near_singular);
}

TEST_CASE_TEMPLATE("rigid transforms have smallest singular value one; a mirroring blend is negative", S, float, double) {
    RandomGenerator random(5);
    std::vector<AffineTransform<S>> transforms(4);
    for (AffineTransform<S>& T : transforms) {
        T.linear = random_rotation<S>(random);
    }
    CHECK(check_blends<S>(transforms).smallest_singular_value == doctest::Approx(1).epsilon(1e-6));
    // the mean of half turns about x, y and z is -I/3
    transforms[2].linear = -Matrix3<S>::Identity() / S(3);
    transforms[3].linear = Vector3<S>(1, 1, S(0.01)).asDiagonal();
    const BlendReport<S> report = check_blends<S>(transforms);
    CHECK(report.vertex == 2);
    CHECK(report.smallest_singular_value == doctest::Approx(-1.0 / 3).epsilon(1e-6));
    CHECK(report.num_near_singular == 2);
}

TEST_CASE_TEMPLATE("a transform that is not finite is the worst", S, float, double) {
    std::vector<AffineTransform<S>> transforms(4);
    transforms[1].linear(0, 2) = std::numeric_limits<S>::quiet_NaN();
    transforms[2].linear.setZero();
    transforms[3].linear = -Matrix3<S>::Identity();
    const BlendReport<S> report = check_blends<S>(transforms);
    CHECK(report.vertex == 1);
    CHECK(report.near_singular);
    CHECK(report.num_near_singular == 3);
    CHECK_FALSE(std::isfinite(report.smallest_singular_value));
}

TEST_CASE("throws only on request, naming the vertex") {
    PosedBody<double> posed = random_body<double>(3);
    CHECK_NOTHROW(require_invertible_blends(posed));
    posed.transforms[1].linear = Eigen::Vector3d(1, 1, 0.0625).asDiagonal();
    CHECK_THROWS_WITH_AS(require_invertible_blends(posed),
                         "inverse skinning: blended transform of vertex 1 has smallest singular value 0.0625, "
                         "expected >= 0.1 (1 such vertices)",
                         InvalidInput);
    CHECK_NOTHROW(require_invertible_blends(posed, 0.05));
    CHECK_NOTHROW(unposed(posed, posed.positions));
    CHECK_THROWS_WITH_AS(unposed(posed, Matrix3X<double>::Zero(3, 2)),
                         "inverse skinning: 2 positions into 2, expected 3", InvalidInput);
    CHECK_THROWS_WITH_AS(check_blends<double>({}), "check_blends: no transforms, expected one per vertex",
                         InvalidInput);
}
