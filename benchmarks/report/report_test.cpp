// SPDX-License-Identifier: MIT
#include "report.hpp"
#include "roofline.hpp"

#include <support/refusal.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <sstream>

using namespace benchmarks;
using softtissue_test::refusal;

namespace {

/// An entry as Google Benchmark writes it.
std::string entry(const std::string& name, int repetition, double real_time, double cpu_time, const std::string& unit,
                  const std::string& more = "", int family = 0) {
    std::ostringstream out;
    out << "{\"name\": \"" << name << "\", \"family_index\": " << family
        << ", \"per_family_instance_index\": 0, \"run_name\": \"" << name
        << "\", \"run_type\": \"iteration\", \"repetitions\": 3, \"repetition_index\": " << repetition
        << ", \"threads\": 1, \"iterations\": 7, \"real_time\": " << real_time << ", \"cpu_time\": " << cpu_time
        << ", \"time_unit\": \"" << unit << "\"" << more << "}";
    return out.str();
}

std::string repeated(const std::string& name, std::vector<double> cpu_times, const std::string& unit,
                     const std::string& more = "") {
    std::string text;
    for (size_t k = 0; k < cpu_times.size(); ++k) {
        text += (k > 0 ? ",\n" : "") + entry(name, int(k), 99, cpu_times[k], unit, more);
    }
    return text;
}

std::string file_of(const std::vector<std::string>& entries) {
    std::string text = R"({"context": {"date": "2026-01-01", "num_cpus": 2}, "benchmarks": [)";
    for (size_t k = 0; k < entries.size(); ++k) {
        text += (k > 0 ? ",\n" : "") + entries[k];
    }
    return text + "]}";
}

std::vector<Measurement> measured(const std::vector<std::string>& entries) {
    return read_measurements(file_of(entries), "fits");
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a name has a group, a variant and arguments") {
    const BenchmarkName name = parse_name("10 rotation fit/baseline Eigen JacobiSVD, float/50000/threads:2/real_time");
    CHECK(name.group == "10 rotation fit");
    CHECK(name.variant == "baseline Eigen JacobiSVD, float");
    CHECK(name.arguments == std::vector<std::string>{"50000", "threads:2"});
    CHECK(name.is_baseline());
    CHECK(name.is_real_time);
    CHECK(name.scalar() == "float");
    CHECK(parse_name("a/cold double").scalar() == "double");
    CHECK(parse_name("a/double").scalar() == "double");
    CHECK(parse_name("a/of doubles").scalar().empty());
    CHECK_FALSE(parse_name("a/float/repeats:3/iterations:4").is_real_time);
    CHECK(parse_name("a/float/repeats:3/iterations:4").arguments.empty());
}

TEST_CASE("names without group and variant are refused") {
    CHECK(contains(refusal([] { parse_name("energy<float>"); }), "group/variant"));
    CHECK(contains(refusal([] { parse_name("energy/"); }), "group/variant"));
    CHECK(contains(refusal([] { parse_name("energy/baseline"); }), "what the baseline is"));
}

TEST_CASE("least, median and largest") {
    const Spread odd = spread({3, 1, 2}), even = spread({4, 1, 2, 3}), one = spread({5});
    CHECK(odd.min == 1);
    CHECK(odd.median == 2);
    CHECK(odd.max == 3);
    CHECK(even.median == 2.5);
    CHECK(one.min == 5);
    CHECK(one.max == 5);
}

TEST_CASE("ratios are those of the repetitions, in any unit") {
    const auto all = measured(
        {repeated("1 solve/float", {2, 1, 4}, "us"), repeated("1 solve/baseline other", {8000, 8000, 8000}, "ns")});
    const auto comparisons = compare(all);
    REQUIRE(comparisons.size() == 1);
    CHECK(comparisons[0].ratio.min == doctest::Approx(2));
    CHECK(comparisons[0].ratio.median == doctest::Approx(4));
    CHECK(comparisons[0].ratio.max == doctest::Approx(8));
}

TEST_CASE("the clock is the one that the name says") {
    const auto all = measured({entry("a/float/real_time", 0, 3, 1, "ms"), entry("b/float", 0, 3, 1, "ms")});
    CHECK(all[0].seconds[0] == doctest::Approx(3e-3));
    CHECK(all[1].seconds[0] == doctest::Approx(1e-3));
}

TEST_CASE("a baseline serves its group, its scalar and its arguments") {
    const auto all =
        measured({repeated("fit/cold, float/10", {1}, "us"), repeated("fit/cold, double/10", {1}, "us"),
                  repeated("fit/cold, float/20/threads:2", {1}, "us"), repeated("fit/baseline x, float/10", {2}, "us"),
                  repeated("fit/baseline x, float/20", {3}, "us"), repeated("fit/baseline y", {5}, "us"),
                  repeated("other/float/10", {1}, "us")});
    std::vector<std::string> pairs;
    for (const Comparison& c : compare(all)) {
        pairs.push_back(c.kernel->name.entry() + " <- " + c.baseline->name.entry());
    }
    CHECK(pairs == std::vector<std::string>{"cold, float, 10 <- baseline x, float, 10", "cold, float, 10 <- baseline y",
                                            "cold, double, 10 <- baseline y",
                                            "cold, float, 20, threads:2 <- baseline x, float, 20",
                                            "cold, float, 20, threads:2 <- baseline y"});
}

TEST_CASE("benchmarks are in the order of their registration") {
    const auto all = measured({entry("a/third", 0, 1, 1, "ns", "", 2), entry("a/first", 0, 1, 1, "ns", "", 0),
                               entry("a/second", 0, 1, 1, "ns", "", 1), entry("a/first", 1, 1, 2, "ns", "", 0)});
    REQUIRE(all.size() == 3);
    CHECK(all[0].name.variant == "first");
    CHECK(all[0].seconds.size() == 2);
    CHECK(all[1].name.variant == "second");
    CHECK(all[2].name.variant == "third");
}

TEST_CASE("aggregates are not measurements") {
    std::string mean = entry("a/float", 0, 1, 1000, "ns");
    mean.replace(mean.find("iteration"), 9, "aggregate");
    mean.insert(mean.rfind('}'), ", \"steps\": NaN, \"rate\": -Infinity");  // variation of a counter that is 0
    const auto all = measured({repeated("a/float", {1, 2}, "ns"), mean});
    REQUIRE(all.size() == 1);
    CHECK(all[0].seconds.size() == 2);
}

TEST_CASE("broken input is refused in words") {
    CHECK(contains(refusal([] { read_measurements("{\"benchmarks\": [", "fits"); }), "fits: not JSON"));
    CHECK(contains(refusal([] { read_measurements("{}", "fits"); }), "no list \"benchmarks\""));
    CHECK(contains(refusal([] { measured({}); }), "no benchmark"));
    CHECK(contains(refusal([] { measured({"{}"}); }), "run_name"));
    CHECK(contains(refusal([] { measured({entry("a/float", 0, 1, 0, "ns")}); }), "a/float: time 0"));
    CHECK(contains(refusal([] { measured({entry("a/float", 0, 1, 1, "h")}); }), "time_unit is \"h\""));
    CHECK(contains(
        refusal([] {
            measured({entry("a/float", 0, 1, 1, "ns", ", \"error_occurred\": true, \"error_message\": \"no file\"")});
        }),
        "a/float: failed: no file"));
    CHECK(contains(refusal([] {
                       compare(measured({repeated("a/float", {1, 2}, "ns"), repeated("a/baseline x", {1}, "ns")}));
                   }),
                   "2 and 1 repetitions"));
    CHECK(
        contains(refusal([] {
                     compare(measured({repeated("a/float/real_time", {1}, "ns"), repeated("a/baseline x", {1}, "ns")}));
                 }),
                 "wall clock"));
    CHECK(contains(refusal([] {
                       compare(measured({repeated("a/float", {1}, "ns"), repeated("a/baseline x, double", {1}, "ns")}));
                   }),
                   "baseline without a kernel"));
}

TEST_CASE("growth is the slope of logarithms") {
    std::vector<std::string> entries;
    for (const double n : {1000.0, 4000.0, 16000.0}) {
        std::ostringstream more;
        more << ", \"B/cell\": " << n / 100;
        const std::string argument = "/prisms:" + std::to_string(int(n)) + "/threads:2";
        entries.push_back(repeated("solve/float" + argument, {3 * std::pow(n, 1.25)}, "ns", more.str()));
    }
    entries.push_back(repeated("two/float/prisms:1000", {1}, "ns"));
    entries.push_back(repeated("two/float/prisms:2000", {1}, "ns"));
    const auto grown = growth(measured(entries));
    REQUIRE(grown.size() == 1);
    CHECK(grown[0].entry == "float, threads:2");
    CHECK(grown[0].exponent == doctest::Approx(1.25));
    CHECK(grown[0].least_size == 1000);
    CHECK(grown[0].largest_size == 16000);
    CHECK(grown[0].bytes_per_cell == 160);
}

TEST_CASE("the table has rows in the order of their numbers, rates and limits") {
    const std::string counters =
        R"(, "cells/s": 2.5e6, "B/s": 3e9, "flop/s": 4e10, "of limit": 0.25, "peak flop/s": 1e11, "peak B/s": 2e10)";
    const std::string text = markdown(
        measured({repeated("plain/float", {1}, "ms"), repeated("10 fit/float", {1, 2, 3}, "ms", counters),
                  repeated("10 fit/baseline x, float", {10, 10, 10}, "ms"), repeated("2 solve/float", {1}, "ms")}),
        "# Heading\n");
    CHECK(contains(text, "# Heading\n"));
    CHECK(contains(text,
                   "| 10 fit: float | 2.00 ms | 2.50 M cells/s | 3.00 | 40.0 | 25 / 25 / 25 % | x, float | 10.0 ms | "
                   "3.33 / 5.00 / 10.0 |\n"));
    CHECK(contains(text, "| plain: float | 1.00 ms | "));
    CHECK(text.find("2 solve") < text.find("10 fit"));
    CHECK(text.find("10 fit") < text.find("plain"));
}

TEST_CASE("the roofline shows kernels on one thread that count operations and bytes") {
    const std::string counters = R"(, "B/s": 1e9, "flop/s": 4e9, "peak flop/s": 1e11, "peak B/s": 2e10)";
    const auto chart =
        roofline(measured({repeated("10 fit/float/threads:1", {1}, "ms", counters),
                           repeated("10 fit/float/threads:2", {1}, "ms", counters),
                           repeated("10 fit/baseline x", {5}, "ms", counters), repeated("plain/float", {1}, "ms")}));
    REQUIRE(chart.series.size() == 5);
    CHECK(chart.series[0].name == "fits");
    CHECK(chart.series[0].x == std::vector<double>{4});
    CHECK(chart.series[0].y == std::vector<double>{4});
    CHECK(chart.series[0].labels == std::vector<std::string>{"10"});
    CHECK(chart.series[1].name == "baselines");
    CHECK(chart.series[4].y == std::vector<double>{100, 100});
    CHECK(roofline(measured({repeated("plain/float", {1}, "ms")})).series.empty());
}
