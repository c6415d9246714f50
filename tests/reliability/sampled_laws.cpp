// SPDX-License-Identifier: MIT
// The laws whose trials every run of the tests samples: both elements, both scalars, one law of each kind.
#include "kinds.hpp"
#include "laws.hpp"

namespace reliability {

void run_sampled_laws(Ledger& ledger, long count, std::uint64_t seed) {
    run_law<Prism6, double, NeoHookeanLaw>(ledger, "neo-Hookean", true, count, seed);
    run_law<Tet4, double, FungLaw>(ledger, "Fung", false, count, seed);
    run_law<Tet4, float, PolarLaw>(ledger, "polar", false, count, seed);
}

}  // namespace reliability
