// SPDX-License-Identifier: MIT
// Elastic energies over Prism6: derivatives and invariances for every material and strain frame, in float and double.
#include "energy_laws.hpp"

#include <softtissue/element/prism6.hpp>

using namespace softtissue;
using namespace softtissue_test;

TEST_CASE_TEMPLATE("elastic energies over Prism6 obey the laws", Field, EVERY_FIELD) { check_energy_laws<Prism6, Field>(); }
