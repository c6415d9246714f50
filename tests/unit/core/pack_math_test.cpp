// SPDX-License-Identifier: MIT
#include <softtissue/core/pack_math.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace softtissue;

namespace {

template <class T>
bool is_same(T a, T b) {
    return a == b ? std::signbit(a) == std::signbit(b) : a != a && b != b;
}

/// The same, or two neighbours among numbers.
template <class T>
bool is_near(T a, T b) {
    return is_same(a, b) || std::abs(a - b) <= 2 * std::numeric_limits<T>::epsilon() * std::abs(b);
}

template <class T>
std::vector<T> hard_numbers() {
    using Limits = std::numeric_limits<T>;
    return {T(0),
            T(-0.0),
            T(1),
            T(-1),
            T(2.25),
            T(-1e-3),
            Limits::min(),
            -Limits::max(),
            Limits::max(),
            Limits::denorm_min(),
            T(1) / T(3),
            T(40),
            T(-40),
            Limits::infinity(),
            -Limits::infinity(),
            Limits::quiet_NaN()};
}

}  // namespace

TEST_CASE_TEMPLATE("functions give what std gives, all but the exponentials bit for bit", P,
                   Pack<float, natural_lanes<float>>, Pack<double, natural_lanes<double>>, Pack<float, 64>,
                   Pack<double, 3>) {
    using T = RealOf<P>;
    const std::vector<T> list = hard_numbers<T>();
    const size_t count = list.size();
    for (size_t first = 0; first < count; ++first) {
        for (size_t second = 0; second < count; ++second) {
            const auto a = [&](int i) { return list[(first + size_t(i)) % count]; };
            const auto b = [&](int i) { return list[(second + 3 * size_t(i)) % count]; };
            const P x = P::from_lanes(a), y = P::from_lanes(b);
            const P absolute = abs(x), signed_x = copysign(x, y), least = min(x, y), most = max(x, y), root = sqrt(x);
            const P power = exp(x), power_less_1 = expm1(x);
            bool all_same = true;
            for (int i = 0; i < num_lanes<P>; ++i) {
                all_same = all_same && is_same(absolute[i], std::abs(a(i))) &&
                           is_same(signed_x[i], std::copysign(a(i), b(i))) && is_same(least[i], std::min(a(i), b(i))) &&
                           is_same(most[i], std::max(a(i), b(i))) && is_same(root[i], std::sqrt(a(i))) &&
                           is_near(power[i], std::exp(a(i))) && is_near(power_less_1[i], std::expm1(a(i)));
            }
            CHECK(all_same);
        }
    }
}
