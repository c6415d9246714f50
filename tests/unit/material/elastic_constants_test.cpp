// SPDX-License-Identifier: MIT
#include <softtissue/material/elastic_constants.hpp>

#include <support/refusal.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

using namespace softtissue;
using softtissue_test::refusal;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("the conversion gives textbook values") {
    const LameParameters<double> lame = lame_parameters<double>({.young_modulus = 2.5, .poisson_ratio = 0.25});
    CHECK(lame.mu == 1.0);
    CHECK(lame.lambda == 1.0);
    const LameParameters<double> auxetic = lame_parameters<double>({.young_modulus = 1.0, .poisson_ratio = -0.5});
    CHECK(auxetic.mu == 1.0);
    CHECK(auxetic.lambda == -0.5);
}

TEST_CASE_TEMPLATE("there and back", Scalar, float, double) {
    for (const Scalar nu : {Scalar(-0.9), Scalar(-0.3), Scalar(0), Scalar(0.2), Scalar(0.47), Scalar(0.4999)}) {
        const YoungPoisson<Scalar> back = young_poisson(lame_parameters<Scalar>({Scalar(45e3), nu}));
        // 1 - 2 nu loses digits near 0.5, 1 + nu near -1; nothing amplifies them on the way back by more than ten.
        CHECK(back.young_modulus ==
              doctest::Approx(45e3).epsilon(100 * double(std::numeric_limits<Scalar>::epsilon())));
        CHECK(double(back.poisson_ratio - nu) ==
              doctest::Approx(0.0).epsilon(100 * double(std::numeric_limits<Scalar>::epsilon())));
    }
}

TEST_CASE("what is refused, and how it is worded") {
    for (const double E : {0.0, -3.0, not_a_number, infinity, -infinity}) {
        CHECK_THROWS_AS(lame_parameters<double>({.young_modulus = E, .poisson_ratio = 0.3}), InvalidInput);
    }
    for (const double nu : {-1.0, 0.5, 0.6, -2.0, not_a_number, infinity}) {
        CHECK_THROWS_AS(lame_parameters<double>({.young_modulus = 1.0, .poisson_ratio = nu}), InvalidInput);
    }
    CHECK_NOTHROW(lame_parameters<double>({.young_modulus = 1.0, .poisson_ratio = std::nextafter(0.5, 0.0)}));
    CHECK_NOTHROW(lame_parameters<double>({.young_modulus = 1.0, .poisson_ratio = std::nextafter(-1.0, 0.0)}));
    CHECK_THROWS_AS(lame_parameters<double>({.young_modulus = 1e308, .poisson_ratio = 0.49}), InvalidInput);
    CHECK(refusal([] { lame_parameters<double>({.young_modulus = -3, .poisson_ratio = 0.3}); }) ==
          "young_modulus = -3, expected positive and finite");
    CHECK(refusal([] { lame_parameters<double>({.young_modulus = 3, .poisson_ratio = 0.5}); }) ==
          "poisson_ratio = 0.5, expected > -1 and < 0.5");
}

TEST_CASE("Lame's parameters are refused where their energy is not positive definite") {
    CHECK_NOTHROW(require_positive_definite<double>({.mu = 3.0, .lambda = -1.9}));
    CHECK_THROWS_AS(require_positive_definite<double>({.mu = 3.0, .lambda = -2.0}), InvalidInput);
    CHECK_THROWS_AS(require_positive_definite<double>({.mu = 0.0, .lambda = 1.0}), InvalidInput);
    CHECK_THROWS_AS(require_positive_definite<double>({.mu = 1.0, .lambda = not_a_number}), InvalidInput);
    CHECK_THROWS_AS(young_poisson<double>({.mu = 1.0, .lambda = infinity}), InvalidInput);
    CHECK(refusal([] { require_positive_definite<double>({.mu = 3.0, .lambda = -6.0}); }) ==
          "lambda = -6, expected > -2/3 mu = -2 and finite");
}
