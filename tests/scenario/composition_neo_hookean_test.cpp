// SPDX-License-Identifier: MIT
// Stable neo-Hookean x element x strain frame x skinning in a soft-tissue avatar.
#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>

#include <support/composition.hpp>

using namespace softtissue;
using namespace softtissue_test;

TEMPLATE_TEST_CASE("stable neo-Hookean in an avatar", "[composition]", Tet4, Prism6) {
    run_avatars<TestType>(UniformField{StableNeoHookean<double>::from_young_poisson({2e4, 0.4})});
}
