// SPDX-License-Identifier: MIT
/// @file
/// The plane rotation of Jacobi's methods.
///
/// What        cosine c and sine s of the angle t in [-pi/4, pi/4] with tan 2t = twice / difference
/// Equation    cos 2t = |difference| / r, sin 2t = +-twice / r, r^2 = difference^2 + twice^2;
///             c^2 = (1 + cos 2t) / 2, s = sin 2t / (2 c)
/// Shapes      float and double; lane by lane for packs
/// Valid       r^2 a normal number
/// Accuracy    c and s to a few epsilon of themselves; c^2 + s^2 = 1 likewise
/// Source      Golub & Van Loan 2013, sec. 8.5; here with two reciprocal roots in place of two roots and two quotients,
///             each of which would wait for the one before
/// Tests       tests/unit/linalg/jacobi_rotation_test.cpp
#pragma once

#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/reciprocal.hpp>
#include <softtissue/core/scalar.hpp>

#include <cmath>

namespace softtissue {

template <RealLanes Scalar>
struct JacobiRotation {
    Scalar cosine, sine, tangent;

    JacobiRotation(const Scalar& difference, const Scalar& twice) {
        using std::abs;
        using Real = RealOf<Scalar>;
        const Scalar inverse = reciprocal_sqrt(Scalar(difference * difference + twice * twice));
        const Scalar squared = Real(0.5) + Real(0.5) * (abs(difference) * inverse);
        const Scalar inverse_cosine = reciprocal_sqrt(squared);
        const Scalar half_sine = (Real(0.5) * select(difference < Scalar(0), Scalar(-twice), twice)) * inverse;
        cosine = squared * inverse_cosine;
        sine = half_sine * inverse_cosine;
        tangent = sine * inverse_cosine;
    }
};

}  // namespace softtissue
