// SPDX-License-Identifier: MIT
// The other laws over double.
#include "kinds.hpp"
#include "laws.hpp"

namespace reliability {

void run_more_double_laws(Ledger& ledger, long count, std::uint64_t seed) {
    run_law<Tet4, double, NeoHookeanLaw>(ledger, "neo-Hookean", true, count, seed);
    run_law<Prism6, double, FungLaw>(ledger, "Fung", false, count, seed);
    run_law<Tet4, double, PolarLaw>(ledger, "polar", false, count, seed);
    run_law<Prism6, double, PolarLaw>(ledger, "polar", false, count, seed);
    run_law<Tet4, double, ArapLaw>(ledger, "ARAP", false, count, seed);
    run_law<Prism6, double, ArapLaw>(ledger, "ARAP", false, count, seed);
    run_law<Tet4, double, GivenRotationLaw>(ledger, "given rotations", true, count, seed);
    run_law<Prism6, double, GivenRotationLaw>(ledger, "given rotations", true, count, seed);
}

}  // namespace reliability
