// SPDX-License-Identifier: MIT
// ctest: --out compare_skinning_test
//
// The embedded body in one pose, skinned in three ways: where they differ, and what each does to the volume.
#include "support/color_scale.hpp"
#include "support/embedded_human.hpp"
#include "support/mesh_picture.hpp"

#include <softtissue/skinning/dual_quaternion.hpp>
#include <softtissue/skinning/inverse.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/skinning/volumetric_smpl.hpp>

#include <CLI/CLI.hpp>

#include <cstdio>
#include <filesystem>

using namespace softtissue;

static double enclosed_volume(const Matrix3X<double>& x, const Triangles& faces) {
    double six_volumes = 0.0;
    for (Index t = 0; t < faces.cols(); ++t) {
        six_volumes += x.col(faces(0, t)).dot(Vector3<double>(x.col(faces(1, t))).cross(Vector3<double>(x.col(faces(2, t)))));
    }
    return six_volumes / 6.0;
}

int main(int argc, char** argv) {
    std::string out = "compare_skinning";
    CLI::App app("Linear blend, dual quaternions and SMPL with pose correctives on the embedded body.");
    app.add_option("--out", out, "folder for the picture")->capture_default_str();
    CLI11_PARSE(app, argc, argv);

    const SmplBody<double> body = examples::embedded_human();
    Pose<double> pose = Pose<double>::rest(body.num_joints());
    pose.rotation_vectors.col(18) = Vector3<double>(0.0, -2.2, 0.0);   // left elbow bent
    pose.rotation_vectors.col(17) = Vector3<double>(1.4, 0.0, 0.6);    // right upper arm twisted and raised
    pose.rotation_vectors.col(4) = Vector3<double>(1.9, 0.0, 0.0);     // left knee bent
    pose.rotation_vectors.col(2) = Vector3<double>(-1.2, 0.0, -0.2);   // right hip flexed
    pose.rotation_vectors.col(3) = Vector3<double>(0.0, 0.5, 0.0);     // trunk turned

    const PosedBody<double> linear = VolumetricSmpl<double>(body, {}, {.pose_correctives = false}).pose(pose);
    const PosedBody<double> dual =
        VolumetricSmpl<double, DualQuaternion<double>>(body, {}, {.pose_correctives = false}).pose(pose);
    const PosedBody<double> smpl = VolumetricSmpl<double>(body).pose(pose);

    const double rest_volume = enclosed_volume(body.template_vertices, body.faces);
    examples::Picture picture(1140, 620);
    const examples::View view(-0.45, 0.1);
    std::printf("                    volume     from linear blend [mm]   smallest singular value\n");
    int column = 0;
    for (const auto& [name, posed] : {std::pair{"linear blend", &linear}, {"dual quaternions", &dual}, {"SMPL", &smpl}}) {
        const VectorX<double> difference = (posed->positions - linear.positions).colwise().norm();
        const BlendReport<double> blends = check_blends<double>(posed->transforms);
        std::printf("%-18s %6.1f %%    mean %5.2f, max %5.1f        %.3f at vertex %d\n", name,
                    100.0 * enclosed_volume(posed->positions, body.faces) / rest_volume, 1e3 * difference.mean(),
                    1e3 * difference.maxCoeff(), blends.smallest_singular_value, int(blends.vertex));
        Matrix3X<float> colors(3, body.num_vertices());
        for (Index v = 0; v < colors.cols(); ++v) {
            colors.col(v) = examples::scale_color(difference(v) / 0.02);
        }
        const Vector3<double> center(0.0, 0.9, 0.0);
        picture.mesh(posed->positions, body.faces, colors, view, center, 300.0, 380 * column, 50, 380, 560);
        picture.text(name, 380 * column + 190, 34, 22, 0.5);
        ++column;
    }
    picture.text("dark red: 20 mm from linear blend skinning", 570, 608, 16, 0.5);
    std::filesystem::create_directories(out);
    picture.write(std::filesystem::path(out) / "compare_skinning.png");
    std::printf("\npicture in %s/compare_skinning.png\n", out.c_str());
}
