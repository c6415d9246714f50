// SPDX-License-Identifier: MIT
#include "html_report.hpp"

#include <softtissue/core/error.hpp>
#include <softtissue/io/atomic_file.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>

namespace examples {

namespace {

using Json = nlohmann::ordered_json;
using softtissue::require;

/// Vertices of all frames together; a page then stays below some 15 MB.
constexpr Index largest_number_of_vertices = 3'000'000;

/// Six digits are more than a plot shows.
Json rounded(double value) {
    if (!std::isfinite(value) || value == 0.0) {
        return std::isfinite(value) ? Json(0) : Json(nullptr);
    }
    const double scale = std::pow(10.0, 5.0 - std::floor(std::log10(std::abs(value))));
    return std::isfinite(scale) && scale > 0.0 ? Json(std::round(value * scale) / scale) : Json(value);
}

Json rounded(const std::vector<double>& values) {
    Json result = Json::array();
    for (const double value : values) {
        result.push_back(rounded(value));
    }
    return result;
}

std::filesystem::path template_path() {
#ifdef SOFTTISSUE_REPORT_TEMPLATE
    return SOFTTISSUE_REPORT_TEMPLATE;
#else
    return {};
#endif
}

std::string read_template() {
    std::ifstream file(template_path(), std::ios::binary);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

template <class T>
Index add_to(std::vector<T>& list, T item) {
    list.push_back(std::move(item));
    return Index(list.size()) - 1;
}

}  // namespace

struct HtmlReport::Content {
    Heading heading;
    ReportScene scene;
    Json figures = Json::array(), charts = Json::array(), tables = Json::array(), notes = Json::array();
};

HtmlReport::HtmlReport(Heading heading) : content_(std::make_unique<Content>()) {
    ReportScene& scene = content_->scene;
    scene.up = heading.up;
    scene.is_motion = heading.has_motion;
    scene.has_ground = heading.has_ground;
    content_->heading = std::move(heading);
}

HtmlReport::~HtmlReport() = default;

bool HtmlReport::is_available() {
    if (!std::filesystem::exists(template_path())) {
        std::fprintf(
            stderr,
            "report.html is not written: its page was not built, which needs node and npm (Debian: nodejs npm)\n");
        return false;
    }
    return true;
}

Index HtmlReport::choose_stride(Index frames, Index vertices_per_frame) {
    const Index fitting = std::max<Index>(2, largest_number_of_vertices / std::max<Index>(1, vertices_per_frame));
    const Index stride = std::max<Index>(1, (frames + fitting - 1) / fitting);
    if (stride > 1) {
        add_note("The 3D view shows one of every " + std::to_string(stride) + " of " + std::to_string(frames) +
                 (content_->heading.has_motion ? " frames" : " poses") + ", to keep this page small.");
    }
    return stride;
}

Index HtmlReport::add_field(ReportField field) {
    require(field.high > field.low, "report: field \"", field.name, "\" from ", field.low, " to ", field.high);
    return add_to(content_->scene.fields, std::move(field));
}

Index HtmlReport::add_layer(ReportLayer layer) {
    return add_to(content_->scene.layers, std::move(layer));
}

Index HtmlReport::add_view(ReportView view) {
    return add_to(content_->scene.views, std::move(view));
}

Index HtmlReport::add_mesh(ReportMesh mesh) {
    ReportScene& scene = content_->scene;
    require(scene.frames.empty(), "report: a mesh after the first frame");
    require(mesh.similar_to < Index(scene.meshes.size()), "report: a mesh similar to a later one");
    return add_to(scene.meshes, std::move(mesh));
}

void HtmlReport::add_frame(double time, std::string label) {
    ReportScene& scene = content_->scene;
    ReportScene::Frame frame{.time = time, .label = std::move(label)};
    frame.positions.resize(scene.meshes.size());
    if (!scene.frames.empty()) {
        frame.positions = scene.frames.back().positions;
    }
    frame.values.assign(scene.meshes.size(), std::vector<std::vector<std::uint8_t>>(scene.fields.size()));
    scene.frames.push_back(std::move(frame));
}

void HtmlReport::set_positions(Index mesh, const Matrix3X<float>& positions) {
    require(positions.allFinite(), "report: a position is not finite");
    content_->scene.frames.back().positions[size_t(mesh)] = positions;
}

void HtmlReport::set_values(Index mesh, Index field, const Eigen::VectorXf& values) {
    ReportScene& scene = content_->scene;
    scene.frames.back().values[size_t(mesh)][size_t(field)] = value_codes(scene.fields[size_t(field)], values);
}

void HtmlReport::set_poster(Index frame) {
    content_->scene.poster = frame;
}

void HtmlReport::add_figure(ReportFigure figure) {
    content_->figures.push_back(
        {{"name", figure.name}, {"value", figure.value}, {"unit", figure.unit}, {"note", figure.note}});
}

void HtmlReport::add_chart(const LineChart& chart, ChartKind kind) {
    Json json = {{"title", chart.title},
                 {"x_title", chart.x_title},
                 {"y_title", chart.y_title},
                 {"is_log_x", chart.is_log_x},
                 {"is_log_y", chart.is_log_y},
                 {"kind", kind == ChartKind::histogram ? "histogram" : "lines"},
                 {"follows_frames", kind == ChartKind::over_frames},
                 {"series", Json::array()},
                 {"marks", Json::array()}};
    for (const LineSeries& series : chart.series) {
        json["series"].push_back({{"name", series.name},
                                  {"is_dashed", series.is_dashed},
                                  {"has_line", series.has_line},
                                  {"x", rounded(series.x)},
                                  {"y", rounded(series.y)}});
    }
    for (const LineMark& mark : chart.marks) {
        json["marks"].push_back({{"x", mark.x}, {"label", mark.label}});
    }
    content_->charts.push_back(std::move(json));
}

void HtmlReport::add_table(ReportTable table) {
    static constexpr std::array<const char*, 3> bests{"", "low", "high"};
    Json json = {{"title", table.title}, {"note", table.note}, {"columns", Json::array()}, {"rows", Json::array()}};
    for (const ReportColumn& column : table.columns) {
        json["columns"].push_back({{"title", column.title},
                                   {"unit", column.unit},
                                   {"digits", column.digits < 0 ? Json(nullptr) : Json(column.digits)},
                                   {"best", bests[size_t(column.best)]}});
    }
    for (const ReportRow& row : table.rows) {
        Json cells = Json::array();
        for (const ReportCell& cell : row.cells) {
            const double* const number = std::get_if<double>(&cell);
            cells.push_back(number != nullptr ? rounded(*number) : Json(std::get<std::string>(cell)));
        }
        json["rows"].push_back({{"cells", std::move(cells)}, {"is_reference", row.is_reference}});
    }
    content_->tables.push_back(std::move(json));
}

void HtmlReport::add_note(std::string note) {
    content_->notes.push_back(std::move(note));
}

bool HtmlReport::write(const std::filesystem::path& path) const {
    if (!is_available()) {
        return false;
    }
    Json buffers = Json::array(), notes = content_->notes;
    Json scene = scene_json(content_->scene, buffers);
    if (!scene.is_null()) {
        notes.push_back(
            "Positions in 3D are rounded to " +
            formatted("%.2g", 1e3 * 0.5 * std::sqrt(3.0) * scene["grid"]["step"].get<double>()) +
            " mm at most, colours to a 254th of their scale. Figures, plots and tables are not rounded so.");
    }
    const Json report = {{"program", content_->heading.program},
                         {"title", content_->heading.title},
                         {"summary", content_->heading.summary},
                         {"version", SOFTTISSUE_VERSION},
                         {"scene", std::move(scene)},
                         {"figures", content_->figures},
                         {"charts", content_->charts},
                         {"tables", content_->tables},
                         {"notes", std::move(notes)},
                         {"buffers", std::move(buffers)}};
    std::string data = report.dump(-1, ' ', true);
    for (size_t place = data.find('<'); place != std::string::npos; place = data.find('<', place)) {
        data.replace(place, 1, "\\u003c");  // nothing in the data ends the element that they lie in
    }
    constexpr std::string_view mark = "@report@";
    const std::string page = read_template();
    const size_t place = page.find(mark);
    require(place != std::string::npos && page.find(mark, place + 1) == std::string::npos, template_path().string(),
            ": expected ", mark, " once");
    softtissue::AtomicFile file(path);
    file.write(std::string_view(page).substr(0, place));
    file.write(data);
    file.write(std::string_view(page).substr(place + mark.size()));
    file.commit();
    return true;
}

LineChart histogram_chart(std::string title, std::string x_title, const std::vector<LineSeries>& values) {
    constexpr int num_bins = 24;
    std::vector<double> all;
    for (const LineSeries& series : values) {
        all.insert(all.end(), series.y.begin(), series.y.end());
    }
    std::sort(all.begin(), all.end());
    const double end = all.empty() ? 1.0 : std::max(1e-9, 1.02 * all[size_t(std::ceil(0.99 * double(all.size()))) - 1]);
    LineChart chart{.title = std::move(title), .x_title = std::move(x_title), .y_title = "count"};
    for (const LineSeries& series : values) {
        LineSeries bins{.name = series.name};
        bins.y.assign(num_bins + 1, 0.0);
        for (int k = 0; k <= num_bins; ++k) {
            bins.x.push_back(end * k / num_bins);
        }
        for (const double value : series.y) {
            if (std::isfinite(value)) {
                bins.y[size_t(std::clamp(value / end * num_bins, 0.0, num_bins - 1.0))] += 1.0;
            }
        }
        chart.series.push_back(std::move(bins));
    }
    return chart;
}

std::string formatted(const char* format, double value) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), format, value);
    return text.data();
}

}  // namespace examples
