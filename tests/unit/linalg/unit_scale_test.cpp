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
        for (const T part : {T(1), T(-0.7), T(0), T(1) / T(3)}) {
            const T x = size * part;
            const T y = lane(scale.unit(S(x)), 0);
            CHECK(std::abs(y) <= T(1) + tolerance);
            CHECK(std::abs(y - part) <= tolerance);
            CHECK(std::abs(lane(scale.original(S(y)), 0) / T(4) - x / T(4)) <= tolerance * size + Limits::denorm_min());
        }
    }
}

TEST_CASE_TEMPLATE("subnormal numbers come to 1 as well and keep their digits", S, float, double,
                   Pack<float, natural_lanes<float>>, Pack<double, natural_lanes<double>>) {
    using T = RealOf<S>;
    constexpr T unit = std::numeric_limits<T>::denorm_min();
    for (const int size : {1, 2, 37, 1000}) {
        CAPTURE(size);
        const UnitScale<S> scale{S(T(size) * unit)};
        for (const int part : {0, 1, -size / 2, size}) {
            const S y = scale.unit(S(T(part) * unit));
            CHECK(std::abs(lane(y, 0) - T(part) / T(size)) <= T(4) * std::numeric_limits<T>::epsilon());
            CHECK(lane(scale.original(y), 0) == T(part) * unit);
        }
    }
    CHECK(lane(UnitScale<S>(S(0)).unit(S(0)), 0) == T(0));
}
