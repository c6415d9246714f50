// SPDX-License-Identifier: MIT
#include "html_report.hpp"

#include "color_scale.hpp"

#include <softtissue/core/error.hpp>
#include <softtissue/io/atomic_file.hpp>

#include <zlib.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <limits>
#include <sstream>
#include <string_view>
#include <utility>

namespace examples {

namespace {

using Json = nlohmann::ordered_json;
using softtissue::require;

/// Vertices of all frames together; a page then stays below some 15 MB.
constexpr Index largest_number_of_vertices = 3'000'000;
constexpr double grid_steps = 65535.0;  // positions are numbers of 16 bits
constexpr unsigned no_value = 255;      // values are codes from 0 to 254

/// Of a signed difference: 0, -1, 1, -2, ... become 0, 1, 2, 3, ...
template <class Unsigned>
Unsigned folded(Unsigned difference) {
    constexpr int bits = 8 * int(sizeof(Unsigned));
    const bool is_negative = (difference >> (bits - 1)) != 0;
    return static_cast<Unsigned>((difference << 1) ^ (is_negative ? ~Unsigned(0) : Unsigned(0)));
}

/// Lowest bytes of all numbers first.
template <class Unsigned>
std::vector<unsigned char> planes(const std::vector<Unsigned>& numbers) {
    std::vector<unsigned char> bytes;
    bytes.reserve(numbers.size() * sizeof(Unsigned));
    for (size_t plane = 0; plane < sizeof(Unsigned); ++plane) {
        for (const Unsigned number : numbers) {
            bytes.push_back(static_cast<unsigned char>((number >> (8 * plane)) & 0xFFU));
        }
    }
    return bytes;
}

std::string base64(const std::vector<unsigned char>& bytes) {
    static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve(4 * (bytes.size() / 3 + 1));
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t count = std::min<size_t>(3, bytes.size() - i);
        unsigned group = 0;
        for (size_t k = 0; k < 3; ++k) {
            group = group << 8 | (k < count ? bytes[i + k] : 0U);
        }
        for (size_t k = 0; k < 4; ++k) {
            text += k <= count ? digits[group >> (18 - 6 * k) & 63U] : '=';
        }
    }
    return text;
}

template <class Unsigned>
std::string packed(const std::vector<Unsigned>& numbers) {
    const std::vector<unsigned char> bytes = planes(numbers);
    uLongf size = compressBound(uLong(bytes.size()));
    std::vector<unsigned char> result(size);
    const int status = compress2(result.data(), &size, bytes.data(), uLong(bytes.size()), 6);
    require(status == Z_OK, "report: zlib's status ", status);
    result.resize(size);
    return base64(result);
}

std::string packed_indices(const std::int32_t* indices, Index count) {
    std::vector<std::uint32_t> codes;
    std::uint32_t before = 0;
    for (Index i = 0; i < count; ++i) {
        const auto index = static_cast<std::uint32_t>(indices[i]);
        codes.push_back(folded<std::uint32_t>(index - before));
        before = index;
    }
    return packed(codes);
}

/// `rows` of equal length, each as differences from the row `stride` before, and from number to number.
template <class Unsigned>
std::string packed_rows(const std::vector<std::vector<Unsigned>>& rows, size_t stride) {
    std::vector<Unsigned> codes;
    for (size_t r = 0; r < rows.size(); ++r) {
        Unsigned before = 0;
        for (size_t i = 0; i < rows[r].size(); ++i) {
            const Unsigned change = static_cast<Unsigned>(rows[r][i] - (r >= stride ? rows[r - stride][i] : 0));
            codes.push_back(folded<Unsigned>(static_cast<Unsigned>(change - before)));
            before = change;
        }
    }
    return packed(codes);
}

std::string hex(const Eigen::Vector3f& color) {
    std::array<char, 8> text{};
    const auto byte = [&](int k) { return unsigned(std::lround(255.0F * std::clamp(color(k), 0.0F, 1.0F))); };
    std::snprintf(text.data(), text.size(), "#%02x%02x%02x", byte(0), byte(1), byte(2));
    return text.data();
}

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

Json stops(bool is_signed) {
    Json result = Json::array();
    constexpr int count = 33;
    for (int k = 0; k < count; ++k) {
        const double place = double(k) / (count - 1);
        result.push_back(hex(is_signed ? signed_scale_color(2.0 * place - 1.0) : scale_color(place)));
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

}  // namespace

struct HtmlReport::Content {
    struct Frame {
        double time = 0.0;
        std::string label;
        std::vector<Matrix3X<float>> positions;                      // by mesh
        std::vector<std::vector<std::vector<std::uint8_t>>> values;  // by mesh, by field: codes
    };

    Heading heading;
    std::vector<ReportField> fields;
    std::vector<ReportLayer> layers;
    std::vector<ReportView> views;
    std::vector<ReportMesh> meshes;
    std::vector<Frame> frames;
    Index poster = 0;
    Json figures = Json::array(), charts = Json::array(), tables = Json::array(), notes = Json::array();

    /// Of all meshes and frames one grid: a corner per frame, one step.
    struct Grid {
        std::vector<std::array<double, 3>> corners;
        double step = 0.0;

        std::uint16_t place(size_t frame, int axis, float x) const {
            const double place = std::round((double(x) - corners[frame][size_t(axis)]) / step);
            return static_cast<std::uint16_t>(std::clamp(place, 0.0, grid_steps));
        }
    };

    Grid make_grid() const {
        Grid grid;
        double size = 1e-9;
        for (const Frame& frame : frames) {
            std::array<double, 3> corner{};
            for (int axis = 0; axis < 3; ++axis) {
                double low = std::numeric_limits<double>::infinity(), high = -low;
                for (const Matrix3X<float>& positions : frame.positions) {
                    low = std::min(low, double(positions.row(axis).minCoeff()));
                    high = std::max(high, double(positions.row(axis).maxCoeff()));
                }
                require(std::isfinite(low) && std::isfinite(high), "report: positions of the frame at ", frame.time,
                        " s are not finite");
                corner[size_t(axis)] = std::floor(1e6 * low) / 1e6;
                size = std::max(size, high - corner[size_t(axis)]);
            }
            grid.corners.push_back(corner);
        }
        grid.step = size / grid_steps;
        return grid;
    }

    /// Per frame three rows: x, y, z of all vertices.
    std::vector<std::vector<std::uint16_t>> places(const Grid& grid, size_t mesh) const {
        std::vector<std::vector<std::uint16_t>> rows;
        for (size_t f = 0; f < frames.size(); ++f) {
            const Matrix3X<float>& positions = frames[f].positions[mesh];
            for (int axis = 0; axis < 3; ++axis) {
                std::vector<std::uint16_t>& row = rows.emplace_back();
                for (Index v = 0; v < positions.cols(); ++v) {
                    row.push_back(grid.place(f, axis, positions(axis, v)));
                }
            }
        }
        return rows;
    }

    Json mesh_json(size_t index, const Grid& grid, Json& topologies, Json& buffers) const {
        const ReportMesh& mesh = meshes[index];
        const auto add_buffer = [&](std::string text) {
            buffers.push_back(std::move(text));
            return buffers.size() - 1;
        };
        const bool is_skeleton = mesh.bones.size() > 0;
        size_t topology = 0;  // that of an earlier mesh, if it is the same
        while (topology < index && (meshes[topology].triangles.size() != mesh.triangles.size() ||
                                    meshes[topology].triangles != mesh.triangles || is_skeleton)) {
            ++topology;
        }
        if (topology == index) {
            const Index count = is_skeleton ? mesh.bones.size() : mesh.triangles.size();
            const std::int32_t* const data = is_skeleton ? mesh.bones.data() : mesh.triangles.data();
            topologies.push_back({{"count", count}, {"buffer", add_buffer(packed_indices(data, count))}});
        } else {
            topologies.push_back(topologies[topology]);
        }
        std::vector<std::vector<std::uint16_t>> rows = places(grid, index);
        if (mesh.similar_to >= 0) {
            const std::vector<std::vector<std::uint16_t>> others = places(grid, size_t(mesh.similar_to));
            for (size_t r = 0; r < rows.size(); ++r) {
                for (size_t i = 0; i < rows[r].size(); ++i) {
                    rows[r][i] = static_cast<std::uint16_t>(rows[r][i] - others[r][i]);
                }
            }
        }
        Json values = Json::array();
        for (size_t field = 0; field < fields.size(); ++field) {
            std::vector<std::vector<std::uint8_t>> codes;
            bool has_values = false;
            for (const Frame& frame : frames) {
                codes.push_back(frame.values[index][field]);
                has_values |= !codes.back().empty();
                codes.back().resize(size_t(frame.positions[index].cols()), std::uint8_t(no_value));
            }
            if (has_values) {
                values.push_back({{"field", field}, {"buffer", add_buffer(packed_rows(codes, 1))}});
            }
        }
        const Vector3Mean last = mean(frames.back().positions[index]);
        const ReportLayer& layer = layers[size_t(mesh.layer)];
        return {{"view", mesh.view},
                {"layer", mesh.layer},
                {"topology", index},
                {"is_skeleton", is_skeleton},
                {"vertices", frames.front().positions[index].cols()},
                {"color", hex(layer.color)},
                {"opacity", layer.opacity},
                {"reference", mesh.similar_to},
                {"positions", add_buffer(packed_rows(rows, 3))},
                {"values", values},
                {"mean_of_last_frame", last}};
    }

    using Vector3Mean = std::array<double, 3>;
    static Vector3Mean mean(const Matrix3X<float>& positions) {
        const Eigen::Vector3d sum = positions.cast<double>().rowwise().sum();
        const double count = double(positions.cols());
        return {sum(0) / count, sum(1) / count, sum(2) / count};
    }

    Json scene_json(Json& buffers, Json& all_notes) const {
        if (meshes.empty() || frames.empty()) {
            return nullptr;
        }
        const Grid grid = make_grid();
        all_notes.push_back(
            "Positions in 3D are rounded to " + formatted("%.2g", 1e3 * 0.5 * std::sqrt(3.0) * grid.step) +
            " mm at most, colours to a 254th of their scale. Figures, plots and tables are not rounded so.");
        Json scene = {{"up", std::string(1, heading.up)},
                      {"is_motion", heading.has_motion},
                      {"has_ground", heading.has_ground},
                      {"poster", poster},
                      {"times", Json::array()},
                      {"labels", Json::array()},
                      {"grid", {{"step", grid.step}, {"offsets", Json::array()}}},
                      {"fields", Json::array()},
                      {"layers", Json::array()},
                      {"views", Json::array()},
                      {"topologies", Json::array()},
                      {"meshes", Json::array()}};
        for (size_t f = 0; f < frames.size(); ++f) {
            scene["times"].push_back(rounded(frames[f].time));
            for (const double offset : grid.corners[f]) {
                scene["grid"]["offsets"].push_back(offset);
            }
            if (!frames.front().label.empty()) {
                scene["labels"].push_back(frames[f].label);
            }
        }
        for (const ReportField& field : fields) {
            scene["fields"].push_back({{"name", field.name},
                                       {"unit", field.unit},
                                       {"note", field.note},
                                       {"low", field.low},
                                       {"high", field.high},
                                       {"is_signed", field.is_signed},
                                       {"is_open", field.is_open},
                                       {"stops", stops(field.is_signed)},
                                       {"nothing", "#b4b8bd"}});
        }
        for (const ReportLayer& layer : layers) {
            scene["layers"].push_back({{"name", layer.name},
                                       {"key", layer.key == 0 ? std::string() : std::string(1, layer.key)},
                                       {"color", hex(layer.color)},
                                       {"opacity", layer.opacity},
                                       {"is_shown", layer.is_shown}});
        }
        for (const ReportView& view : views) {
            scene["views"].push_back({{"name", view.name}, {"caption", view.caption}, {"is_shown", view.is_shown}});
        }
        for (size_t mesh = 0; mesh < meshes.size(); ++mesh) {
            scene["meshes"].push_back(mesh_json(mesh, grid, scene["topologies"], buffers));
        }
        return scene;
    }
};

HtmlReport::HtmlReport(Heading heading) : content_(std::make_unique<Content>()) {
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
    content_->fields.push_back(std::move(field));
    return Index(content_->fields.size()) - 1;
}

Index HtmlReport::add_layer(ReportLayer layer) {
    content_->layers.push_back(std::move(layer));
    return Index(content_->layers.size()) - 1;
}

Index HtmlReport::add_view(ReportView view) {
    content_->views.push_back(std::move(view));
    return Index(content_->views.size()) - 1;
}

Index HtmlReport::add_mesh(ReportMesh mesh) {
    require(content_->frames.empty(), "report: a mesh after the first frame");
    require(mesh.similar_to < Index(content_->meshes.size()), "report: a mesh similar to a later one");
    content_->meshes.push_back(std::move(mesh));
    return Index(content_->meshes.size()) - 1;
}

void HtmlReport::add_frame(double time, std::string label) {
    Content::Frame frame;
    frame.positions.resize(content_->meshes.size());
    if (!content_->frames.empty()) {
        frame.positions = content_->frames.back().positions;
    }
    frame.time = time;
    frame.label = std::move(label);
    frame.values.assign(content_->meshes.size(), std::vector<std::vector<std::uint8_t>>(content_->fields.size()));
    content_->frames.push_back(std::move(frame));
}

void HtmlReport::set_positions(Index mesh, const Matrix3X<float>& positions) {
    require(positions.allFinite(), "report: a position is not finite");
    content_->frames.back().positions[size_t(mesh)] = positions;
}

void HtmlReport::set_values(Index mesh, Index field, const Eigen::VectorXf& values) {
    const ReportField& scale = content_->fields[size_t(field)];
    std::vector<std::uint8_t> codes;
    for (const float value : values) {
        const double place = 254.0 * (double(value) - scale.low) / (scale.high - scale.low);
        codes.push_back(std::isnan(value) ? std::uint8_t(no_value)
                                          : static_cast<std::uint8_t>(std::lround(std::clamp(place, 0.0, 254.0))));
    }
    content_->frames.back().values[size_t(mesh)][size_t(field)] = std::move(codes);
}

void HtmlReport::set_poster(Index frame) {
    content_->poster = frame;
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
    Json scene = content_->scene_json(buffers, notes);
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
    const double end = all.empty() ? 1.0 : std::max(1e-9, 1.02 * all[size_t(0.99 * double(all.size() - 1))]);
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
