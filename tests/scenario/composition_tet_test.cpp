// SPDX-License-Identifier: MIT
// Every isotropic law x strain frame x skinning over Tet4 in a soft-tissue avatar.
#include <softtissue/element/tet4.hpp>
#include <softtissue/material/arap.hpp>
#include <softtissue/material/corotated_linear_polar.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>

#include <support/composition.hpp>

using namespace softtissue;
using namespace softtissue_test;

TEST_CASE("Tet4 x stable neo-Hookean", "[composition]") {
    run_avatars<Tet4>(UniformField{StableNeoHookean<double>::from_young_poisson({2e4, 0.4})});
}
TEST_CASE("Tet4 x ARAP", "[composition]") { run_avatars<Tet4>(UniformField{Arap<double>({.stiffness = 1e4})}); }
TEST_CASE("Tet4 x co-rotated linear", "[composition]") {
    run_avatars<Tet4>(UniformField{CorotatedLinearPolar<double>::from_young_poisson({2e4, 0.4})});
}
