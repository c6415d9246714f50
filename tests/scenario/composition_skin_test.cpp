// SPDX-License-Identifier: MIT
// Fung's skin, its axes another in every cell, x element x strain frame x skinning in a soft-tissue avatar.
#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/material/fung_orthotropic_field.hpp>

#include <support/composition.hpp>

using namespace softtissue;
using namespace softtissue_test;

TEMPLATE_TEST_CASE("Fung's skin in an avatar", "[composition]", Tet4, Prism6) {
    const Index num_cells = RiggedBar<TestType>(2).mesh.num_cells();
    RandomGenerator random(4);
    FungOrthotropicField<double>::Bases bases(9, num_cells);
    for (Index c = 0; c < num_cells; ++c) {
        bases.col(c) = vec<double>(random_rotation<double>(random));
    }
    run_avatars<TestType>(FungOrthotropicField<double>({.normal_modulus = 1e4, .tangential_modulus = 3e4}, bases));
}
