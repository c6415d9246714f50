// SPDX-License-Identifier: MIT
// The laws that separate the rotation x element x strain frame x skinning in a soft-tissue avatar.
#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/material/arap.hpp>
#include <softtissue/material/corotated_linear_polar.hpp>
#include <softtissue/material/field.hpp>

#include <support/composition.hpp>

using namespace softtissue;
using namespace softtissue_test;

TEMPLATE_TEST_CASE("ARAP in an avatar", "[composition]", Tet4, Prism6) {
    run_avatars<TestType>(UniformField{Arap<double>({.stiffness = 1e4})});
}
TEMPLATE_TEST_CASE("co-rotated linear in an avatar", "[composition]", Tet4, Prism6) {
    run_avatars<TestType>(UniformField{CorotatedLinearPolar<double>::from_young_poisson({2e4, 0.4})});
}
