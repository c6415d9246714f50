// SPDX-License-Identifier: MIT
#include "roofline.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>

namespace benchmarks {

namespace {

using examples::LineSeries;

double median_of(const Measurement& m, const char* counter) {
    const auto found = m.counters.find(counter);
    return found == m.counters.end() ? 0.0 : spread(found->second).median;
}

bool is_on_one_thread(const Measurement& m) {
    return std::none_of(m.name.arguments.begin(), m.name.arguments.end(),
                        [](const std::string& a) { return a.starts_with("threads:") && a != "threads:1"; });
}

/// The number in front, or nothing.
std::string row_of(const std::string& group) {
    return group.substr(0, group.find_first_not_of("0123456789"));
}

LineSeries& series_of(std::vector<LineSeries>& all, const std::string& name) {
    for (LineSeries& series : all) {
        if (series.name == name) {
            return series;
        }
    }
    all.push_back({.name = name, .has_line = false});
    return all.back();
}

struct Ceilings {
    double slowest = std::numeric_limits<double>::infinity(), fastest = 0;  // bytes
    double flops_float = 0, flops_double = 0;
};

LineSeries ceiling(const char* format, double rate, std::vector<double> x, std::vector<double> y) {
    char name[64];
    std::snprintf(name, sizeof name, format, rate / 1e9);
    return {.name = name, .x = std::move(x), .y = std::move(y), .is_dashed = true};
}

}  // namespace

examples::LineChart roofline(const std::vector<Measurement>& measurements) {
    examples::LineChart chart{.title = "What kernels attain of what the machine can do, one thread",
                              .x_title = "operations a byte that must move",
                              .y_title = "Gflop/s",
                              .is_log_x = true,
                              .is_log_y = true,
                              .width = 1200,
                              .height = 800};
    Ceilings ceilings;
    double least = 0.1, largest = 10;
    for (const Measurement& m : measurements) {
        const double flops = median_of(m, "flop/s"), bytes = median_of(m, "B/s"), bandwidth = median_of(m, "peak B/s");
        if (!(flops > 0 && bytes > 0) || !is_on_one_thread(m)) {
            continue;
        }
        LineSeries& series = series_of(chart.series, m.name.is_baseline() ? "baselines" : m.program);
        series.x.push_back(flops / bytes);
        series.y.push_back(flops / 1e9);
        series.labels.push_back(m.name.is_baseline() ? std::string() : row_of(m.name.group));
        least = std::min(least, 0.5 * flops / bytes);
        largest = std::max(largest, 2 * flops / bytes);
        ceilings.slowest = std::min(ceilings.slowest, bandwidth);
        ceilings.fastest = std::max(ceilings.fastest, bandwidth);
        double& peak = m.name.scalar() == "double" ? ceilings.flops_double : ceilings.flops_float;
        peak = std::max(peak, median_of(m, "peak flop/s"));
    }
    const double top = std::max(ceilings.flops_float, ceilings.flops_double);
    const auto add_bandwidth = [&](const char* format, double rate) {
        const double end = std::min(largest, top / rate);
        chart.series.push_back(ceiling(format, rate, {least, end}, {rate * least / 1e9, rate * end / 1e9}));
    };
    const auto add_peak = [&](const char* format, double rate) {
        if (rate > 0) {
            chart.series.push_back(ceiling(format, rate, {least, largest}, {rate / 1e9, rate / 1e9}));
        }
    };
    if (!chart.series.empty()) {
        add_bandwidth("largest working set %.1f GB/s", ceilings.slowest);
        add_bandwidth("smallest %.1f GB/s", ceilings.fastest);
        add_peak("float %.0f Gflop/s", ceilings.flops_float);
        add_peak("double %.0f Gflop/s", ceilings.flops_double);
    }
    return chart;
}

}  // namespace benchmarks
