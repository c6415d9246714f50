// SPDX-License-Identifier: MIT
// The other laws over double.
#include "kinds.hpp"
#include "laws.hpp"

namespace reliability {

void run_more_double_laws(Ledger& ledger, long count, std::uint64_t seed) {
    run_law<Tet4, double, PolarLaw>(ledger, "polar", false, count, seed);
    run_unsampled_laws<double>(ledger, count, seed);
}

}  // namespace reliability
