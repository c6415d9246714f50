// SPDX-License-Identifier: MIT
#include "layered_report.hpp"

#include "column_errors.hpp"
#include "layered_pictures.hpp"

#include <limits>
#include <utility>

namespace examples {

namespace {

/// Errors at the end of the colour scale [mm].
constexpr double error_scale = 10.0;

std::string in_words(const std::string& method) {
    static const std::vector<std::pair<std::string, std::string>> names{{"fem", "Finite elements"},
                                                                        {"lbs", "Linear blend skinning"},
                                                                        {"dqs", "Dual quaternions"},
                                                                        {"gradient", "Gradient Skinning"},
                                                                        {"projective", "Projective Skinning"},
                                                                        {"corotated", "Co-rotated elasticity"}};
    for (const auto& [key, name] : names) {
        if (key == method) {
            return name;
        }
    }
    return method;
}

}  // namespace

LayeredReport::LayeredReport(HtmlReport::Heading heading, const Scene& scene, const std::vector<std::string>& methods,
                             bool has_reference, Index frames)
    : scene_(scene), report_(std::move(heading)) {
    add_layers(has_reference);
    for (const std::string& method : methods) {
        meshes_.push_back(add_meshes(method));
    }
    const Index vertices = scene.body.num_vertices() + 2 * scene.layered.num_columns() +
                           scene.muscles.embedding.num_points() + scene.bones.embedding.num_points();
    stride_ = report_.choose_stride(frames, vertices * Index(methods.size()));
}

void LayeredReport::add_layers(bool has_reference) {
    volume_ = report_.add_field({.name = "volume change",
                                 .unit = "%",
                                 .note = "Change of volume under the skin",
                                 .low = -100.0 * volume_scale,
                                 .high = 100.0 * volume_scale,
                                 .is_signed = true,
                                 .is_open = true});
    if (has_reference) {
        error_ = report_.add_field({.name = "error",
                                    .unit = "mm",
                                    .note = "Mean distance of skin and muscle wrap to the reference",
                                    .low = 0.0,
                                    .high = error_scale,
                                    .is_open = true});
    }
    skin_ = report_.add_layer({.name = "Skin", .key = 's', .color = skin_color});
    muscle_wrap_ =
        report_.add_layer({.name = "Muscle wrap", .key = 'm', .color = {0.80F, 0.45F, 0.40F}, .is_shown = false});
    bone_wrap_ =
        report_.add_layer({.name = "Bone wrap", .key = 'b', .color = {0.85F, 0.80F, 0.68F}, .is_shown = false});
    muscles_ = report_.add_layer({.name = "Muscles", .key = 'u', .color = muscle_color});
    bones_ = report_.add_layer({.name = "Bones", .key = 'o', .color = bone_color});
}

LayeredReport::Meshes LayeredReport::add_meshes(const std::string& method) {
    constexpr size_t views_at_first = 3;
    const Index view = report_.add_view({.name = in_words(method), .is_shown = meshes_.size() < views_at_first});
    const Meshes* const first = meshes_.empty() ? nullptr : &meshes_.front();
    const auto add = [&](Index layer, const Triangles& triangles, Index Meshes::*mesh) {
        return report_.add_mesh(
            {.view = view, .layer = layer, .triangles = triangles, .similar_to = first == nullptr ? -1 : first->*mesh});
    };
    Meshes meshes{};
    meshes.skin = add(skin_, scene_.body.faces, &Meshes::skin);
    meshes.muscle_wrap = add(muscle_wrap_, scene_.layered.region.triangles, &Meshes::muscle_wrap);
    meshes.bone_wrap = add(bone_wrap_, scene_.layered.region.triangles, &Meshes::bone_wrap);
    meshes.muscles = add(muscles_, scene_.muscles.triangles, &Meshes::muscles);
    meshes.bones = add(bones_, scene_.bones.triangles, &Meshes::bones);
    return meshes;
}

void LayeredReport::begin_frame(double time, const std::string& label) {
    is_seen_ = num_frames_ % stride_ == 0;
    if (is_seen_) {
        report_.add_frame(time, label);
        ++num_seen_;
    }
    ++num_frames_;
}

void LayeredReport::add(size_t method, const Scene::Frame& frame, const Matrix3X<Scalar>& x,
                        const Matrix3X<Scalar>* reference) {
    if (!is_seen_) {
        return;
    }
    const Meshes& meshes = meshes_[method];
    report_.set_positions(meshes.skin, frame.skin.cast<float>());
    report_.set_positions(meshes.muscle_wrap, scene_.layered.layers.level_positions(x, 1).cast<float>());
    report_.set_positions(meshes.bone_wrap, scene_.layered.layers.level_positions(x, 0).cast<float>());
    report_.set_positions(meshes.muscles, frame.muscles.cast<float>());
    report_.set_positions(meshes.bones, frame.bones.cast<float>());
    const ColumnChange change = column_change(scene_, x);
    set_columns(meshes, volume_, 100.0 * change.relative);
    if (error_ >= 0 && method > 0 && reference != nullptr) {
        set_columns(meshes, error_, 1e3 * column_errors(scene_.layered, x, *reference));
    }
    if (change.root_mean_square > largest_change_) {
        largest_change_ = change.root_mean_square;
        report_.set_poster(num_seen_ - 1);
    }
}

void LayeredReport::set_columns(const Meshes& meshes, Index field, const VectorX<Scalar>& values) {
    Eigen::VectorXf skin =
        Eigen::VectorXf::Constant(scene_.body.num_vertices(), std::numeric_limits<float>::quiet_NaN());
    for (Index c = 0; c < values.size(); ++c) {
        skin(scene_.layered.region.body_vertices[size_t(c)]) = float(values(c));
    }
    report_.set_values(meshes.skin, field, skin);
    report_.set_values(meshes.muscle_wrap, field, values.cast<float>());
}

}  // namespace examples
