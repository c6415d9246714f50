// SPDX-License-Identifier: MIT
#include "report.hpp"

#include <softtissue/core/error.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <set>
#include <sstream>
#include <utility>

namespace benchmarks {

namespace {

using softtissue::InvalidInput;
using softtissue::require;
using Json = nlohmann::ordered_json;

constexpr const char* size_argument = "prisms:";

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts(1);
    for (const char c : text) {
        if (c == separator) {
            parts.emplace_back();
        } else {
            parts.back() += c;
        }
    }
    return parts;
}

double seconds_in(const std::string& unit, const std::string& name) {
    static const std::map<std::string, double> units{{"ns", 1e-9}, {"us", 1e-6}, {"ms", 1e-3}, {"s", 1.0}};
    const auto found = units.find(unit);
    require(found != units.end(), name, ": time_unit is \"", unit, "\", expected ns, us, ms or s");
    return found->second;
}

/// What Google Benchmark itself writes beside the counters.
bool is_counter(const std::string& key) {
    static const std::set<std::string> own{
        "repetitions", "repetition_index", "threads",      "iterations",
        "real_time",   "cpu_time",         "family_index", "per_family_instance_index"};
    return !own.contains(key);
}

/// Google Benchmark writes NaN and Infinity, which JSON has not, as the value of a key.
std::string with_null_for_nan(std::string json) {
    for (const std::string word : {": NaN", ": -NaN", ": Infinity", ": -Infinity"}) {
        for (size_t at = json.find(word); at != std::string::npos; at = json.find(word, at)) {
            json.replace(at, word.size(), ": null");
        }
    }
    return json;
}

double number(const Json& run, const char* key, const std::string& name) {
    require(run.contains(key) && run[key].is_number(), name, ": no number \"", key, "\"");
    return run[key].get<double>();
}

bool includes(const std::vector<std::string>& all, const std::vector<std::string>& some) {
    return std::all_of(some.begin(), some.end(),
                       [&](const std::string& one) { return std::find(all.begin(), all.end(), one) != all.end(); });
}

bool serves(const BenchmarkName& baseline, const BenchmarkName& kernel) {
    return baseline.group == kernel.group && (baseline.scalar().empty() || baseline.scalar() == kernel.scalar()) &&
           includes(kernel.arguments, baseline.arguments);
}

/// Three digits, `nothing` for 0.
std::string digits(double value, const char* nothing = "") {
    char text[32];
    if (value == 0) {
        return nothing;
    }
    const int decimals = std::max(0, 2 - int(std::floor(std::log10(std::abs(value)))));
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
    return text;
}

std::string with_unit(double value, const std::vector<std::pair<double, const char*>>& units) {
    for (const auto& [size, unit] : units) {
        if (value >= size) {
            return digits(value / size) + " " + unit;
        }
    }
    return digits(value / units.back().first) + " " + units.back().second;
}

std::string time_text(double seconds) {
    return with_unit(seconds, {{1.0, "s"}, {1e-3, "ms"}, {1e-6, "µs"}, {1e-9, "ns"}});
}

std::string text_of(const Spread& s) {
    return digits(s.min) + " / " + digits(s.median) + " / " + digits(s.max);
}

double median_counter(const Measurement& m, const std::string& counter) {
    const auto found = m.counters.find(counter);
    return found == m.counters.end() ? 0.0 : spread(found->second).median;
}

/// The first rate that is neither bytes nor operations.
std::string domain_rate(const Measurement& m) {
    for (const auto& [counter, values] : m.counters) {
        if (counter.ends_with("/s") && counter != "B/s" && counter != "flop/s" && !counter.starts_with("peak ")) {
            return with_unit(spread(values).median, {{1e9, "G "}, {1e6, "M "}, {1e3, "k "}, {1.0, ""}}) + counter;
        }
    }
    return {};
}

std::string limit_text(const Measurement& m) {
    const auto found = m.counters.find("of limit");
    if (found == m.counters.end()) {
        return {};
    }
    const Spread s = spread(found->second);
    char text[64];
    std::snprintf(text, sizeof text, "%.0f / %.0f / %.0f %%", 100 * s.min, 100 * s.median, 100 * s.max);
    return text;
}

/// Groups that begin with a number come first, in its order; the others as they came.
std::vector<std::string> ordered_groups(const std::vector<Measurement>& measurements) {
    std::vector<std::string> groups;
    for (const Measurement& m : measurements) {
        if (std::find(groups.begin(), groups.end(), m.name.group) == groups.end()) {
            groups.push_back(m.name.group);
        }
    }
    const auto row = [](const std::string& group) {
        const int value = std::atoi(group.c_str());
        return value > 0 ? value : 1000;
    };
    std::stable_sort(groups.begin(), groups.end(),
                     [&](const std::string& a, const std::string& b) { return row(a) < row(b); });
    return groups;
}

double size_of(const BenchmarkName& name) {
    for (const std::string& argument : name.arguments) {
        if (argument.starts_with(size_argument)) {
            return std::atof(argument.c_str() + std::string(size_argument).size());
        }
    }
    return 0;
}

void write_group(std::ostream& out, const std::string& group, const std::vector<Measurement>& measurements,
                 const std::vector<Comparison>& comparisons) {
    for (const Measurement& m : measurements) {
        if (m.name.group != group || m.name.is_baseline()) {
            continue;
        }
        std::string kernel = "| " + group + ": " + m.name.entry() + " | " + time_text(spread(m.seconds).median) +
                             " | " + domain_rate(m) + " | " + digits(median_counter(m, "B/s") / 1e9) + " | " +
                             digits(median_counter(m, "flop/s") / 1e9) + " | " + limit_text(m) + " | ";
        bool is_compared = false;
        for (const Comparison& c : comparisons) {
            if (c.kernel == &m) {
                out << kernel << c.baseline->name.entry().substr(std::string("baseline ").size()) << " | "
                    << time_text(spread(c.baseline->seconds).median) << " | " << text_of(c.ratio) << " |\n";
                kernel = "| \" | | | | | | ";
                is_compared = true;
            }
        }
        if (!is_compared) {
            out << kernel << "| | |\n";
        }
    }
}

}  // namespace

std::string BenchmarkName::scalar() const {
    const std::string last = split(split(variant, ' ').back(), ',').back();
    return last == "float" || last == "double" ? last : std::string();
}

std::string BenchmarkName::entry() const {
    std::string text = variant;
    for (const std::string& argument : arguments) {
        text += ", " + argument;
    }
    return text;
}

BenchmarkName parse_name(const std::string& text) {
    std::vector<std::string> parts = split(text, '/');
    require(parts.size() >= 2 && !parts[0].empty() && !parts[1].empty(), "benchmark \"", text,
            "\": expected a name of the form group/variant, see benchmarks/README.md");
    BenchmarkName name{parts[0], parts[1]};
    require(!name.is_baseline() || name.variant.starts_with("baseline "), "benchmark \"", text,
            "\": expected what the baseline is after the word");
    for (size_t k = 2; k < parts.size(); ++k) {
        const std::string& part = parts[k];
        if (part == "real_time" || part == "manual_time") {
            name.is_real_time = true;
        } else if (part != "process_time" && !part.starts_with("repeats:") && !part.starts_with("min_time:") &&
                   !part.starts_with("min_warmup_time:") && !part.starts_with("iterations:")) {
            name.arguments.push_back(part);
        }
    }
    return name;
}

std::vector<Measurement> read_measurements(const std::string& json, const std::string& program) {
    const Json file = Json::parse(with_null_for_nan(json), nullptr, false);
    require(!file.is_discarded(), program, ": not JSON; was the benchmark interrupted?");
    require(file.is_object() && file.contains("benchmarks") && file["benchmarks"].is_array(), program,
            ": no list \"benchmarks\", expected what --benchmark_out writes");
    std::vector<Measurement> result;
    std::map<std::string, size_t> places;
    std::vector<std::array<double, 2>> registered;
    for (const Json& run : file["benchmarks"]) {
        require(run.is_object() && run.contains("run_name") && run["run_name"].is_string(), program,
                ": an entry without \"run_name\"");
        const std::string text = run["run_name"];
        require(!run.value("error_occurred", false), text, ": failed: ", run.value("error_message", std::string()));
        if (run.value("run_type", std::string("iteration")) != "iteration") {
            continue;  // means and medians of the repetitions
        }
        const auto [place, is_new] = places.try_emplace(text, result.size());
        if (is_new) {
            result.push_back({program, parse_name(text)});
            registered.push_back({run.value("family_index", 0.0), run.value("per_family_instance_index", 0.0)});
        }
        Measurement& m = result[place->second];
        const double time = number(run, m.name.is_real_time ? "real_time" : "cpu_time", text) *
                            seconds_in(run.value("time_unit", std::string()), text);
        require(std::isfinite(time) && time > 0, text, ": time ", time, ", expected more than 0");
        m.seconds.push_back(time);
        for (const auto& [key, value] : run.items()) {
            if (value.is_number() && is_counter(key)) {
                m.counters[key].push_back(value.get<double>());
            }
        }
    }
    require(!result.empty(), program, ": no benchmark in it");
    // They ran in random order.
    std::vector<size_t> order(result.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return registered[a] < registered[b]; });
    std::vector<Measurement> sorted;
    for (const size_t k : order) {
        sorted.push_back(std::move(result[k]));
    }
    return sorted;
}

Spread spread(std::vector<double> values) {
    require(!values.empty(), "spread of no values");
    std::sort(values.begin(), values.end());
    const size_t half = values.size() / 2;
    const double median = values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
    return {values.front(), median, values.back()};
}

std::vector<Comparison> compare(const std::vector<Measurement>& measurements) {
    std::vector<Comparison> result;
    std::set<const Measurement*> used;
    for (const Measurement& kernel : measurements) {
        for (const Measurement& baseline : measurements) {
            if (kernel.name.is_baseline() || !baseline.name.is_baseline() || kernel.program != baseline.program ||
                !serves(baseline.name, kernel.name)) {
                continue;
            }
            const std::string pair = kernel.name.group + ": " + kernel.name.entry() + " and " + baseline.name.entry();
            require(kernel.seconds.size() == baseline.seconds.size(), pair, ": ", kernel.seconds.size(), " and ",
                    baseline.seconds.size(), " repetitions, expected equal numbers");
            require(kernel.name.is_real_time == baseline.name.is_real_time, pair,
                    ": one by wall clock, one by processor time, expected UseRealTime() for both or none");
            std::vector<double> ratios;
            for (size_t k = 0; k < kernel.seconds.size(); ++k) {
                ratios.push_back(baseline.seconds[k] / kernel.seconds[k]);
            }
            used.insert(&baseline);
            result.push_back({&kernel, &baseline, spread(ratios)});
        }
    }
    for (const Measurement& m : measurements) {
        require(!m.name.is_baseline() || used.contains(&m), m.name.group, ": ", m.name.entry(),
                " is a baseline without a kernel in ", m.program);
    }
    return result;
}

std::vector<Growth> growth(const std::vector<Measurement>& measurements) {
    std::vector<Growth> result;
    std::vector<std::vector<std::array<double, 2>>> points;
    for (const Measurement& m : measurements) {
        const double size = size_of(m.name);
        if (!(size > 0)) {
            continue;
        }
        BenchmarkName without = m.name;
        std::erase_if(without.arguments, [](const std::string& a) { return a.starts_with(size_argument); });
        size_t k = 0;
        while (k < result.size() && (result[k].group != without.group || result[k].entry != without.entry())) {
            ++k;
        }
        if (k == result.size()) {
            result.push_back({without.group, without.entry(), size, size});
            points.emplace_back();
        }
        if (size >= result[k].largest_size) {
            result[k].largest_size = size;
            result[k].bytes_per_cell = median_counter(m, "B/cell");
        }
        result[k].least_size = std::min(result[k].least_size, size);
        points[k].push_back({std::log(size), std::log(spread(m.seconds).median)});
    }
    for (size_t k = result.size(); k-- > 0;) {
        std::set<double> sizes;
        double x = 0, y = 0, xx = 0, xy = 0;
        for (const auto& [log_size, log_time] : points[k]) {
            sizes.insert(log_size);
            x += log_size / double(points[k].size());
            y += log_time / double(points[k].size());
        }
        for (const auto& [log_size, log_time] : points[k]) {
            xx += (log_size - x) * (log_size - x);
            xy += (log_size - x) * (log_time - y);
        }
        if (sizes.size() < 3) {
            result.erase(result.begin() + std::ptrdiff_t(k));
        } else {
            result[k].exponent = xy / xx;
        }
    }
    return result;
}

std::string markdown(const std::vector<Measurement>& measurements, const std::string& heading) {
    const std::vector<Comparison> comparisons = compare(measurements);
    std::ostringstream out;
    out << heading
        << "\nTimes and rates are medians; three figures are the least, the median and the largest. Ratio: the "
           "baseline's time over the "
           "kernel's.\n\n| kernel | time | rate | GB/s | Gflop/s | of limit | baseline | its time | ratio |\n"
           "|---|---|---|---|---|---|---|---|---|\n";
    for (const std::string& group : ordered_groups(measurements)) {
        write_group(out, group, measurements, comparisons);
    }
    const std::vector<Growth> grown = growth(measurements);
    if (!grown.empty()) {
        out << "\nGrowth: time ~ prisms^exponent.\n\n| kernel | prisms | exponent | bytes a prism "
               "|\n|---|---|---|---|\n";
        for (const Growth& g : grown) {
            char exponent[16];
            std::snprintf(exponent, sizeof exponent, "%.2f", g.exponent);
            out << "| " << g.group << ": " << g.entry << " | " << g.least_size << " to " << g.largest_size << " | "
                << exponent << " | " << digits(g.bytes_per_cell) << " |\n";
        }
    }
    return out.str();
}

}  // namespace benchmarks
