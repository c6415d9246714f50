// SPDX-License-Identifier: MIT
// Counts of what became of many trials, and the line that each kind gets in the table.
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/solver/report.hpp>

#include <chrono>
#include <cstdio>
#include <deque>
#include <exception>
#include <map>
#include <string>

namespace reliability {

/// How one trial ended.
struct Outcome {
    softtissue::SolveStatus status = softtissue::SolveStatus::converged;
    bool is_finite = true;     ///< every number of the result
    bool may_be_told = false;  ///< a result that is not finite is right where the status says so
    int iterations = 0;
    bool has_rest = false;  ///< the load was taken away in the end, ...
    double distance = 0;    ///< ... and this is what was left of the way to rest, in sizes of the body
    bool may_stay = false;  ///< it was moved so far that another equilibrium than rest may hold it
};

/// Of all trials of one kind.
struct Tally {
    std::string kind;
    double rest_tolerance = 0;  ///< nearer to rest counts as recovered
    bool must_recover = false;  ///< a solve that converges elsewhere than at rest is a failure
    int most_allowed_iterations = 100000;
    double most_allowed_seconds = 60;

    long tried = 0, converged = 0, refused = 0, silent = 0, could_recover = 0, recovered = 0;
    std::map<std::string, long> ended;  ///< otherwise than converged
    int most_iterations = 0;
    double slowest = 0;                ///< [s]
    double furthest = 0;               ///< from rest of those that recovered
    std::deque<std::string> failures;  ///< the first few
    long num_failures = 0;

    void fail(const std::string& text) {
        ++num_failures;
        if (failures.size() < 5) {
            failures.push_back("trial " + std::to_string(tried) + ": " + text);
        }
    }

    /// Runs `trial`, which returns an Outcome or throws InvalidInput.
    template <class Trial>
    void attempt(const Trial& trial) {
        ++tried;
        const auto begin = std::chrono::steady_clock::now();
        try {
            count(trial());
        } catch (const softtissue::InvalidInput& error) {
            ++refused;
            if (std::string(error.what()).empty()) {
                fail("refused without a word");
            }
        } catch (const std::exception& error) {
            fail(std::string("another exception: ") + error.what());
        }
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        slowest = seconds > slowest ? seconds : slowest;
        if (seconds > most_allowed_seconds) {
            fail("took " + std::to_string(seconds) + " s");
        }
    }

private:
    void count(const Outcome& outcome) {
        const bool succeeded = outcome.status == softtissue::SolveStatus::converged ||
                               outcome.status == softtissue::SolveStatus::precision_limit;
        converged += succeeded ? 1 : 0;
        if (!succeeded) {
            ++ended[softtissue::to_string(outcome.status)];
        }
        if (!outcome.is_finite && (succeeded || !outcome.may_be_told)) {
            ++silent;
            fail(std::string("not finite, and the status is: ") + softtissue::to_string(outcome.status));
        }
        most_iterations = outcome.iterations > most_iterations ? outcome.iterations : most_iterations;
        if (outcome.iterations > most_allowed_iterations) {
            fail(std::to_string(outcome.iterations) + " iterations");
        }
        if (outcome.has_rest) {
            ++could_recover;
            if (outcome.distance <= rest_tolerance) {
                ++recovered;
                furthest = outcome.distance > furthest ? outcome.distance : furthest;
            } else if (must_recover && !outcome.may_stay) {
                fail("did not come back to rest: " + std::to_string(outcome.distance) + " sizes away, " +
                     softtissue::to_string(outcome.status));
            }
        }
    }
};

/// All kinds, in the order in which they were begun.
class Ledger {
public:
    Tally& begin(const std::string& kind) {
        tallies_.push_back({});
        tallies_.back().kind = kind;
        return tallies_.back();
    }

    /// Prints the line of the kind that was begun last.
    void print_last() const { print(tallies_.back()); }

    static void print_head() {
        std::printf("| %-64s | %8s | %9s | %7s | %6s | %22s | %7s | %8s | %s\n", "what", "tried", "converged",
                    "refused", "silent", "back at rest, within", "most it", "slowest", "ended otherwise");
    }

    long num_failures() const {
        long sum = 0;
        for (const Tally& tally : tallies_) {
            sum += tally.num_failures;
        }
        return sum;
    }

    long num_tried() const {
        long sum = 0;
        for (const Tally& tally : tallies_) {
            sum += tally.tried;
        }
        return sum;
    }

private:
    static void print(const Tally& tally) {
        std::string rest = "-", ended;
        if (tally.could_recover > 0) {
            char furthest[16];
            std::snprintf(furthest, sizeof(furthest), ", %.0e", tally.furthest);
            rest = std::to_string(tally.recovered) + " of " + std::to_string(tally.could_recover) + furthest;
        }
        for (const auto& [status, times] : tally.ended) {
            ended += (ended.empty() ? "" : ", ") + std::to_string(times) + " " + status;
        }
        std::printf("| %-64s | %8ld | %9ld | %7ld | %6ld | %22s | %7d | %6.2f s | %s\n", tally.kind.c_str(),
                    tally.tried, tally.converged, tally.refused, tally.silent, rest.c_str(), tally.most_iterations,
                    tally.slowest, ended.c_str());
        for (const std::string& failure : tally.failures) {
            std::printf("    FAILED %s\n", failure.c_str());
        }
        if (tally.num_failures > long(tally.failures.size())) {
            std::printf("    FAILED %ld times in all\n", tally.num_failures);
        }
        std::fflush(stdout);
    }

    std::deque<Tally> tallies_;
};

}  // namespace reliability
