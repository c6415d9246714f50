// SPDX-License-Identifier: MIT
#include "layered_pictures.hpp"

#include "color_scale.hpp"
#include "mesh_picture.hpp"

#include <softtissue/io/gltf.hpp>
#include <softtissue/metric/volume_change.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace examples {

ColumnChange column_change(const Scene& scene, const Matrix3X<Scalar>& x) {
    const VolumeChange<Scalar> change = volume_change(scene.layered.mesh, x);
    VectorX<Scalar> sums = VectorX<Scalar>::Zero(scene.layered.num_columns());
    VectorX<Scalar> counts = sums;
    for (Index c = 0; c < scene.layered.mesh.num_cells(); ++c) {
        for (int k = 0; k < 3; ++k) {
            const Index column = scene.layered.layers.column(scene.layered.mesh.cells(k, c));
            sums(column) += change.relative(c);
            counts(column) += 1.0;
        }
    }
    return {(sums.array() / counts.array()).matrix(), std::sqrt(change.mean_square), change.num_inverted};
}

Shot make_shot(const std::string& label, const Scene& scene, const Matrix3X<Scalar>& x, Scene::Frame frame) {
    const ColumnChange change = column_change(scene, x);
    Shot shot{label, std::move(frame), Matrix3X<float>(3, scene.body.num_vertices()), change.root_mean_square};
    shot.colors.colwise() = scale_color(0.0);
    for (Index c = 0; c < scene.layered.num_columns(); ++c) {
        shot.colors.col(scene.layered.region.body_vertices[size_t(c)]) =
            signed_scale_color(change.relative(c) / volume_scale);
    }
    return shot;
}

void write_comparison(const std::filesystem::path& path, const Scene& scene, const std::vector<Shot>& shots,
                      const std::string& title) {
    constexpr int width = 300, largest_height = 520, top = 84;
    const View view(-0.35, 0.08);
    std::vector<Vector3<Scalar>> centers;  // each body in the middle of its panel, all at one scale
    Vector3<Scalar> half = Vector3<Scalar>::Zero();
    for (const Shot& shot : shots) {
        const Matrix3X<Scalar>& skin = shot.frame.skin;
        centers.push_back(0.5 * (skin.rowwise().minCoeff() + skin.rowwise().maxCoeff()));
        half = half.cwiseMax((view.rotation * (skin.colwise() - centers.back())).cwiseAbs().rowwise().maxCoeff());
    }
    const double scale = 0.47 * std::min(width / half.x(), largest_height / half.y());
    const int height = int(half.y() * scale / 0.47);
    const int columns = int(shots.size());
    Picture picture(std::max(760, width * columns), top + 2 * height + 60);
    picture.text(title, 20, 36, 24);
    const auto plain = [](Index n, const Eigen::Vector3f& color) { return Matrix3X<float>(color.replicate(1, n)); };
    for (int k = 0; k < columns; ++k) {
        const Shot& shot = shots[size_t(k)];
        const Vector3<Scalar>& center = centers[size_t(k)];
        const int x = width * k;
        picture.text(shot.label, x + width / 2, 70, 22, 0.5);
        picture.mesh(shot.frame.skin, scene.body.faces, shot.colors, view, center, scale, x, top, width, height);
        char change[64];
        std::snprintf(change, sizeof change, "rms volume change %.1f %%", 100.0 * shot.mean_change);
        picture.text(change, x + width / 2, top + height + 4, 15, 0.5);
        const int y = top + height + 10;
        picture.mesh(shot.frame.muscles, scene.muscles.triangles, plain(shot.frame.muscles.cols(), muscle_color), view,
                     center, scale, x, y, width, height);
        picture.mesh(shot.frame.bones, scene.bones.triangles, plain(shot.frame.bones.cols(), bone_color), view, center,
                     scale, x, y, width, height, 0.45F);
        picture.mesh(shot.frame.skin, scene.body.faces, plain(shot.frame.skin.cols(), skin_color), view, center, scale,
                     x, y, width, height, 0.32F);
    }
    const int bar_y = top + 2 * height + 26;
    for (int k = 0; k < 200; ++k) {
        picture.rectangle(180 + 2 * k, bar_y, 2, 16, signed_scale_color((k - 100) / 100.0));
    }
    picture.text("local volume", 20, bar_y + 14, 16);
    picture.text("-30 %", 172, bar_y + 14, 15, 1.0);
    picture.text("+30 %", 588, bar_y + 14, 15);
    picture.write(path);
}

Animation::Animation(const Scene& scene, const std::vector<std::string>& methods, double frame_rate)
    : gltf_(std::make_unique<GltfAnimation>(frame_rate)) {
    for (size_t k = 0; k < methods.size(); ++k) {
        const Vector3<double> place(1.1 * (double(k) - 0.5 * double(methods.size() - 1)), 0.0, 0.0);
        const bool is_first = k == 0;
        skins_.push_back(gltf_->add_mesh({.name = methods[k] + " skin",
                                          .triangles = scene.body.faces,
                                          .translation = place,
                                          .base_color = skin_color.cast<double>(),
                                          .opacity = is_first ? 0.35 : 1.0}));
        if (is_first) {
            bones_ = gltf_->add_mesh({.name = methods[k] + " bones",
                                      .triangles = scene.bones.triangles,
                                      .translation = place,
                                      .base_color = bone_color.cast<double>(),
                                      .smooth_shading = false});
            muscles_ = gltf_->add_mesh({.name = methods[k] + " muscles",
                                        .triangles = scene.muscles.triangles,
                                        .translation = place,
                                        .base_color = muscle_color.cast<double>(),
                                        .smooth_shading = false});
        }
    }
}

Animation::~Animation() = default;

void Animation::add(size_t method, const Scene::Frame& frame) {
    gltf_->add_frame(skins_[method], frame.skin);
    if (method == 0) {
        gltf_->add_frame(bones_, frame.bones);
        gltf_->add_frame(muscles_, frame.muscles);
    }
}

void Animation::write(const std::filesystem::path& path) {
    gltf_->write(path);
}

}  // namespace examples
