// SPDX-License-Identifier: MIT
// The patch test with the anisotropic exponential law.
#include <softtissue/material/field.hpp>
#include <softtissue/material/fung_orthotropic.hpp>

#include <support/catch.hpp>
#include <support/patch_test.hpp>

using namespace softtissue;
using namespace softtissue_test;

TEST_CASE("patch test of skin", "[element]") {
    RandomGenerator random(9);
    const UniformField field{
        FungOrthotropic<double>({.normal_modulus = 1e4, .tangential_modulus = 5e4}, random_rotation<double>(random))};
    for (const PatchResult& result : {patch_test<Tet4>({.n = 3, .noise = 0.12}, field),
                                      patch_test<Prism6>({.n = 3, .plan_noise = 0.1, .level_noise = 0.2}, field)}) {
        CHECK(result.succeeded);
        CHECK(result.num_inner == 8);
        CHECK(result.error < 1e-12);
    }
}
