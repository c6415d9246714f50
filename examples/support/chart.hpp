// SPDX-License-Identifier: MIT
/// @file
/// A chart of lines as data: several series over one x axis, linear or logarithmic axes.
#pragma once

#include <string>
#include <vector>

namespace examples {

/// One line; it is broken where a value cannot be drawn (not finite, or not positive on a logarithmic axis). Without its line:
/// the points, each with its label if there are labels.
struct LineSeries {
    std::string name = {};
    std::vector<double> x = {}, y = {};
    bool is_dashed = false;
    bool has_line = true;
    std::vector<std::string> labels = {};
};

/// A dotted vertical line with a label at its top.
struct LineMark {
    double x = 0.0;
    std::string label = {};
};

struct LineChart {
    std::string title = {}, x_title = {}, y_title = {};
    std::vector<LineSeries> series = {};
    std::vector<LineMark> marks = {};
    bool is_log_x = false;
    bool is_log_y = false;
    int width = 960;
    int height = 600;
};

}  // namespace examples
