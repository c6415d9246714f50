// SPDX-License-Identifier: MIT
#include <softtissue/linalg/jacobi_rotation.hpp>

#include <softtissue/core/pack.hpp>
#include <softtissue/core/random.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace softtissue;

TEST_CASE_TEMPLATE("cosine and sine of half the angle, to a few ulp of themselves, at every size", S, float, double) {
    const auto epsilon = static_cast<long double>(std::numeric_limits<S>::epsilon());
    RandomGenerator random(1);
    for (int i = 0; i < 2000; ++i) {
        const S size = std::pow(S(10), S(-15 + i % 30));
        const S difference = size * S(random.normal());
        const S twice = i % 7 == 0 ? difference * std::numeric_limits<S>::epsilon() : size * S(random.normal());
        const JacobiRotation<S> rotation(difference, twice);
        const long double angle = std::atan(static_cast<long double>(twice) / static_cast<long double>(difference)) / 2;
        CAPTURE(difference);
        CAPTURE(twice);
        CHECK(std::abs(static_cast<long double>(rotation.cosine) - std::cos(angle)) <= 2 * epsilon);
        CHECK(std::abs(static_cast<long double>(rotation.sine) - std::sin(angle)) <=
              4 * epsilon * std::abs(std::sin(angle)));
        CHECK(std::abs(static_cast<long double>(rotation.tangent) - std::tan(angle)) <=
              6 * epsilon * std::abs(std::tan(angle)));
    }
}

TEST_CASE_TEMPLATE("equal diagonal entries turn by 45 degrees", S, float, double) {
    const S root = std::sqrt(S(0.5));
    for (const S twice : {S(1), S(-3e-10)}) {
        const JacobiRotation<S> rotation(S(0), twice);
        CHECK(rotation.cosine == doctest::Approx(double(root)).epsilon(2 * double(std::numeric_limits<S>::epsilon())));
        CHECK(
            rotation.sine ==
            doctest::Approx(double(std::copysign(root, twice))).epsilon(2 * double(std::numeric_limits<S>::epsilon())));
    }
}

TEST_CASE_TEMPLATE("lanes of a pack as one by one", S, float, double) {
    constexpr int N = natural_lanes<S>;
    using Lanes = Pack<S, N>;
    RandomGenerator random(2);
    const Lanes difference = Lanes::from_lanes([&](int) { return S(random.normal()); });
    const Lanes twice = Lanes::from_lanes([&](int i) { return i == 1 ? S(0) : S(random.normal()); });
    const JacobiRotation<Lanes> rotation(difference, twice);
    const S tolerance = 8 * std::numeric_limits<S>::epsilon();
    for (int i = 0; i < N; ++i) {
        const JacobiRotation<S> single(difference[i], twice[i]);
        CHECK(std::abs(rotation.cosine[i] - single.cosine) <= tolerance);
        CHECK(std::abs(rotation.sine[i] - single.sine) <= tolerance * std::abs(single.sine));
        CHECK(std::abs(rotation.tangent[i] - single.tangent) <= tolerance * std::abs(single.tangent));
    }
}
