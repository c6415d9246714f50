// SPDX-License-Identifier: MIT
// ctest: --out material_response_test --columns 10
//
// A patch of skin, pulled off its bone by hanging weights from 20 g to 2 kg (Romero et al. 2020, fig. 5): Fung-orthotropic skin against
// stable neo-Hookean flesh of the same stiffness under small loads.
#include "support/guarded.hpp"
#include "support/html_report.hpp"
#include "support/mesh_picture.hpp"
#include "support/result_folder.hpp"

#include <softtissue/element/prism6.hpp>
#include <softtissue/energy/dead_load.hpp>
#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/fung_orthotropic.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/mesh/prism_layers.hpp>
#include <softtissue/solver/direct_solver.hpp>
#include <softtissue/solver/newton.hpp>
#include <softtissue/solver/objective.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

using namespace softtissue;

namespace {

constexpr double side = 0.12, thickness = 0.025, disc_radius = 0.03, gravity = 9.81;
constexpr double poisson_ratio = 0.2;

/// A square of skin, `columns` boxes along each side, on a bone that does not move; a weight hangs from a disc in its middle.
struct Patch {
    PrismLayers layers;
    Triangles triangles;  // of columns
    CellMesh<Prism6, double> mesh;
    std::vector<std::int32_t> bone;
    VectorX<double> share;  // of the weight, per vertex

    explicit Patch(int columns) {
        const auto column = [columns](int x, int y) { return std::int32_t(x * (columns + 1) + y); };
        layers = {Index(columns + 1) * (columns + 1), 4};
        triangles.resize(3, 2 * columns * columns);
        Index t = 0;
        for (int x = 0; x < columns; ++x) {
            for (int y = 0; y < columns; ++y) {
                triangles.col(t++) << column(x, y), column(x + 1, y), column(x + 1, y + 1);
                triangles.col(t++) << column(x, y), column(x + 1, y + 1), column(x, y + 1);
            }
        }
        mesh = {Matrix3X<double>(3, layers.num_vertices()), layers.prisms(triangles)};
        share.setZero(layers.num_vertices());
        for (Index c = 0; c < layers.num_columns; ++c) {
            const double x = side * (double(c / (columns + 1)) / columns - 0.5);
            const double y = side * (double(c % (columns + 1)) / columns - 0.5);
            for (Index level = 0; level < layers.num_levels(); ++level) {
                mesh.rest_positions.col(layers.vertex(c, level)) << x, y, thickness * double(level) / double(layers.num_layers);
            }
            bone.push_back(std::int32_t(layers.vertex(c, 0)));
            share(layers.vertex(c, layers.num_layers)) = std::hypot(x, y) <= disc_radius ? 1.0 : 0.0;
        }
        share /= share.sum();
    }

    /// The skin's own vertices, for pictures.
    Matrix3X<double> skin(const Matrix3X<double>& x) const { return layers.level_positions(x, layers.num_layers); }

    /// How far the disc is pulled out [m] for each of the `weights` [kg], ascending; every solve starts from the last one.
    /// `shapes`, if it is there, receives the displaced vertices.
    template <class Material>
    std::vector<double> pulls(const Material& material, const std::vector<double>& weights,
                              std::vector<Matrix3X<double>>* shapes = nullptr) const {
        ElasticEnergy<Prism6, UniformField<Material>> elastic(mesh, {material});
        DeadLoad<double> load(Matrix3X<double>::Zero(3, mesh.num_vertices()));
        const SequentialExecutor executor;
        Objective objective(PrescribedVertices(mesh.num_vertices(), bone), executor, elastic, load);
        DirectSolver<double> linear_solver;
        Matrix3X<double> d = Matrix3X<double>::Zero(3, mesh.num_vertices());
        std::vector<double> result;
        for (const double weight : weights) {
            Matrix3X<double> forces = Matrix3X<double>::Zero(3, mesh.num_vertices());
            forces.row(2) = weight * gravity * share.transpose();
            load.set_forces(forces);
            const SolveReport<double> report = minimise(objective, linear_solver, d, {.max_iterations = 200});
            require(report.succeeded(), "patch with ", weight, " kg: ", to_string(report.status));
            result.push_back(d.row(2).dot(share));
            if (shapes != nullptr) {
                shapes->push_back(mesh.rest_positions + d);
            }
        }
        return result;
    }
};

void plot(const std::filesystem::path& path, const std::vector<double>& weights, const std::vector<double>& fung,
          const std::vector<double>& flesh) {
    constexpr double left = 80, top = 60, width = 620, height = 380;
    examples::Picture picture(760, 520);
    cairo_t* const context = picture.context();
    const double farthest = 5.0 * std::ceil(1e3 * std::max(fung.back(), flesh.back()) / 5.0);
    const auto draw = [&](const std::vector<double>& pulls, double red, double green, double blue) {
        cairo_set_source_rgb(context, red, green, blue);
        cairo_set_line_width(context, 3.0);
        cairo_move_to(context, left, top + height);
        for (size_t i = 0; i < weights.size(); ++i) {
            cairo_line_to(context, left + width * weights[i] / weights.back(), top + height * (1.0 - 1e3 * pulls[i] / farthest));
        }
        cairo_stroke(context);
    };
    for (int tick = 0; tick <= 4; ++tick) {
        char label[32];
        std::snprintf(label, sizeof label, "%.3g", farthest * tick / 4.0);
        picture.text(label, left - 10, top + height * (1.0 - tick / 4.0) + 5, 15, 1.0);
        std::snprintf(label, sizeof label, "%.3g", weights.back() * tick / 4.0);
        picture.text(label, left + width * tick / 4.0, top + height + 24, 15, 0.5);
        picture.rectangle(left, top + height * (1.0 - tick / 4.0), width, 1, {0.88F, 0.88F, 0.88F});
    }
    draw(flesh, 0.20, 0.45, 0.75);
    draw(fung, 0.80, 0.20, 0.15);
    picture.text("how far the weight pulls [mm]", left - 60, top - 24, 17);
    picture.text("weight [kg]", left + width / 2, top + height + 52, 17, 0.5);
    picture.rectangle(left + 20, top + 14, 30, 4, {0.20F, 0.45F, 0.75F});
    picture.text("stable neo-Hookean, same stiffness under small loads", left + 60, top + 22, 15);
    picture.rectangle(left + 20, top + 40, 30, 4, {0.80F, 0.20F, 0.15F});
    picture.text("Fung-orthotropic", left + 60, top + 48, 15);
    picture.write(path);
}

/// One material under all weights.
struct Response {
    std::string name;
    std::vector<double> pulls;  // [m]
    std::vector<Matrix3X<double>> shapes;
};

bool write_report(const std::filesystem::path& path, const Patch& patch, const std::vector<double>& weights,
                  const std::vector<Response>& responses, double fitted_modulus) {
    examples::HtmlReport page({.program = "material_response",
                               .title = "A weight hangs from a patch of skin",
                               .summary = "Fung-orthotropic skin beside stable neo-Hookean flesh of the same stiffness under "
                                          "small loads: skin stiffens, flesh does not",
                               .has_motion = false,
                               .has_ground = false,
                               .up = 'z'});
    const double farthest = std::max(responses[0].pulls.back(), responses[1].pulls.back());
    const Index field = page.add_field({.name = "displacement",
                                        .unit = "mm",
                                        .note = "Distance from the place at rest",
                                        .low = 0.0,
                                        .high = 5.0 * std::ceil(1e3 * farthest / 5.0),
                                        .is_open = true});
    const Index layer = page.add_layer({.name = "Skin", .key = 's', .color = {0.80F, 0.78F, 0.75F}});
    const Index bone = page.add_layer({.name = "Bone", .key = 'b', .color = {0.90F, 0.86F, 0.74F}});
    examples::LineChart chart{.title = "How far the weight pulls", .x_title = "weight [kg]", .y_title = "pull of the disc [mm]"};
    examples::ReportTable table{.title = "Pull of the disc", .columns = {{"Weight", "kg", 2}}};
    std::vector<Index> skins, bones;
    for (const Response& response : responses) {
        const Index view = page.add_view({.name = response.name});
        skins.push_back(page.add_mesh({.view = view, .layer = layer, .triangles = patch.triangles}));
        bones.push_back(page.add_mesh({.view = view, .layer = bone, .triangles = patch.triangles}));
        examples::LineSeries& series = chart.series.emplace_back();
        series.name = response.name;
        table.columns.push_back({response.name, "mm", 2});
    }
    for (size_t i = 0; i < weights.size(); ++i) {
        page.add_frame(weights[i], examples::formatted("%.2f kg", weights[i]));
        examples::ReportRow row{.cells = {weights[i]}};
        for (size_t k = 0; k < responses.size(); ++k) {
            const Matrix3X<double>& x = responses[k].shapes[i];
            page.set_positions(skins[k], patch.skin(x).cast<float>());
            page.set_positions(bones[k], Matrix3X<double>(patch.layers.level_positions(x, 0)).cast<float>());
            page.set_values(skins[k], field,
                            (1e3 * (patch.skin(x) - patch.skin(patch.mesh.rest_positions)).colwise().norm()).cast<float>());
            chart.series[k].x.push_back(weights[i]);
            chart.series[k].y.push_back(1e3 * responses[k].pulls[i]);
            row.cells.emplace_back(1e3 * responses[k].pulls[i]);
        }
        table.rows.push_back(std::move(row));
    }
    page.set_poster(Index(weights.size()) - 1);
    page.add_figure({.name = "Patch",
                     .value = examples::formatted("%.0f", 1e3 * side) + examples::formatted(" × %.0f", 1e3 * side),
                     .unit = "mm",
                     .note = examples::formatted("%.0f mm thick", 1e3 * thickness)});
    page.add_figure({.name = "Prisms", .value = std::to_string(patch.mesh.num_cells())});
    page.add_figure({.name = "Young's modulus of the flesh",
                     .value = examples::formatted("%.0f", fitted_modulus),
                     .unit = "Pa",
                     .note = "fits the skin under small loads"});
    page.add_chart(chart, examples::ChartKind::over_frames);
    page.add_table(std::move(table));
    return page.write(path);
}

int run(const std::string& out, int columns) {
    const examples::ResultFolder results_alone(out);
    const Patch patch(columns);
    Matrix3<double> basis;  // first column: the skin's normal, here z
    basis << 0, 1, 0, 0, 0, 1, 1, 0, 0;
    const FungOrthotropic<double> fung(
        {.normal_modulus = 5e3, .tangential_modulus = 10e3, .poisson_ratio = poisson_ratio, .exponent = 4.0}, basis);

    // In the linear range the pull is inversely proportional to the modulus: one trial fits it.
    const std::vector<double> small{1e-4};
    const double trial_modulus = 5e3;
    const auto flesh_of = [](double E) { return StableNeoHookean<double>::from_young_poisson({E, poisson_ratio}); };
    const double fitted_modulus =
        trial_modulus * patch.pulls(flesh_of(trial_modulus), small)[0] / patch.pulls(fung, small)[0];

    std::vector<double> weights{0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0};
    std::vector<Response> responses{{"Fung-orthotropic", {}, {}}, {"Stable neo-Hookean", {}, {}}};
    responses[0].pulls = patch.pulls(fung, weights, &responses[0].shapes);
    responses[1].pulls = patch.pulls(flesh_of(fitted_modulus), weights, &responses[1].shapes);
    const std::vector<double>& fung_pulls = responses[0].pulls;
    const std::vector<double>& flesh_pulls = responses[1].pulls;
    std::printf("skin patch of %.0f x %.0f mm, %.0f mm thick, %d prisms; neo-Hookean E = %.0f Pa fits the small-load stiffness\n\n"
                "weight [kg]   Fung [mm]   neo-Hookean [mm]\n",
                1e3 * side, 1e3 * side, 1e3 * thickness, int(patch.mesh.num_cells()), fitted_modulus);
    for (size_t i = 0; i < weights.size(); ++i) {
        std::printf("%8.2f  %11.2f  %14.2f\n", weights[i], 1e3 * fung_pulls[i], 1e3 * flesh_pulls[i]);
    }
    std::printf("\nfrom 0.5 to 2 kg, four times the weight: Fung %.2f times as far, neo-Hookean %.2f times\n",
                fung_pulls.back() / fung_pulls[5], flesh_pulls.back() / flesh_pulls[5]);
    plot(std::filesystem::path(out) / "material_response.png", weights, fung_pulls, flesh_pulls);
    std::printf("plot in %s/material_response.png\n", out.c_str());
    if (write_report(std::filesystem::path(out) / "report.html", patch, weights, responses, fitted_modulus)) {
        std::printf("report in %s/report.html\n", out.c_str());
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    std::string out = "material_response";
    int columns = 20;
    CLI::App app("Skin pulled by a weight: Fung-orthotropic against stable neo-Hookean (Romero et al. 2020, fig. 5).");
    app.add_option("--out", out, "folder for plot and report")->capture_default_str();
    app.add_option("--columns", columns, "boxes along a side of the patch")->check(CLI::Range(4, 60))->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    return examples::guarded("material_response", [&] { return run(out, columns); });
}
