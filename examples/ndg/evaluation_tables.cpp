// SPDX-License-Identifier: MIT
#include "evaluation_tables.hpp"

#include <softtissue/io/atomic_file.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

namespace examples {

namespace {

using Json = nlohmann::ordered_json;

/// A column of the tables.
struct Metric {
    const char* key;
    const char* title;
    const char* unit;
    double scale;  // from SI to the tables' unit
    double json_scale;
    int digits;
    FigureSummary (*summary)(const MethodEvaluation<double>&);
    FigureSummary (*difference)(const MethodEvaluation<double>&, const MethodEvaluation<double>&);
};

template <auto figure>
FigureSummary summary_of(const MethodEvaluation<double>& evaluation) {
    return evaluation.summary(figure);
}
template <auto figure>
FigureSummary difference_of(const MethodEvaluation<double>& a, const MethodEvaluation<double>& b) {
    return difference(a, b, figure);
}

template <auto figure>
Metric metric(const char* key, const char* title, const char* unit, double scale, double json_scale, int digits) {
    return {key, title, unit, scale, json_scale, digits, summary_of<figure>, difference_of<figure>};
}

using Figures = PoseFigures<double>;
const std::array<Metric, 4> metrics{metric<&Figures::position>("E_pos_mm", "E_pos", "mm", 1e3, 1e3, 3),
                                    metric<&Figures::gradient>("E_grad", "E_grad", "1e-3", 1e3, 1.0, 3),
                                    metric<&Figures::inverted>("E_inv", "E_inv", "cells", 1.0, 1.0, 2),
                                    metric<&Figures::volume>("E_vol", "E_vol", "1e-3", 1e3, 1.0, 3)};

/// The methods of a table that were evaluated, in the table's order.
std::vector<const MethodResult*> rows(const SplitResult& split, const std::vector<std::string>& names) {
    std::vector<const MethodResult*> result;
    for (const std::string& name : names) {
        if (const MethodResult* method = split.find(name)) {
            result.push_back(method);
        }
    }
    return result;
}

/// The split of tables 1 and 4, or that of table 2; null if it was not evaluated.
const SplitResult* find_split(const std::vector<SplitResult>& splits, bool of_outliers) {
    for (const SplitResult& split : splits) {
        if ((split.split == DatasetSplit::outlier) == of_outliers && !split.samples.empty()) {
            return &split;
        }
    }
    return nullptr;
}

/// The smallest mean of the methods that are not the reference.
double best(const std::vector<const MethodResult*>& methods, const Metric& metric) {
    double result = std::numeric_limits<double>::infinity();
    for (const MethodResult* method : methods) {
        if (method->name != "fem") {
            result = std::min(result, metric.summary(method->evaluation).mean);
        }
    }
    return result;
}

void print_table(const std::string& title, const SplitResult& split, const std::vector<const MethodResult*>& methods) {
    std::printf("\n%s: %d samples, %d bodies; mean and its standard error, * the best\n%-16s", title.c_str(),
                int(split.samples.size()), int(split.num_bodies), "");
    for (const Metric& metric : metrics) {
        std::printf("%19s", (std::string(metric.title) + " " + metric.unit).c_str());
    }
    std::printf("%10s\n", "ms");
    for (const MethodResult* method : methods) {
        std::printf("%-16s", method->name.c_str());
        for (const Metric& metric : metrics) {
            const FigureSummary summary = metric.summary(method->evaluation);
            const bool is_best = method->name != "fem" && summary.mean <= best(methods, metric);
            std::printf("  %8.*f +- %5.*f%s", metric.digits, metric.scale * summary.mean, metric.digits,
                        metric.scale * summary.standard_error, is_best ? "*" : " ");
        }
        const double time = method->evaluation.summary(&Figures::milliseconds).mean;
        std::isfinite(time) ? std::printf("%9.1f\n", time) : std::printf("%9s\n", "-");
    }
}

/// How much worse the others are than the first method after the reference, pose by pose.
void print_differences(const std::vector<const MethodResult*>& methods) {
    const size_t first = methods.front()->name == "fem" ? 1 : 0;
    if (methods.size() < first + 2) {
        return;
    }
    std::printf("more than %s, pose by pose\n", methods[first]->name.c_str());
    for (size_t k = first + 1; k < methods.size(); ++k) {
        std::printf("%-16s", methods[k]->name.c_str());
        for (const Metric& metric : metrics) {
            const FigureSummary more = metric.difference(methods[k]->evaluation, methods[first]->evaluation);
            std::printf("  %+8.*f +- %5.*f ", metric.digits, metric.scale * more.mean, metric.digits,
                        metric.scale * more.standard_error);
        }
        std::printf("\n");
    }
}

/// Means on the outliers over means on the test.
void print_ratios(const std::vector<const MethodResult*>& methods, const SplitResult& test) {
    std::printf("times that of table 1\n");
    for (const MethodResult* method : methods) {
        const MethodResult* before = test.find(method->name);
        if (before == nullptr) {
            continue;
        }
        std::printf("%-16s", method->name.c_str());
        for (const Metric& metric : metrics) {
            const double reference = metric.summary(before->evaluation).mean;
            reference > 0.0 ? std::printf("  %8.2f          ", metric.summary(method->evaluation).mean / reference)
                            : std::printf("  %8s          ", "-");
        }
        std::printf("\n");
    }
}

ReportTable report_table(std::string title, const SplitResult& split, const std::vector<const MethodResult*>& methods) {
    ReportTable result{.title = std::move(title),
                       .note = std::to_string(split.samples.size()) + " samples, " + std::to_string(split.num_bodies) +
                               " bodies; means and their standard errors",
                       .columns = {{"Method"}}};
    for (const Metric& metric : metrics) {
        result.columns.push_back({metric.title, metric.unit, metric.digits, BestValue::low});
        result.columns.push_back({"±", metric.unit, metric.digits});
    }
    result.columns.push_back({"Time", "ms", 1, BestValue::low});
    result.columns.push_back({"Not converged", "poses", 0});
    for (const MethodResult* method : methods) {
        ReportRow row{.cells = {method->name}, .is_reference = method->name == "fem"};
        for (const Metric& metric : metrics) {
            const FigureSummary summary = metric.summary(method->evaluation);
            row.cells.emplace_back(metric.scale * summary.mean);
            row.cells.emplace_back(metric.scale * summary.standard_error);
        }
        row.cells.emplace_back(method->evaluation.summary(&Figures::milliseconds).mean);
        row.cells.emplace_back(double(method->not_converged));
        result.rows.push_back(std::move(row));
    }
    return result;
}

Json number(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json table(const std::vector<const MethodResult*>& methods) {
    Json result = Json::object();
    for (const MethodResult* method : methods) {
        for (const Metric& metric : metrics) {
            result[method->name][metric.key] = number(metric.json_scale * metric.summary(method->evaluation).mean);
        }
        result[method->name]["milliseconds"] = number(method->evaluation.summary(&Figures::milliseconds).mean);
    }
    return result;
}

Json details(const SplitResult& split) {
    Json result = {{"samples", split.samples.size()}, {"bodies", split.num_bodies}, {"methods", Json::object()}};
    for (const MethodResult& method : split.methods) {
        Json& entry = result["methods"][method.name];
        for (const Metric& metric : metrics) {
            const FigureSummary summary = metric.summary(method.evaluation);
            entry[metric.key] = {
                {"mean", number(metric.json_scale * summary.mean)},
                {"standard_error", number(metric.json_scale * summary.standard_error)},
                {"worst", number(metric.json_scale * summary.worst)},
                {"worst_sample",
                 summary.worst_pose < 0 ? Json(nullptr) : Json(split.samples[size_t(summary.worst_pose)])}};
        }
        entry["E_pos_max_mm"] = number(1e3 * method.evaluation.summary(&Figures::largest_position).worst);
        entry["not_converged"] = method.not_converged;
        entry["smallest_predicted_determinant"] =
            method.smallest_determinant ? number(*method.smallest_determinant) : Json(nullptr);
    }
    return result;
}

}  // namespace

TableMembers table_members(const EvaluationSetup& setup) {
    TableMembers members;
    members.table1 = members.table2 = {"fem"};
    for (const EvaluatedModel& model : setup.models) {
        if (model.is_whole()) {
            members.table1.push_back(model.name);
        }
        members.table2.push_back(model.name);
        if (model.model.options.kind == NetworkKind::gradient) {
            members.table4.push_back(model.name);
        }
    }
    for (const std::string& name : setup.methods) {
        members.table1.push_back(name);
        members.table2.push_back(name);
    }
    return members;
}

std::vector<ReportTable> report_tables(const EvaluationSetup& setup, const std::vector<SplitResult>& splits) {
    const TableMembers members = table_members(setup);
    std::vector<ReportTable> tables;
    const SplitResult* test = find_split(splits, false);
    if (test != nullptr) {
        tables.push_back(
            report_table(std::string("Split '") + to_string(test->split) + "'", *test, rows(*test, members.table1)));
    }
    if (const SplitResult* outliers = find_split(splits, true)) {
        tables.push_back(
            report_table("Bodies far from those of the training", *outliers, rows(*outliers, members.table2)));
    }
    if (test != nullptr && members.table4.size() > 1) {
        tables.push_back(report_table("Parts of the method taken away", *test, rows(*test, members.table4)));
    }
    return tables;
}

void print_tables(const EvaluationSetup& setup, const std::vector<SplitResult>& splits) {
    const TableMembers members = table_members(setup);
    const SplitResult* test = find_split(splits, false);
    if (test != nullptr) {
        const auto methods = rows(*test, members.table1);
        print_table(std::string("Table 1, ") + to_string(test->split), *test, methods);
        print_differences(methods);
    }
    if (const SplitResult* outliers = find_split(splits, true)) {
        const auto methods = rows(*outliers, members.table2);
        print_table("Table 2, bodies far from those of the training", *outliers, methods);
        print_differences(methods);
        if (test != nullptr) {
            print_ratios(methods, *test);
        }
    }
    if (test != nullptr && members.table4.size() > 1) {
        const auto methods = rows(*test, members.table4);
        print_table("Table 4, parts of the method taken away", *test, methods);
        print_differences(methods);
    }
    for (const SplitResult& split : splits) {
        std::printf("\n");
        for (const MethodResult& method : split.methods) {
            if (method.smallest_determinant) {
                std::printf("%s, %s: smallest determinant of a predicted gradient %.3g\n", method.name.c_str(),
                            to_string(split.split), *method.smallest_determinant);
            }
            if (method.not_converged > 0) {
                std::printf("%s, %s: %d poses did not converge\n", method.name.c_str(), to_string(split.split),
                            method.not_converged);
            }
        }
    }
}

void write_tables(const std::filesystem::path& path, const DatasetFolder& data, const EvaluationSetup& setup,
                  const std::vector<SplitResult>& splits, double total_seconds) {
    const TableMembers members = table_members(setup);
    const SplitResult* test = find_split(splits, false);
    const SplitResult* outliers = find_split(splits, true);
    Json json = {{"table1", test != nullptr ? table(rows(*test, members.table1)) : Json::object()},
                 {"table2", outliers != nullptr ? table(rows(*outliers, members.table2)) : Json::object()},
                 {"table4", test != nullptr ? table(rows(*test, members.table4)) : Json::object()},
                 {"interrupted", false},
                 {"seconds", total_seconds},
                 {"failed_samples", data.failed().size()},
                 {"details", Json::object()},
                 {"models", Json::object()}};
    for (const SplitResult& split : splits) {
        json["details"][to_string(split.split)] = details(split);
        json["interrupted"] = json["interrupted"].get<bool>() || split.is_interrupted;
    }
    for (const EvaluatedModel& model : setup.models) {
        json["models"][model.name] = {
            {"file", model.file}, {"parameters", model.model.mlp.parameters().size()}, {"notes", model.model.notes}};
    }
    AtomicFile file(path);
    file.write(json.dump(2) + "\n");
    file.commit();
}

}  // namespace examples
