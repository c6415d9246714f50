// SPDX-License-Identifier: MIT
// Numbers that are none, or hardly, through a door of the library.
#pragma once

#include "ledger.hpp"

#include <cmath>
#include <limits>
#include <string>

namespace reliability {

template <class S>
class Doors {
public:
    Doors(Ledger& ledger, const std::string& what) : ledger_(ledger), tally_(ledger.begin(what + ": bad numbers")) {}
    Doors(const Doors&) = delete;
    Doors& operator=(const Doors&) = delete;
    ~Doors() { ledger_.print_last(); }

    /// `pass(x)` brings x in and returns an Outcome. NaN and infinity must be refused in a text that holds `word`, or the
    /// status must be none of success. Huge and denormal numbers may pass, with a finite result.
    template <class Pass>
    void open(const std::string& name, const std::string& word, const Pass& pass) {
        using Limits = std::numeric_limits<S>;
        for (const S bad :
             {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity(), Limits::max(), Limits::max() / 1024,
              Limits::lowest(), std::sqrt(Limits::max()), Limits::denorm_min(), -Limits::min() / 4}) {
            tally_.attempt([&] {
                try {
                    Outcome outcome = pass(bad);
                    outcome.may_be_told = true;
                    const bool succeeded = outcome.status == softtissue::SolveStatus::converged ||
                                           outcome.status == softtissue::SolveStatus::precision_limit;
                    if (!std::isfinite(bad) && succeeded) {
                        tally_.fail(name + " = " + std::to_string(bad) + " passed unnoticed");
                    } else if (succeeded && !outcome.is_finite) {
                        tally_.fail(name + " = " + std::to_string(double(bad)) + " made the result not finite");
                        outcome.is_finite = true;
                    }
                    return outcome;
                } catch (const softtissue::InvalidInput& error) {
                    if (!std::isfinite(bad) && std::string(error.what()).find(word) == std::string::npos) {
                        tally_.fail(name + ": no word of '" + word + "' in: " + error.what());
                    }
                    throw;
                }
            });
        }
    }

    /// For what has no status.
    static Outcome finite(bool is_finite) {
        Outcome outcome;
        outcome.is_finite = is_finite;
        return outcome;
    }

private:
    Ledger& ledger_;
    Tally& tally_;
};

/// Of a solve that left `x`.
template <class Report, class Array>
Outcome outcome_of(const Report& report, const Array& x) {
    Outcome outcome;
    outcome.status = report.status;
    outcome.is_finite = x.allFinite();
    outcome.iterations = report.iterations;
    return outcome;
}

}  // namespace reliability
