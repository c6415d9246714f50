#include <softtissue/core/scalar.hpp>

#include <complex>
#include <concepts>
#include <string>

#include <doctest/doctest.h>

namespace scalar_test {

/// A user's number: a value that counts nothing but itself.
struct Tagged {
    float x;
    friend Tagged operator+(Tagged a, Tagged b) { return {a.x + b.x}; }
    friend Tagged operator-(Tagged a, Tagged b) { return {a.x - b.x}; }
    friend Tagged operator*(Tagged a, Tagged b) { return {a.x * b.x}; }
    friend Tagged operator/(Tagged a, Tagged b) { return {a.x / b.x}; }
    friend Tagged operator-(Tagged a) { return {-a.x}; }
};

/// Traits without arithmetic.
struct Inert {};

}  // namespace scalar_test

template <>
struct softtissue::ScalarTraits<scalar_test::Tagged> {
    using Real = float;
    static constexpr Real value(scalar_test::Tagged t) { return t.x; }
};

template <>
struct softtissue::ScalarTraits<scalar_test::Inert> {
    using Real = double;
    static constexpr Real value(scalar_test::Inert) { return 0; }
};

using namespace softtissue;
using scalar_test::Inert;
using scalar_test::Tagged;

static_assert(RealScalar<float> && RealScalar<double> && RealScalar<long double>);
static_assert(!RealScalar<int> && !RealScalar<Tagged> && !RealScalar<std::complex<double>>);
static_assert(FieldScalar<float> && FieldScalar<double> && FieldScalar<Tagged>);
static_assert(!FieldScalar<int> && !FieldScalar<std::string> && !FieldScalar<std::complex<double>>);
static_assert(!FieldScalar<Inert>);
static_assert(std::same_as<RealOf<float>, float> && std::same_as<RealOf<double>, double>);
static_assert(std::same_as<RealOf<Tagged>, float>);

TEST_CASE_TEMPLATE("the value of a real number is the number", T, float, double, long double) {
    static_assert(std::same_as<decltype(value_of(T(0))), T>);
    static_assert(value_of(T(-2.5)) == T(-2.5));
    CHECK(value_of(T(0.1)) == T(0.1));
}

TEST_CASE("the value of a user's number comes from its traits") { CHECK(value_of(Tagged{3.5F}) == 3.5F); }
