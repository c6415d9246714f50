// SPDX-License-Identifier: MIT
#include "report_scene.hpp"

#include "color_scale.hpp"
#include "packed_numbers.hpp"

#include <softtissue/core/error.hpp>

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
using softtissue::require;

constexpr double grid_steps = 65535.0;  // positions are numbers of 16 bits
constexpr unsigned no_value = 255;      // values are codes from 0 to 254

std::string hex(const Eigen::Vector3f& color) {
    std::array<char, 8> text{};
    const auto byte = [&](int k) { return unsigned(std::lround(255.0F * std::clamp(color(k), 0.0F, 1.0F))); };
    std::snprintf(text.data(), text.size(), "#%02x%02x%02x", byte(0), byte(1), byte(2));
    return text.data();
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

/// Of all meshes and frames one grid: a corner per frame, one step.
struct Grid {
    std::vector<std::array<double, 3>> corners;
    double step = 0.0;

    std::uint16_t place(size_t frame, int axis, float x) const {
        const double place = std::round((double(x) - corners[frame][size_t(axis)]) / step);
        return static_cast<std::uint16_t>(std::clamp(place, 0.0, grid_steps));
    }
};

Grid make_grid(const std::vector<ReportScene::Frame>& frames) {
    Grid grid;
    double size = 1e-9;
    for (const ReportScene::Frame& frame : frames) {
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
std::vector<std::vector<std::uint16_t>> places(const ReportScene& scene, const Grid& grid, size_t mesh) {
    std::vector<std::vector<std::uint16_t>> rows;
    for (size_t f = 0; f < scene.frames.size(); ++f) {
        const Matrix3X<float>& positions = scene.frames[f].positions[mesh];
        for (int axis = 0; axis < 3; ++axis) {
            std::vector<std::uint16_t>& row = rows.emplace_back();
            for (Index v = 0; v < positions.cols(); ++v) {
                row.push_back(grid.place(f, axis, positions(axis, v)));
            }
        }
    }
    return rows;
}

std::array<double, 3> mean(const Matrix3X<float>& positions) {
    const Eigen::Vector3d sum = positions.cast<double>().rowwise().sum();
    const double count = double(positions.cols());
    return {sum(0) / count, sum(1) / count, sum(2) / count};
}

Json mesh_json(const ReportScene& scene, size_t index, const Grid& grid, Json& topologies, Json& buffers) {
    const std::vector<ReportMesh>& meshes = scene.meshes;
    const std::vector<ReportScene::Frame>& frames = scene.frames;
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
    std::vector<std::vector<std::uint16_t>> rows = places(scene, grid, index);
    if (mesh.similar_to >= 0) {
        const std::vector<std::vector<std::uint16_t>> others = places(scene, grid, size_t(mesh.similar_to));
        for (size_t r = 0; r < rows.size(); ++r) {
            for (size_t i = 0; i < rows[r].size(); ++i) {
                rows[r][i] = static_cast<std::uint16_t>(rows[r][i] - others[r][i]);
            }
        }
    }
    Json values = Json::array();
    for (size_t field = 0; field < scene.fields.size(); ++field) {
        std::vector<std::vector<std::uint8_t>> codes;
        bool has_values = false;
        for (const ReportScene::Frame& frame : frames) {
            codes.push_back(frame.values[index][field]);
            has_values |= !codes.back().empty();
            codes.back().resize(size_t(frame.positions[index].cols()), std::uint8_t(no_value));
        }
        if (has_values) {
            values.push_back({{"field", field}, {"buffer", add_buffer(packed_rows(codes, 1))}});
        }
    }
    const ReportLayer& layer = scene.layers[size_t(mesh.layer)];
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
            {"mean_of_last_frame", mean(frames.back().positions[index])}};
}

}  // namespace

std::vector<std::uint8_t> value_codes(const ReportField& field, const Eigen::VectorXf& values) {
    std::vector<std::uint8_t> codes;
    for (const float value : values) {
        const double place = 254.0 * (double(value) - field.low) / (field.high - field.low);
        codes.push_back(std::isnan(value) ? std::uint8_t(no_value)
                                          : static_cast<std::uint8_t>(std::lround(std::clamp(place, 0.0, 254.0))));
    }
    return codes;
}

Json scene_json(const ReportScene& scene, Json& buffers) {
    if (scene.meshes.empty() || scene.frames.empty()) {
        return nullptr;
    }
    const Grid grid = make_grid(scene.frames);
    Json json = {{"up", std::string(1, scene.up)},
                 {"is_motion", scene.is_motion},
                 {"has_ground", scene.has_ground},
                 {"poster", scene.poster},
                 {"times", Json::array()},
                 {"labels", Json::array()},
                 {"grid", {{"step", grid.step}, {"offsets", Json::array()}}},
                 {"fields", Json::array()},
                 {"layers", Json::array()},
                 {"views", Json::array()},
                 {"topologies", Json::array()},
                 {"meshes", Json::array()}};
    for (size_t f = 0; f < scene.frames.size(); ++f) {
        json["times"].push_back(scene.frames[f].time);
        for (const double offset : grid.corners[f]) {
            json["grid"]["offsets"].push_back(offset);
        }
        if (!scene.frames.front().label.empty()) {
            json["labels"].push_back(scene.frames[f].label);
        }
    }
    for (const ReportField& field : scene.fields) {
        json["fields"].push_back({{"name", field.name},
                                  {"unit", field.unit},
                                  {"note", field.note},
                                  {"low", field.low},
                                  {"high", field.high},
                                  {"is_signed", field.is_signed},
                                  {"is_open", field.is_open},
                                  {"stops", stops(field.is_signed)},
                                  {"nothing", "#b4b8bd"}});
    }
    for (const ReportLayer& layer : scene.layers) {
        json["layers"].push_back({{"name", layer.name},
                                  {"key", layer.key == 0 ? std::string() : std::string(1, layer.key)},
                                  {"color", hex(layer.color)},
                                  {"opacity", layer.opacity},
                                  {"is_shown", layer.is_shown}});
    }
    for (const ReportView& view : scene.views) {
        json["views"].push_back({{"name", view.name}, {"caption", view.caption}, {"is_shown", view.is_shown}});
    }
    for (size_t mesh = 0; mesh < scene.meshes.size(); ++mesh) {
        json["meshes"].push_back(mesh_json(scene, mesh, grid, json["topologies"], buffers));
    }
    return json;
}

}  // namespace examples
