// SPDX-License-Identifier: MIT
#include "report.hpp"

#include "../support/html_report.hpp"

namespace examples {

namespace {

void add_bodies(HtmlReport& report, const Scene& scene, const AvatarResults& results) {
    const Index displacement = report.add_field({.name = "displacement",
                                                 .unit = "mm",
                                                 .note = "Distance from the skinned body",
                                                 .low = 0.0,
                                                 .high = 1e3 * results.displacement_scale});
    const Index layer = report.add_layer({.name = "Skin", .key = 's', .color = {0.80F, 0.78F, 0.75F}});
    const Index skinned =
        report.add_mesh({.view = report.add_view({.name = "Skinned"}), .layer = layer, .triangles = scene.body.faces});
    const Index simulated = report.add_mesh({.view = report.add_view({.name = "With soft tissue"}),
                                             .layer = layer,
                                             .triangles = scene.body.faces,
                                             .similar_to = skinned});
    const Index stride = report.choose_stride(Index(results.frames.size()), 2 * scene.body.num_vertices());
    double largest = -1.0;
    for (size_t k = 0; k < results.frames.size(); k += size_t(stride)) {
        const AvatarFrame& frame = results.frames[k];
        report.add_frame(frame.time);
        report.set_positions(skinned, frame.skinned);
        report.set_positions(simulated, frame.simulated);
        report.set_values(simulated, displacement, 1e3F * frame.displacement());
        if (frame.largest > largest) {
            largest = frame.largest;
            report.set_poster(Index(k) / stride);
        }
    }
}

/// A chart over the time of the motion.
template <class Record>
LineChart chart(const char* title, const char* y_title, const std::vector<Record>& records,
                const std::vector<std::pair<const char*, double (*)(const Record&)>>& lines, bool is_log = false) {
    LineChart result{.title = title, .x_title = "time [s]", .y_title = y_title, .is_log_y = is_log};
    for (const auto& [name, value] : lines) {
        LineSeries& series = result.series.emplace_back();
        series.name = name;
        for (const Record& record : records) {
            series.x.push_back(record.time);
            series.y.push_back(value(record));
        }
    }
    return result;
}

void add_charts(HtmlReport& report, const AvatarResults& results) {
    using Displacement = DisplacementRecord;
    using Step = StepRecord;
    const ChartKind kind = ChartKind::over_frames;
    report.add_chart(
        chart<Displacement>("How far the tissue is from the skinned body", "displacement [mm]", results.displacements,
                            {{"largest", [](const Displacement& d) { return 1e3 * d.largest; }},
                             {"mean", [](const Displacement& d) { return 1e3 * d.mean; }}}),
        kind);
    report.add_chart(
        chart<Step>("What a step minimises: elastic energy and inertia", "energy [J]", results.steps.records,
                    {{"at the end of the step", [](const Step& s) { return s.energy; }}}),
        kind);
    report.add_chart(chart<Step>("Iterations a step", "count", results.steps.records,
                                 {{"quasi-Newton steps", [](const Step& s) { return double(s.quasi_newton_steps); }},
                                  {"Newton iterations", [](const Step& s) { return double(s.newton_iterations); }}}),
                     kind);
    report.add_chart(chart<Step>("Time a step", "time [ms]", results.steps.records,
                                 {{"solve and count of inversions", [](const Step& s) { return s.milliseconds; }}}),
                     kind);
}

}  // namespace

bool write_report(const std::filesystem::path& path, const Settings& settings, const Scene& scene,
                  const AvatarResults& results) {
    if (results.frames.empty()) {
        return false;
    }
    HtmlReport report({.program = "soft_tissue_avatar",
                       .title = "Soft tissue on a body in motion",
                       .summary = (settings.body.empty() ? std::string("The embedded body") : settings.body) +
                                  ": skinned, and with simulated soft tissue. Material " + settings.material +
                                  ", strain " + settings.frame + ", elements " + settings.element + ", time step " +
                                  formatted("%.3g ms.", 1e3 * settings.time_step)});
    add_bodies(report, scene, results);
    report.add_figure(
        {.name = "Largest displacement", .value = formatted("%.1f", 1e3 * results.largest_displacement), .unit = "mm"});
    report.add_figure(
        {.name = "Time a step", .value = formatted("%.1f", results.steps.milliseconds_mean()), .unit = "ms"});
    report.add_figure({.name = "Time steps",
                       .value = std::to_string(results.steps.count),
                       .note = std::to_string(results.steps.not_converged) + " not converged"});
    report.add_figure({.name = "Cells",
                       .value = std::to_string(results.cells),
                       .note = std::to_string(results.free_vertices) + " free vertices"});
    report.add_figure({.name = "Inverted cells, ever", .value = std::to_string(results.steps.inverted_cells_max)});
    report.add_figure({.name = "Still pose",
                       .value = formatted("%.2g", 1e3 * results.static_unposed.error),
                       .unit = "mm",
                       .note = formatted("world strain: %.2g mm", 1e3 * results.static_world.error)});
    add_charts(report, results);
    ReportTable table{.title = "All figures", .columns = {{.title = "Figure"}, {.title = "Value"}}};
    for (const auto& [name, value] : result_rows(results)) {
        table.rows.push_back({.cells = {name, value}});
    }
    report.add_table(std::move(table));
    if (results.interrupted) {
        report.add_note("The simulation was interrupted: these are its results until then.");
    }
    report.add_note(
        "The still pose is the strongest one of the motion: tissue at rest in it, its distance from the skinned body. "
        "With strain in unposed space there is none.");
    return report.write(path);
}

}  // namespace examples
