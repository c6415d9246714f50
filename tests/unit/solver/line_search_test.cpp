// SPDX-License-Identifier: MIT
#include <softtissue/solver/line_search.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

using namespace softtissue;

namespace {

/// f along the Newton step -f'/f'' from x.
template <class S, class Function>
struct Search {
    std::vector<S> lengths;
    S start, slope;
    LineSearchResult<S> found;

    Search(Function f, S x, S first, S second, const LineSearchOptions& options = {})
        : start(f(x)), slope(-first * (first / second)) {
        const S step = -first / second;
        found = search_line(
            [&](S length) {
                lengths.push_back(length);
                return f(x + length * step);
            },
            start, slope, options);
    }
};

/// exp(x^2) from x = sqrt(Q), above a constant.
template <class S>
auto exponential_search(S Q, S constant = S(0), const LineSearchOptions& options = {}) {
    const S x = std::sqrt(Q);
    const auto f = [=](S y) { return std::exp(y * y) + constant; };
    return Search<S, decltype(f)>(f, x, S(2) * x * std::exp(Q), (S(2) + S(4) * Q) * std::exp(Q), options);
}

}  // namespace

TEST_CASE_TEMPLATE("a step of an exponential lowers its exponent by one; its minimum lies 1 + 2 Q steps away", S, float,
                   double) {
    for (const S Q : {S(9), S(30), S(80)}) {
        CAPTURE(Q);
        const auto one = exponential_search<S>(Q, S(0), {.max_doublings = 0});
        CHECK(one.lengths == std::vector<S>{1});
        CHECK(one.found.length == S(1));
        CHECK(std::log(one.start / one.found.energy) == doctest::Approx(double(1)).epsilon(0.05));
        CHECK(one.found.predicted_ratio == doctest::Approx(1.264).epsilon(0.01));

        const auto far = exponential_search<S>(Q);
        CHECK(far.found.outcome == LineSearchOutcome::decreased);
        CHECK(far.found.predicted_ratio == one.found.predicted_ratio);
        // the power of two next to the minimum
        CHECK(far.found.length / (S(1) + S(2) * Q) > S(0.66));
        CHECK(far.found.length / (S(1) + S(2) * Q) < S(1.34));
        CHECK(std::log(far.found.energy) < Q / S(8));
        CHECK(far.lengths.size() <= 9);
        CHECK(far.lengths.back() == S(2) * far.found.length);
    }
    CHECK(exponential_search<S>(S(30), S(0), {.max_doublings = 2}).found.length == S(4));
}

TEST_CASE_TEMPLATE("the length of other steps stays, for one energy", S, float, double) {
    const auto square = [](S x) { return x * x / S(2); };
    const Search<S, decltype(square)> quadratic(square, S(3), S(3), S(1));
    CHECK(quadratic.lengths == std::vector<S>{1});
    CHECK(quadratic.found.energy == S(0));
    CHECK(quadratic.found.predicted_ratio == doctest::Approx(1));
    const auto power = [](S x) { return x * x * x * x; };
    const Search<S, decltype(power)> quartic(power, S(3), S(108), S(108));
    CHECK(quartic.lengths == std::vector<S>{1});
    CHECK(quartic.found.predicted_ratio == doctest::Approx(1.5 * (1 - 16.0 / 81)));
    // an exponential that is a small part of the energy, and one below zero
    CHECK(exponential_search<S>(S(5), S(1e3)).lengths == std::vector<S>{1});
    CHECK(exponential_search<S>(S(5), S(-1e3)).lengths == std::vector<S>{1});
}

TEST_CASE("a step that overshoots is halved until the energy decreases enough") {
    const auto tail = [](double x) { return std::log(1 + x * x); };
    const Search<double, decltype(tail)> search(tail, 0.99, 2 * 0.99 / (1 + 0.99 * 0.99), 0.01);
    CHECK(search.found.outcome == LineSearchOutcome::decreased);
    CHECK(search.found.length == search.lengths.back());
    CHECK(search.found.length < 0.1);
    for (size_t k = 0; k < search.lengths.size(); ++k) {
        CHECK(search.lengths[k] == std::ldexp(1.0, -int(k)));
    }
    CHECK(search.found.energy <= search.start + 1e-4 * search.found.length * search.slope);
    CHECK(search.found.predicted_ratio < 1);
}

TEST_CASE("no length that decreases the energy is an outcome") {
    int count = 0;
    const auto rising = [&](double length) {
        ++count;
        return 1 + length;
    };
    const LineSearchResult<double> found = search_line(rising, 1.0, -1.0, {.max_halvings = 7});
    CHECK(found.outcome == LineSearchOutcome::none);
    CHECK(found.length == 0);
    CHECK(count == 8);
}

TEST_CASE("energies that are not finite are no decrease") {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        CHECK(search_line([&](double) { return bad; }, 1.0, -1.0).outcome == LineSearchOutcome::none);
        // neither before the step nor beyond it
        const auto walled = [&](double length) { return length > 4 ? bad : std::exp(100 - length); };
        CHECK(search_line(walled, std::exp(100.0), -std::exp(100.0)).length == 4);
        const auto near = [&](double length) { return length > 0.3 ? bad : 1 - length; };
        CHECK(search_line(near, 1.0, -1.0).length == 0.25);
    }
}

TEST_CASE("a decrease that is lost in rounding is taken, and told") {
    const auto flat = [](double) { return 1.0; };
    CHECK(search_line(flat, 1.0, -1e-17).outcome == LineSearchOutcome::below_resolution);
    CHECK(search_line(flat, 1.0, -1e-17).length == 1);
    CHECK(search_line(flat, 1.0, 0.0).outcome == LineSearchOutcome::below_resolution);
    CHECK(search_line(flat, 1.0, -1e-3, {.max_halvings = 3}).outcome == LineSearchOutcome::none);
}
