// SPDX-License-Identifier: MIT
/// @file
/// What an evaluation came to: the tables of Nolte et al. 2026 for what was trained, on the terminal and as JSON.
#pragma once

#include "../support/html_report.hpp"
#include "evaluation_run.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace examples {

/// Which methods stand in which table, by name and in order.
struct TableMembers {
    std::vector<std::string> table1;  // all whole models and all classical methods, on the first split but 'outlier'
    std::vector<std::string> table2;  // all models, and the methods without training, on the outliers
    std::vector<std::string> table4;  // whole gradient models and what remains without a part of them, as table 1
};

TableMembers table_members(const EvaluationSetup& setup);

/// `splits`: those that were evaluated.
void print_tables(const EvaluationSetup& setup, const std::vector<SplitResult>& splits);

/// The same tables for a page.
std::vector<ReportTable> report_tables(const EvaluationSetup& setup, const std::vector<SplitResult>& splits);

/// `table1`, `table2`, `table4`: method -> metric -> mean; `details`: spread and worst, by split; `models`: how they were trained.
void write_tables(const std::filesystem::path& path, const DatasetFolder& data, const EvaluationSetup& setup,
                  const std::vector<SplitResult>& splits, double total_seconds);

}  // namespace examples
