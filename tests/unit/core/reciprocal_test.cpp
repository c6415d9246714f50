// SPDX-License-Identifier: MIT
#include <softtissue/core/reciprocal.hpp>

#include <softtissue/core/random.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace softtissue;

namespace {

/// The same, both NaN, or `ulps` apart at most.
template <class T>
bool is_near(T a, T b, T ulps) {
    return a == b || (a != a && b != b) ||
           std::abs(a - b) <= ulps * std::numeric_limits<T>::epsilon() / 2 * std::abs(b);
}

template <class P, class F>
void for_each_pack(const std::vector<RealOf<P>>& numbers, const F& check) {
    for (size_t first = 0; first < numbers.size(); ++first) {
        const auto number = [&](int i) { return numbers[(first + size_t(i)) % numbers.size()]; };
        check(P::from_lanes(number), number);
    }
}

}  // namespace

TEST_CASE_TEMPLATE("reciprocals and roots are those of division, to the last digit or two", P,
                   Pack<float, natural_lanes<float>>, Pack<double, natural_lanes<double>>, Pack<float, 64>,
                   Pack<double, 3>) {
    using T = RealOf<P>;
    RandomGenerator random(1);
    std::vector<T> numbers;
    for (int k = 0; k < 4000; ++k) {
        numbers.push_back(std::ldexp(T(1) + T(random.uniform()), k % 200 - 100) * (k % 3 == 0 ? T(-1) : T(1)));
    }
    for_each_pack<P>(numbers, [](const P& x, const auto& number) {
        const P inverse = reciprocal(x), inverse_root = reciprocal_sqrt(abs(x)), root = quick_sqrt(abs(x));
        for (int i = 0; i < num_lanes<P>; ++i) {
            const T a = number(i), length = std::abs(a);
            REQUIRE(is_near(inverse[i], reciprocal(a), T(2)));
            REQUIRE(is_near(inverse_root[i], reciprocal_sqrt(length), T(3)));
            REQUIRE(is_near(root[i], quick_sqrt(length), T(4)));
        }
    });
}

TEST_CASE_TEMPLATE("zero, subnormal numbers, infinity and NaN are as by division", P, Pack<float, natural_lanes<float>>,
                   Pack<double, natural_lanes<double>>) {
    using T = RealOf<P>;
    using Limits = std::numeric_limits<T>;
    const std::vector<T> numbers = {T(0),
                                    T(-0.0),
                                    Limits::denorm_min(),
                                    Limits::min() / 2,
                                    Limits::min(),
                                    Limits::infinity(),
                                    Limits::quiet_NaN(),
                                    Limits::max(),
                                    T(1),
                                    T(4)};
    for_each_pack<P>(numbers, [](const P& x, const auto& number) {
        const P inverse = reciprocal(x), inverse_root = reciprocal_sqrt(x), root = quick_sqrt(x);
        for (int i = 0; i < num_lanes<P>; ++i) {
            const T a = number(i);
            CAPTURE(a);
            const bool is_tiny = std::abs(T(1) / a) < Limits::min();  // where a processor may give zero
            CHECK((is_near(inverse[i], T(1) / a, T(2)) || (is_tiny && inverse[i] == T(0))));
            CHECK(is_near(inverse_root[i], T(1) / std::sqrt(a), T(3)));
            CHECK(is_near(root[i], std::sqrt(a), T(4)));
        }
    });
}
