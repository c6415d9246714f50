// SPDX-License-Identifier: MIT
/// @file
/// The results of a program as one HTML file: bodies in motion side by side in 3D, plots, tables. The page itself lies in
/// examples/report; here its data are collected, packed and put into it.
#pragma once

#include "chart.hpp"
#include "report_scene.hpp"

#include <softtissue/core/notation.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace examples {

/// One number under the picture.
struct ReportFigure {
    std::string name = {}, value = {}, unit = {}, note = {};
};

enum class BestValue { none, low, high };

struct ReportColumn {
    std::string title = {}, unit = {};
    int digits = -1;  // after the point; -1: three that count
    BestValue best = BestValue::none;
};

using ReportCell = std::variant<std::string, double>;

struct ReportRow {
    std::vector<ReportCell> cells = {};
    bool is_reference = false;  // never the best one
};

struct ReportTable {
    std::string title = {}, note = {};
    std::vector<ReportColumn> columns = {};
    std::vector<ReportRow> rows = {};
};

/// How a chart is drawn: lines; lines over the times of the frames; counts between one x and the next.
enum class ChartKind { lines, over_frames, histogram };

class HtmlReport {
public:
    struct Heading {
        std::string program, title, summary;
        bool has_motion = true;  // frames are moments of one motion [s]; otherwise poses, one after the other
        bool has_ground = true;
        char up = 'y';
    };

    explicit HtmlReport(Heading heading);
    ~HtmlReport();

    /// Whether write() can succeed; says why not.
    static bool is_available();

    /// Every how many frames one is to be added so that the page stays small, and says so in the page.
    Index choose_stride(Index frames, Index vertices_per_frame);

    Index add_field(ReportField field);
    Index add_layer(ReportLayer layer);
    Index add_view(ReportView view);
    Index add_mesh(ReportMesh mesh);

    /// Begins a frame; its label stands for the time if there is one.
    void add_frame(double time, std::string label = {});
    void set_positions(Index mesh, const Matrix3X<float>& positions);         // [m]; what is not set stays as it was
    void set_values(Index mesh, Index field, const Eigen::VectorXf& values);  // NaN: none
    /// The frame that is seen first.
    void set_poster(Index frame);

    void add_figure(ReportFigure figure);
    void add_chart(const LineChart& chart, ChartKind kind = ChartKind::lines);
    void add_table(ReportTable table);
    void add_note(std::string note);

    /// False, with a line on the terminal that says why, if the page was not built.
    bool write(const std::filesystem::path& path) const;

private:
    struct Content;
    std::unique_ptr<Content> content_;
};

/// How often values fall between one edge and the next, in equal steps from 0 to beyond all but 1 % of them; the last bin has
/// the rest.
LineChart histogram_chart(std::string title, std::string x_title, const std::vector<LineSeries>& values);

/// printf for one number.
std::string formatted(const char* format, double value);

}  // namespace examples
