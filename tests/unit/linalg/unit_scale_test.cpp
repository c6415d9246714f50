// SPDX-License-Identifier: MIT
#include <softtissue/linalg/unit_scale.hpp>

#include <softtissue/core/pack.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace softtissue;

TEST_CASE_TEMPLATE("numbers of any size come to at most 1 and back", S, float, double,
                   Pack<float, natural_lanes<float>>, Pack<double, natural_lanes<double>>) {
    using T = RealOf<S>;
    using Limits = std::numeric_limits<T>;
    const T tolerance = T(4) * Limits::epsilon();
    for (const T size : {T(1), T(3), T(1e-20), T(1e20), Limits::min(), Limits::max(), T(16) * Limits::min()}) {
        CAPTURE(size);
        const UnitScale<S> scale{S(size)};
        const bool is_small = size < T(16) * Limits::min();
        for (const T part : {T(1), T(-0.7), T(0), T(1) / T(3)}) {
            const T x = size * part;
            const T y = lane(scale.unit(S(x)), 0);
            CHECK(std::abs(y) <= T(1) + tolerance);
            CHECK(std::abs(y - (is_small ? part / T(16) : part)) <= tolerance);
            CHECK(std::abs(lane(scale.original(S(y)), 0) / T(4) - x / T(4)) <= tolerance * size + Limits::denorm_min());
        }
    }
}

TEST_CASE_TEMPLATE("subnormal numbers keep their digits", S, float, double) {
    using Limits = std::numeric_limits<S>;
    const S size = S(37) * Limits::denorm_min();
    const UnitScale<S> scale(size);
    CHECK(scale.original(scale.unit(S(21) * Limits::denorm_min())) == S(21) * Limits::denorm_min());
    CHECK(scale.original(scale.unit(size)) == size);
    CHECK(UnitScale<S>(S(0)).unit(S(0)) == S(0));
}
