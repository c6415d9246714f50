// SPDX-License-Identifier: MIT
// The other laws over float.
#include "kinds.hpp"
#include "laws.hpp"

namespace reliability {

void run_more_float_laws(Ledger& ledger, long count, std::uint64_t seed) {
    run_law<Prism6, float, NeoHookeanLaw>(ledger, "neo-Hookean", true, count, seed);
    run_law<Tet4, float, FungLaw>(ledger, "Fung", false, count, seed);
    run_unsampled_laws<float>(ledger, count, seed);
}

}  // namespace reliability
