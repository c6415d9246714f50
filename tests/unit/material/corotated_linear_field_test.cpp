// SPDX-License-Identifier: MIT
#include <softtissue/material/corotated_linear_field.hpp>

#include <softtissue/material/concepts.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <vector>

using namespace softtissue;

static_assert(MaterialField<CorotatedLinearField<double>>);
static_assert(MaterialField<CorotatedLinearField<float>>);

TEST_CASE_TEMPLATE("each cell has its moduli and its rotation", S, float, double) {
    CorotatedLinearField<S> field({{S(1), S(2)}, {S(3), S(4)}});
    REQUIRE(field.num_cells() == 2);
    CHECK(field.at(1).rotation() == Matrix3<S>::Identity());
    RandomGenerator random(1);
    const std::vector<Matrix3<S>> rotations{random_rotation<S>(random), random_rotation<S>(random)};
    field.set_rotations(rotations);
    const Matrix3<S> F = random_normal<Matrix3<S>>(random);
    for (Index c = 0; c < 2; ++c) {
        const CorotatedLinear<S> expected(c == 0 ? LameParameters<S>{S(1), S(2)} : LameParameters<S>{S(3), S(4)},
                                          rotations[size_t(c)]);
        CHECK(field.at(c).energy_density(F) == expected.energy_density(F));
        CHECK(field.at(c).first_piola(F) == expected.first_piola(F));
        CHECK(field.at(c).hessian(F) == expected.hessian(F));
    }
}

TEST_CASE("bad moduli and a wrong number of rotations are refused") {
    CHECK_THROWS_WITH_AS((CorotatedLinearField<double>({{1, 1}, {-1, 1}})),
                         "moduli of cell 1: mu = -1, expected positive and finite", InvalidInput);
    CorotatedLinearField<double> field({{1, 1}});
    CHECK_THROWS_WITH_AS(field.set_rotations(std::vector<Matrix3<double>>(3)),
                         "co-rotated linear: 3 rotations, expected 1", InvalidInput);
    std::vector<Matrix3<double>> rotations(1, Matrix3<double>::Identity());
    rotations[0](2, 0) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS(field.set_rotations(rotations), "co-rotated linear: rotation of cell 0 is not finite",
                         InvalidInput);
}
