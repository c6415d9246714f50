// SPDX-License-Identifier: MIT
// ctest: --out compare_skinning_test
//
// The embedded body in one pose, skinned in three ways: where they differ, and what each does to the volume.
#include "support/color_scale.hpp"
#include "support/embedded_human.hpp"
#include "support/guarded.hpp"
#include "support/html_report.hpp"
#include "support/mesh_picture.hpp"
#include "support/result_folder.hpp"

#include <softtissue/skinning/dual_quaternion.hpp>
#include <softtissue/skinning/inverse.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/skinning/volumetric_smpl.hpp>

#include <CLI/CLI.hpp>

#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

using namespace softtissue;

static double enclosed_volume(const Matrix3X<double>& x, const Triangles& faces) {
    double six_volumes = 0.0;
    for (Index t = 0; t < faces.cols(); ++t) {
        six_volumes += x.col(faces(0, t)).dot(Vector3<double>(x.col(faces(1, t))).cross(Vector3<double>(x.col(faces(2, t)))));
    }
    return six_volumes / 6.0;
}

/// Bends of elbow, arm, knee and hip, from none at 0 to all at 1.
static Pose<double> bent(Index num_joints, double part) {
    Pose<double> pose = Pose<double>::rest(num_joints);
    pose.rotation_vectors.col(18) = part * Vector3<double>(0.0, -2.2, 0.0);  // left elbow bent
    pose.rotation_vectors.col(17) = part * Vector3<double>(1.4, 0.0, 0.6);   // right upper arm twisted and raised
    pose.rotation_vectors.col(4) = part * Vector3<double>(1.9, 0.0, 0.0);    // left knee bent
    pose.rotation_vectors.col(2) = part * Vector3<double>(-1.2, 0.0, -0.2);  // right hip flexed
    pose.rotation_vectors.col(3) = part * Vector3<double>(0.0, 0.5, 0.0);    // trunk turned
    return pose;
}

/// One policy in the pose.
struct SkinnedPose {
    std::string name;
    PosedBody<double> posed;
    VectorX<double> difference = {};  // from linear blend [m]
    double volume = 0.0;         // of that at rest
};

/// All of the difference that the scales show [m].
constexpr double largest_difference = 0.02;

static int run(const std::string& out) {
    const examples::ResultFolder results_alone(out);
    const SmplBody<double> body = examples::embedded_human();
    const VolumetricSmpl<double> linear(body, {}, {.pose_correctives = false});
    const VolumetricSmpl<double, DualQuaternion<double>> dual(body, {}, {.pose_correctives = false});
    const VolumetricSmpl<double> smpl(body);
    const double rest_volume = enclosed_volume(body.template_vertices, body.faces);
    const auto skin = [&](double part) {
        const Pose<double> pose = bent(body.num_joints(), part);
        std::vector<SkinnedPose> result{{.name = "linear blend", .posed = linear.pose(pose)},
                                        {.name = "dual quaternions", .posed = dual.pose(pose)},
                                        {.name = "SMPL", .posed = smpl.pose(pose)}};
        for (SkinnedPose& each : result) {
            each.difference = (each.posed.positions - result.front().posed.positions).colwise().norm();
            each.volume = enclosed_volume(each.posed.positions, body.faces) / rest_volume;
        }
        return result;
    };

    examples::HtmlReport page({.program = "compare_skinning",
                               .title = "Three ways to skin a body",
                               .summary = "The embedded body, from rest into a strong pose: where the skins differ, and what "
                                          "each does to the volume",
                               .has_motion = false});
    const Index field = page.add_field({.name = "difference",
                                        .unit = "mm",
                                        .note = "Distance from linear blend skinning",
                                        .low = 0.0,
                                        .high = 1e3 * largest_difference,
                                        .is_open = true});
    const Index layer = page.add_layer({.name = "Skin", .key = 's', .color = {0.80F, 0.78F, 0.75F}});
    examples::LineChart volumes{.title = "Volume under the skin", .x_title = "part of the pose", .y_title = "of that at rest [%]"};
    examples::LineChart differences{.title = "Difference from linear blend skinning", .x_title = "part of the pose", .y_title = "mean over the vertices [mm]"};
    constexpr int num_parts = 24;
    for (int k = 0; k <= num_parts; ++k) {
        const double part = double(k) / num_parts;
        const std::vector<SkinnedPose> skins = skin(part);
        for (size_t m = 0; m < skins.size() && k == 0; ++m) {
            page.add_mesh({.view = page.add_view({.name = skins[m].name}),
                           .layer = layer,
                           .triangles = body.faces,
                           .similar_to = m == 0 ? -1 : 0});
            volumes.series.push_back({.name = skins[m].name});
            differences.series.push_back({.name = skins[m].name});
        }
        page.add_frame(part, examples::formatted("%.0f %%", 100.0 * part));
        for (size_t m = 0; m < skins.size(); ++m) {
            page.set_positions(Index(m), skins[m].posed.positions.cast<float>());
            page.set_values(Index(m), field, (1e3 * skins[m].difference).cast<float>());
            volumes.series[m].x.push_back(part);
            volumes.series[m].y.push_back(100.0 * skins[m].volume);
            differences.series[m].x.push_back(part);
            differences.series[m].y.push_back(1e3 * skins[m].difference.mean());
        }
    }
    page.set_poster(num_parts);
    differences.series.erase(differences.series.begin());
    page.add_chart(volumes, examples::ChartKind::over_frames);
    page.add_chart(differences, examples::ChartKind::over_frames);

    examples::Picture picture(1140, 620);
    const examples::View view(-0.45, 0.1);
    examples::ReportTable table{.title = "In the whole pose",
                                .columns = {{"Skinning"},
                                            {"Volume", "% of that at rest", 1},
                                            {"Mean difference", "mm", 2},
                                            {"Largest difference", "mm", 1},
                                            {"Smallest singular value", "", 3}}};
    std::printf("                    volume     from linear blend [mm]   smallest singular value\n");
    int column = 0;
    for (const SkinnedPose& each : skin(1.0)) {
        const BlendReport<double> blends = check_blends<double>(each.posed.transforms);
        std::printf("%-18s %6.1f %%    mean %5.2f, max %5.1f        %.3f at vertex %d\n", each.name.c_str(), 100.0 * each.volume,
                    1e3 * each.difference.mean(), 1e3 * each.difference.maxCoeff(), blends.smallest_singular_value,
                    int(blends.vertex));
        table.rows.push_back({.cells = {each.name, 100.0 * each.volume, 1e3 * each.difference.mean(),
                                        1e3 * each.difference.maxCoeff(), blends.smallest_singular_value}});
        Matrix3X<float> colors(3, body.num_vertices());
        for (Index v = 0; v < colors.cols(); ++v) {
            colors.col(v) = examples::scale_color(each.difference(v) / largest_difference);
        }
        const auto& x = each.posed.positions;
        const Vector3<double> center = 0.5 * (x.rowwise().minCoeff() + x.rowwise().maxCoeff());
        picture.mesh(x, body.faces, colors, view, center, 300.0, 380 * column, 50, 380, 560);
        picture.text(each.name, 380 * column + 190, 34, 22, 0.5);
        ++column;
    }
    page.add_table(std::move(table));
    page.add_note("The smallest singular value is that of the blended transforms: where it is near zero, skinning squeezes the "
                  "surface flat and cannot be undone.");
    picture.text("dark red: 20 mm from linear blend skinning", 570, 608, 16, 0.5);
    const std::filesystem::path folder(out);
    picture.write(folder / "compare_skinning.png");
    std::printf("\npicture in %s/compare_skinning.png\n", out.c_str());
    if (page.write(folder / "report.html")) {
        std::printf("report in %s/report.html\n", out.c_str());
    }
    return 0;
}

int main(int argc, char** argv) {
    std::string out = "compare_skinning";
    CLI::App app("Linear blend, dual quaternions and SMPL with pose correctives on the embedded body.");
    app.add_option("--out", out, "folder for picture and report")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    return examples::guarded("compare_skinning", [&] { return run(out); });
}
