// SPDX-License-Identifier: MIT
#include "evaluation_report.hpp"

#include "../support/html_report.hpp"
#include "evaluation_tables.hpp"

#include <limits>
#include <utility>

namespace examples {

namespace {

/// A view for every method; a frame for every split.
void add_bodies(HtmlReport& page, const std::vector<SplitResult>& splits, const ErrorSurface& surface,
                const std::vector<std::vector<ErrorMap>>& maps) {
    if (maps.empty() || maps.front().empty()) {
        return;
    }
    std::vector<ErrorMap> all;
    for (const std::vector<ErrorMap>& of_split : maps) {
        all.insert(all.end(), of_split.begin(), of_split.end());
    }
    const Index error = page.add_field({.name = "error",
                                        .unit = "mm",
                                        .note = "Mean distance of skin and muscle wrap to the reference",
                                        .low = 0.0,
                                        .high = 1e3 * error_scale(all),
                                        .is_open = true});
    const Index layer = page.add_layer({.name = "Skin", .key = 's'});
    std::vector<Index> meshes;
    for (const ErrorMap& map : maps.front()) {
        const Index view = page.add_view({.name = map.name, .is_shown = meshes.size() < 3});
        meshes.push_back(page.add_mesh({.view = view,
                                        .layer = layer,
                                        .triangles = surface.triangles,
                                        .similar_to = meshes.empty() ? -1 : meshes.front()}));
    }
    const Matrix3X<float> positions = surface.positions.cast<float>();
    for (size_t split = 0; split < splits.size(); ++split) {
        page.add_frame(double(split), to_string(splits[split].split));
        for (size_t k = 0; k < meshes.size(); ++k) {
            Eigen::VectorXf values =
                Eigen::VectorXf::Constant(positions.cols(), std::numeric_limits<float>::quiet_NaN());
            for (size_t c = 0; c < surface.column_vertices.size(); ++c) {
                values(surface.column_vertices[c]) = float(1e3 * maps[split][k].column_errors(Index(c)));
            }
            page.set_positions(meshes[k], positions);
            page.set_values(meshes[k], error, values);
        }
    }
}

void add_histograms(HtmlReport& page, const SplitResult& split) {
    const auto add = [&](const char* title, const char* x_title, double scale, auto figure) {
        std::vector<LineSeries> values;
        for (const MethodResult& method : split.methods) {
            if (method.name != "fem") {
                LineSeries& series = values.emplace_back();
                series.name = method.name;
                for (const double value : method.evaluation.values(figure)) {
                    series.y.push_back(scale * value);
                }
            }
        }
        if (!values.empty()) {
            page.add_chart(
                histogram_chart(title + std::string(", split '") + to_string(split.split) + "'", x_title, values),
                ChartKind::histogram);
        }
    };
    add("Position errors of the poses", "E_pos [mm]", 1e3, &PoseFigures<double>::position);
    add("Gradient errors of the poses", "E_grad [1e-3]", 1e3, &PoseFigures<double>::gradient);
}

}  // namespace

bool write_evaluation_report(const std::filesystem::path& path, const EvaluationSetup& setup,
                             const std::vector<SplitResult>& splits, const ErrorSurface& surface,
                             const std::vector<std::vector<ErrorMap>>& maps) {
    HtmlReport page({.program = "ndg evaluate",
                     .title = "Trained networks beside classical methods",
                     .summary = "Errors against the quasi-static reference on samples that no training has seen",
                     .has_motion = false});
    add_bodies(page, splits, surface, maps);
    for (const SplitResult& split : splits) {
        add_histograms(page, split);
        page.add_figure({.name = std::string("Samples, ") + to_string(split.split),
                         .value = std::to_string(split.samples.size()),
                         .note = std::to_string(split.num_bodies) + " bodies"});
    }
    for (const EvaluatedModel& model : setup.models) {
        for (const SplitResult& split : splits) {
            const MethodResult* const result = split.find(model.name);
            page.add_figure(
                {.name = "E_pos of " + model.name,
                 .value = formatted("%.2f", 1e3 * result->evaluation.summary(&PoseFigures<double>::position).mean),
                 .unit = "mm",
                 .note = std::string("split ") + to_string(split.split)});
        }
    }
    for (ReportTable& table : report_tables(setup, splits)) {
        page.add_table(std::move(table));
    }
    page.add_note(
        "E_pos: mean distance of the free vertices to the reference; E_grad: mean squared difference of deformation "
        "gradients; E_inv: inverted cells; E_vol: mean square of the relative change of volume.");
    page.add_note(
        "The 3D view shows the mean body at rest, coloured by the mean error of each column of vertices over all "
        "samples. "
        "The last bin of a histogram holds all that lies above it.");
    return page.write(path);
}

}  // namespace examples
