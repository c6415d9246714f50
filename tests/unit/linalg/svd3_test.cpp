// SPDX-License-Identifier: MIT
#include <softtissue/linalg/svd3.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>

using namespace softtissue;

namespace {

/// Every promise of the file comment; returns the decomposition.
template <class Scalar>
Svd3<Scalar> checked(const Matrix3<Scalar>& F) {
    // About fifteen plane rotations of 2 epsilon each act on V and on F V.
    constexpr Scalar tolerance = Scalar(30) * std::numeric_limits<Scalar>::epsilon();
    const Svd3<Scalar> svd = svd3(F);
    CAPTURE(F);
    const Matrix3<Scalar> I = Matrix3<Scalar>::Identity();
    CHECK((svd.U.transpose() * svd.U - I).norm() < tolerance);
    CHECK((svd.V.transpose() * svd.V - I).norm() < tolerance);
    CHECK(svd.U.determinant() > Scalar(0));
    CHECK(svd.V.determinant() > Scalar(0));
    CHECK(svd.sigma(0) >= svd.sigma(1));
    CHECK(svd.sigma(1) >= std::abs(svd.sigma(2)));
    // The subnormal step is the absolute precision where everything is tiny.
    const Matrix3<Scalar> rebuilt = svd.U * svd.sigma.asDiagonal() * svd.V.transpose();
    const Scalar scale = F.cwiseAbs().maxCoeff();
    CHECK((rebuilt - F).cwiseAbs().maxCoeff() <=
          tolerance * scale + Scalar(8) * std::numeric_limits<Scalar>::denorm_min());
    return svd;
}

template <class Scalar>
Matrix3<Scalar> with_singular_values(const Vector3<Scalar>& s, RandomGenerator& random) {
    const Matrix3<Scalar> U = random_rotation<Scalar>(random);
    return U * s.asDiagonal() * random_rotation<Scalar>(random).transpose();
}

}  // namespace

TEST_CASE_TEMPLATE("every class of state is decomposed", Scalar, float, double) {
    RandomGenerator random(1);
    for (const StateClass state_class : all_state_classes) {
        CAPTURE(name_of(state_class).data());
        for (int repeat = 0; repeat < 40; ++repeat) {
            checked(random_state<Scalar>(state_class, random));
        }
    }
}

TEST_CASE_TEMPLATE("given singular values are found, the sign of det F on the smallest", Scalar, float, double) {
    RandomGenerator random(2);
    const std::array<Vector3<Scalar>, 8> lists = {
        Vector3<Scalar>(Scalar(3), Scalar(2), Scalar(0.5)),  Vector3<Scalar>(Scalar(3), Scalar(2), Scalar(-0.5)),
        Vector3<Scalar>(Scalar(2), Scalar(2), Scalar(2)),    Vector3<Scalar>(Scalar(2), Scalar(2), Scalar(-2)),
        Vector3<Scalar>(Scalar(2), Scalar(1), Scalar(1)),    Vector3<Scalar>(Scalar(2), Scalar(1), Scalar(-1)),
        Vector3<Scalar>(Scalar(1), Scalar(1e-3), Scalar(0)), Vector3<Scalar>(Scalar(5), Scalar(0), Scalar(0))};
    for (const Vector3<Scalar>& s : lists) {
        for (int repeat = 0; repeat < 20; ++repeat) {
            const Svd3<Scalar> svd = checked(with_singular_values(s, random));
            // Rounding in building F moves singular values by a few epsilon |F|; a zero may come back with either sign.
            CHECK((svd.sigma - s).cwiseAbs().maxCoeff() < Scalar(40) * std::numeric_limits<Scalar>::epsilon() * s(0));
        }
    }
}

TEST_CASE_TEMPLATE("special matrices", Scalar, float, double) {
    const Matrix3<Scalar> I = Matrix3<Scalar>::Identity();
    const Svd3<Scalar> zero = checked<Scalar>(Matrix3<Scalar>::Zero());
    CHECK(zero.sigma == Vector3<Scalar>::Zero());
    const Svd3<Scalar> identity = checked<Scalar>(I);
    CHECK(identity.sigma == Vector3<Scalar>::Ones());
    CHECK(identity.U * identity.V.transpose() == I);
    const Svd3<Scalar> reflected = checked<Scalar>(-I);
    CHECK(reflected.sigma == Vector3<Scalar>(Scalar(1), Scalar(1), Scalar(-1)));
    checked<Scalar>(Matrix3<Scalar>::Ones());
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            Matrix3<Scalar> single = Matrix3<Scalar>::Zero();
            single(i, j) = Scalar(-2);
            CHECK(checked(single).sigma == Vector3<Scalar>(Scalar(2), Scalar(0), Scalar(0)));
        }
    }
}

TEST_CASE_TEMPLATE("the largest, the smallest and subnormal entries neither overflow nor vanish", Scalar, float,
                   double) {
    using Limits = std::numeric_limits<Scalar>;
    RandomGenerator random(3);
    for (const Scalar scale :
         {Limits::max() / Scalar(64), Limits::min(), Limits::min() * Limits::epsilon() * Scalar(64)}) {
        for (int repeat = 0; repeat < 20; ++repeat) {
            const Svd3<Scalar> svd = checked<Scalar>(scale * random_normal<Matrix3<Scalar>>(random));
            CHECK(svd.sigma(0) > Scalar(0));
            CHECK(std::isfinite(svd.sigma(0)));
        }
    }
}

TEST_CASE_TEMPLATE("small singular values of a column-scaled matrix keep their digits", Scalar, float, double) {
    // F = Q D with a rotation Q has the singular values D exactly, however far they lie apart.
    RandomGenerator random(4);
    const Vector3<Scalar> d(Scalar(1), Scalar(1e-4), Scalar(1e-8));
    for (int repeat = 0; repeat < 20; ++repeat) {
        const Svd3<Scalar> svd = checked<Scalar>(random_rotation<Scalar>(random) * d.asDiagonal());
        CHECK((svd.sigma.cwiseQuotient(d).array() - Scalar(1)).abs().maxCoeff() <
              Scalar(40) * std::numeric_limits<Scalar>::epsilon());
    }
}

TEST_CASE_TEMPLATE("a matrix that is not finite gives NaN", Scalar, float, double) {
    for (const Scalar bad : {std::numeric_limits<Scalar>::quiet_NaN(), std::numeric_limits<Scalar>::infinity()}) {
        Matrix3<Scalar> F = Matrix3<Scalar>::Identity();
        F(1, 2) = bad;
        const Svd3<Scalar> svd = svd3(F);
        CHECK(svd.sigma.array().isNaN().all());
        CHECK(svd.U.array().isNaN().all());
        CHECK(svd.V.array().isNaN().all());
    }
}
