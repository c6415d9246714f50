// SPDX-License-Identifier: MIT
/// @file
/// What the JSON files of Google Benchmark say about kernels, their baselines and their limits, by the names of benchmarks.
///
/// What        read_measurements() of one file, compare(), growth(), and all of it as Markdown
/// Equation    ratio = time of the baseline / time of the kernel, repetition by repetition
/// Names       benchmarks/README.md
/// Refuses     text that is no such JSON, names without group and variant, failed benchmarks, times that are not positive,
///             repetitions that differ in number or in the clock between a kernel and its baseline, baselines without a kernel
///             (InvalidInput)
/// Tests       benchmarks/report/report_test.cpp
#pragma once

#include <map>
#include <string>
#include <vector>

namespace benchmarks {

struct BenchmarkName {
    std::string group, variant;
    std::vector<std::string> arguments = {};
    bool is_real_time = false;

    bool is_baseline() const { return variant.starts_with("baseline"); }
    /// `float` or `double` if that is the last word of the variant.
    std::string scalar() const;
    /// Variant and arguments as one text.
    std::string entry() const;
};

BenchmarkName parse_name(const std::string& text);

struct Measurement {
    std::string program;
    BenchmarkName name;
    std::vector<double> seconds = {};                          // an iteration; by repetition
    std::map<std::string, std::vector<double>> counters = {};  // likewise
};

/// In the order in which they were registered; `program` is only noted.
std::vector<Measurement> read_measurements(const std::string& json, const std::string& program);

struct Spread {
    double min = 0, median = 0, max = 0;
};
Spread spread(std::vector<double> values);

struct Comparison {
    const Measurement *kernel, *baseline;
    Spread ratio;
};

/// Every kernel with every baseline of its group that serves it. The result points into `measurements`.
std::vector<Comparison> compare(const std::vector<Measurement>& measurements);

/// time ~ size^exponent, by least squares of logarithms.
struct Growth {
    std::string group, entry;
    double least_size = 0, largest_size = 0, exponent = 0;
    double bytes_per_cell = 0;  // at the largest size; 0: not counted
};

/// Of kernels that ran for three or more values of an argument `prisms:<number>`.
std::vector<Growth> growth(const std::vector<Measurement>& measurements);

/// Tables of ratios and limits, and of growth. `heading` comes first.
std::string markdown(const std::vector<Measurement>& measurements, const std::string& heading);

}  // namespace benchmarks
