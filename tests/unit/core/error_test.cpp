#include <softtissue/core/error.hpp>

#include <stdexcept>
#include <type_traits>

#include <doctest/doctest.h>

using namespace softtissue;

static_assert(std::is_base_of_v<std::invalid_argument, InvalidInput>);

TEST_CASE("require passes in silence and throws the parts streamed into one text") {
    CHECK_NOTHROW(require(true, "never seen"));
    CHECK_THROWS_WITH_AS(require(false, "weight of vertex ", 17, " = ", -0.25, ", expected >= 0"),
                         "weight of vertex 17 = -0.25, expected >= 0", InvalidInput);
}

TEST_CASE("throw_invalid_input shows ten digits of a number") {
    CHECK_THROWS_WITH_AS(throw_invalid_input("sum = ", 1.0 / 3.0), "sum = 0.3333333333", InvalidInput);
    CHECK_THROWS_WITH_AS(throw_invalid_input("sum = ", 1.0 + 1e-9), "sum = 1.000000001", InvalidInput);
}

TEST_CASE("the text can be caught as std::exception") {
    const auto refuse = [] { require(false, "young_modulus = ", -3.0, ", expected > 0"); };
    CHECK_THROWS_WITH_AS(refuse(), "young_modulus = -3, expected > 0", std::exception);
}
