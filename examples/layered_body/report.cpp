// SPDX-License-Identifier: MIT
#include "report.hpp"

#include <string>
#include <utility>

namespace examples {

namespace {

void add_table(HtmlReport& page, const Figures& figures) {
    ReportTable table{
        .title = "Methods over all poses",
        .note = figures.has_reference ? "Means over the poses; errors against finite elements" : "Means over the poses",
        .columns = {{.title = "Method"}}};
    if (figures.has_reference) {
        table.columns.push_back({"Position error", "mm", 3, BestValue::low});
        table.columns.push_back({"Gradient error", "10⁻³", 3, BestValue::low});
    }
    table.columns.push_back({"Inverted cells", "", 2, BestValue::low});
    table.columns.push_back({"Volume error", "10⁻³", 2, BestValue::low});
    table.columns.push_back({"Time", "ms", 1, BestValue::low});
    table.columns.push_back({"Not converged", "poses", 0});
    table.columns.push_back({"Muscle crosses skin", "poses", 0});
    table.columns.push_back({"Muscle outside, at most", "mm", 1, BestValue::low});
    for (const MethodFigures& m : figures.methods) {
        ReportRow row{.cells = {m.name}, .is_reference = figures.has_reference && m.name == "fem"};
        if (figures.has_reference) {
            row.cells.emplace_back(1e3 * m.mean(&PoseFigures<Scalar>::position));
            row.cells.emplace_back(1e3 * m.mean(&PoseFigures<Scalar>::gradient));
        }
        row.cells.emplace_back(m.mean(&PoseFigures<Scalar>::inverted));
        row.cells.emplace_back(1e3 * m.mean(&PoseFigures<Scalar>::volume));
        row.cells.emplace_back(m.mean(&PoseFigures<Scalar>::milliseconds));
        row.cells.emplace_back(double(m.not_converged));
        row.cells.emplace_back(double(m.poses_with_intersection));
        row.cells.emplace_back(1e3 * m.largest_protrusion);
        table.rows.push_back(std::move(row));
    }
    page.add_table(std::move(table));
}

template <class T>
void add_chart(HtmlReport& page, const Figures& figures, const char* title, const char* y_title, double scale,
               T PoseFigures<Scalar>::*figure, bool is_log, bool of_reference) {
    LineChart chart{.title = title, .x_title = "pose", .y_title = y_title, .is_log_y = is_log};
    for (const MethodFigures& m : figures.methods) {
        if (m.name == "fem" && !of_reference) {
            continue;
        }
        LineSeries& series = chart.series.emplace_back();
        series.name = m.name;
        for (const double value : m.evaluation.values(figure)) {
            series.y.push_back(scale * value);
            series.x.push_back(double(series.y.size()));
        }
    }
    page.add_chart(chart, ChartKind::over_frames);
}

}  // namespace

void add_figures(HtmlReport& page, const Figures& figures, const Scene& scene) {
    const LayeredBodyReport<Scalar>& rest = scene.layered.report;
    page.add_figure({.name = "Poses", .value = std::to_string(figures.poses)});
    page.add_figure(
        {.name = "Prisms",
         .value = std::to_string(scene.layered.mesh.num_cells()),
         .note = std::to_string(rest.muscle.inverted_cells + rest.fat.inverted_cells) + " inverted at rest"});
    page.add_figure({.name = "Bone", .value = formatted("%.1f", 1e3 * rest.bone_volume), .unit = "l"});
    page.add_figure({.name = "Muscle", .value = formatted("%.1f", 1e3 * rest.muscle.volume), .unit = "l"});
    page.add_figure({.name = "Fat", .value = formatted("%.1f", 1e3 * rest.fat.volume), .unit = "l"});
    page.add_figure({.name = "Embedded vertices",
                     .value = std::to_string(scene.bones.embedding.num_points() + scene.muscles.embedding.num_points()),
                     .note = "of bones and muscles"});
    add_chart(page, figures, "Volume error of each pose", "mean square of the change", 1.0,
              &PoseFigures<Scalar>::volume, true, true);
    if (figures.has_reference) {
        add_chart(page, figures, "Position error of each pose", "mean distance to finite elements [mm]", 1e3,
                  &PoseFigures<Scalar>::position, false, false);
    }
    add_chart(page, figures, "Time a pose", "time [ms]", 1.0, &PoseFigures<Scalar>::milliseconds, true, true);
    add_table(page, figures);
    if (figures.has_reference) {
        page.add_note("Poses with several equilibria, where another start ends more than " +
                      formatted("%.1f mm", 1e3 * start_tolerance) +
                      " away on average: " + std::to_string(figures.start_dependent_poses.size()) + ".");
    }
}

}  // namespace examples
