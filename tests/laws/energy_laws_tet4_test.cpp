// SPDX-License-Identifier: MIT
// Elastic energies over Tet4: derivatives and invariances for every material and strain frame, in float and double.
#include "energy_laws.hpp"

#include <softtissue/element/tet4.hpp>

using namespace softtissue;
using namespace softtissue_test;

TEST_CASE_TEMPLATE("elastic energies over Tet4 obey the laws", Field, EVERY_FIELD) { check_energy_laws<Tet4, Field>(); }
