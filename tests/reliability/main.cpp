// SPDX-License-Identifier: MIT
// Random trials of everything that computes: how many were tried, and what became of them. Ends with 1 if something happened
// that must not: a result that is not finite where the status does not say so, an exception other than InvalidInput, a solve
// without an end, a body that does not come back to rest.
//
//   softtissue_reliability [--seed n] [--solves n] [--poses n] [--skins n] [--matrices n] [--embedded n] [--doors 0]
#include "kinds.hpp"

#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

int main(int argc, char** argv) {
    std::map<std::string, long> counts{{"--seed", 1},        {"--doors", 1},  {"--solves", 20}, {"--poses", 60},
                                       {"--matrices", 2000}, {"--skins", 60}, {"--embedded", 0}};
    for (int i = 1; i < argc; i += 2) {
        const auto option = counts.find(argv[i]);
        if (option == counts.end() || i + 1 == argc) {
            std::fprintf(stderr, "softtissue_reliability: %s is no option with a number\n", argv[i]);
            return 2;
        }
        option->second = std::atol(argv[i + 1]);
    }
    const auto seed = std::uint64_t(counts["--seed"]);
    reliability::Ledger ledger;
    reliability::Ledger::print_head();
    if (counts["--doors"] > 0) {
        reliability::run_doors(ledger);
#ifdef SOFTTISSUE_RELIABILITY_ALL
        reliability::run_heavy_doors(ledger);
#endif
    }
    reliability::run_sampled_laws(ledger, counts["--solves"], seed);
#ifdef SOFTTISSUE_RELIABILITY_ALL
    reliability::run_matrices(ledger, counts["--matrices"], seed);
    reliability::run_skinning(ledger, counts["--skins"], seed);
    reliability::run_avatars(ledger, counts["--poses"], seed);
    reliability::run_layers(ledger, counts["--poses"], seed);
    reliability::run_more_double_laws(ledger, counts["--solves"], seed);
    reliability::run_more_float_laws(ledger, counts["--solves"], seed);
    reliability::run_embedded(ledger, counts["--embedded"], seed);
#endif
    std::printf("%ld trials, %ld failures\n", ledger.num_tried(), ledger.num_failures());
    return ledger.num_failures() == 0 ? 0 : 1;
}
