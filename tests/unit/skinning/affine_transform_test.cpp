// SPDX-License-Identifier: MIT
#include <softtissue/skinning/affine_transform.hpp>

#include <softtissue/core/dual.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

TEST_CASE_TEMPLATE("default is the identity; application and composition", S, float, double) {
    const AffineTransform<S> identity;
    const Vector3<S> x(1, 2, 3);
    CHECK(identity(x) == x);
    AffineTransform<S> outer, inner;
    outer.linear << 0, -1, 0, 1, 0, 0, 0, 0, 2;
    outer.translation << 1, 0, 0;
    inner.linear = S(3) * Matrix3<S>::Identity();
    inner.translation << 0, 0, 1;
    CHECK(inner(x) == Vector3<S>(3, 6, 10));
    CHECK(outer(inner(x)) == Vector3<S>(-5, 3, 20));
    CHECK((outer * inner)(x) == Vector3<S>(-5, 3, 20));
}

TEST_CASE_TEMPLATE("the inverse takes points back, also through a mirror", S, float, double) {
    RandomGenerator random(1);
    for (int i = 0; i < 100; ++i) {
        const StateClass kind = i % 2 == 0 ? StateClass::general : StateClass::inverted;
        const AffineTransform<S> T{random_state<S>(kind, random), random_normal<Vector3<S>>(random)};
        const Vector3<S> x = random_normal<Vector3<S>>(random);
        // singular values from 0.1 to 1.6: condition below 16, |T x| below 10
        CHECK((T.inverse()(T(x)) - x).norm() <= S(1000) * std::numeric_limits<S>::epsilon());
    }
}

TEST_CASE_TEMPLATE("every entry counts for being finite", S, float, double) {
    for (int k = 0; k < 12; ++k) {
        for (const S bad : {std::numeric_limits<S>::quiet_NaN(), -std::numeric_limits<S>::infinity()}) {
            AffineTransform<S> T;
            CHECK(T.is_finite());
            (k < 9 ? T.linear.data()[k] : T.translation(k - 9)) = bad;
            CHECK_FALSE(T.is_finite());
        }
    }
    CHECK(AffineTransform<S>{Matrix3<S>::Constant(std::numeric_limits<S>::max()), Vector3<S>::Zero()}.is_finite());
}
