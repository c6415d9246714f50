// SPDX-License-Identifier: MIT
#include <softtissue/material/fung_orthotropic_field.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <vector>

using namespace softtissue;

static_assert(MaterialField<FungOrthotropicField<float>>);
static_assert(MaterialField<FungOrthotropicField<double>>);
static_assert(!HyperelasticMaterial<FungOrthotropicField<double>>);

namespace {

template <class Scalar>
typename FungOrthotropicField<Scalar>::Bases random_bases(Index cells) {
    RandomGenerator random(1);
    typename FungOrthotropicField<Scalar>::Bases bases(9, cells);
    for (Index cell = 0; cell < cells; ++cell) {
        bases.col(cell) = vec(random_rotation<Scalar>(random));
    }
    return bases;
}

}  // namespace

TEST_CASE_TEMPLATE("a cell's law is the one built from its basis and moduli", Scalar, float, double) {
    RandomGenerator random(2);
    const typename FungOrthotropicField<Scalar>::Bases bases = random_bases<Scalar>(5);
    std::vector<FungOrthotropicParameters<Scalar>> moduli;
    for (int cell = 0; cell < 5; ++cell) {
        moduli.push_back({.normal_modulus = Scalar(1e4 * (cell + 1)), .tangential_modulus = Scalar(2e4)});
    }
    const FungOrthotropicField<Scalar> shared(moduli[0], bases);
    const FungOrthotropicField<Scalar> individual(moduli, bases);
    CHECK(shared.num_cells() == 5);
    for (Index cell = 0; cell < 5; ++cell) {
        const Matrix3<Scalar> B = unvec<Scalar>(bases.col(cell));
        const Matrix3<Scalar> F = random_state<Scalar>(StateClass::general, random);
        CHECK(shared.at(cell).hessian(F) == FungOrthotropic<Scalar>(moduli[0], B).hessian(F));
        CHECK(individual.at(cell).hessian(F) == FungOrthotropic<Scalar>(moduli[size_t(cell)], B).hessian(F));
    }
}

TEST_CASE("what is refused, with the cell that is wrong") {
    using Field = FungOrthotropicField<double>;
    const FungOrthotropicParameters<double> good = {.normal_modulus = 1e4, .tangential_modulus = 2e4};
    Field::Bases bases = random_bases<double>(3);
    const std::vector<FungOrthotropicParameters<double>> two = {good, good};
    CHECK_THROWS_WITH(Field(two, bases), "parameters: 2 sets, expected 1 or one per cell: 3");
    std::vector<FungOrthotropicParameters<double>> three = {good, good, good};
    three[1].normal_modulus = -1;
    CHECK_THROWS_WITH(Field(three, bases), "parameters 1: normal_modulus = -1, expected positive and finite");
    bases.col(2).setZero();
    CHECK_THROWS_WITH(Field(good, bases), "basis of cell 2: column 0 times column 0 = 0, expected 1 (orthonormal)");
}
