// SPDX-License-Identifier: MIT
/// @file
/// What soft_tissue_avatar leaves behind: an animation, a contact sheet, meshes for ParaView, figures.
#pragma once

#include "color_scale.hpp"
#include "html_report.hpp"
#include "mesh_picture.hpp"

#include <softtissue/anatomy/soft_layer.hpp>
#include <softtissue/io/atomic_file.hpp>
#include <softtissue/io/gltf.hpp>
#include <softtissue/io/output_folder.hpp>
#include <softtissue/io/pvd.hpp>
#include <softtissue/io/vtu.hpp>
#include <softtissue/skinning/smpl_body.hpp>
#include <softtissue/solver/report.hpp>

#include <sys/resource.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace examples {

/// One time step.
struct StepRecord {
    double time = 0.0;    // [s]
    double energy = 0.0;  // what the step minimised [J]
    int quasi_newton_steps = 0, newton_iterations = 0;
    double milliseconds = 0.0;
};

/// Counts over all time steps.
struct StepStatistics {
    std::vector<StepRecord> records = {};
    int count = 0;
    int not_converged = 0;
    long newton_iterations = 0;
    int newton_iterations_max = 0;
    Index inverted_cells_max = 0;
    double milliseconds = 0.0;

    void add(double time, const softtissue::SolveReport<double>& report, Index inverted_cells,
             double step_milliseconds) {
        records.push_back({time, report.energy, report.quasi_newton_steps, report.iterations, step_milliseconds});
        ++count;
        not_converged += report.succeeded() ? 0 : 1;
        newton_iterations += report.iterations;
        newton_iterations_max = std::max(newton_iterations_max, report.iterations);
        inverted_cells_max = std::max(inverted_cells_max, inverted_cells);
        milliseconds += step_milliseconds;
    }
    double newton_iterations_mean() const { return double(newton_iterations) / std::max(1, count); }
    double milliseconds_mean() const { return milliseconds / std::max(1, count); }
};

/// The tissue at rest in one pose.
struct StaticPose {
    double error = 0.0;  // largest distance from the skinned body [m]
    softtissue::SolveStatus status = softtissue::SolveStatus::cancelled;
};

/// The skin of one frame, as the body has it and as the tissue has it.
struct AvatarFrame {
    Matrix3X<float> skinned, simulated;
    double time = 0.0;     // [s]
    double largest = 0.0;  // displacement [m]

    Eigen::VectorXf displacement() const { return (simulated - skinned).colwise().norm(); }
};

/// The largest displacement of a frame, told for all frames.
struct DisplacementRecord {
    double time = 0.0, largest = 0.0, mean = 0.0;  // [s], [m]
};

struct AvatarResults {
    Index vertices = 0, cells = 0, free_vertices = 0, inverted_at_rest = 0;
    StaticPose static_unposed, static_world, static_retargeted;
    StepStatistics steps;
    double largest_displacement = 0.0;  // [m]
    double seconds_setup = 0.0;
    bool interrupted = false;
    std::vector<std::filesystem::path> pictures;
    std::vector<AvatarFrame> frames;  // at about 30 Hz
    std::vector<DisplacementRecord> displacements;
    double displacement_scale = 0.0;  // top of the colour scale [m]
};

/// Largest amount of memory that this process has held [bytes].
inline long peak_memory_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1024L * usage.ru_maxrss;
}

inline void write_results(const std::filesystem::path& path, const AvatarResults& results) {
    const nlohmann::ordered_json json = {
        {"vertices", results.vertices},
        {"free_vertices", results.free_vertices},
        {"cells", results.cells},
        {"rest", {{"inverted_cells", results.inverted_at_rest}}},
        {"static_pose",
         {{"unposed_max_error_m", results.static_unposed.error},
          {"world_max_error_m", results.static_world.error},
          {"retargeted_max_error_m", results.static_retargeted.error},
          {"unposed_status", to_string(results.static_unposed.status)},
          {"world_status", to_string(results.static_world.status)},
          {"retargeted_status", to_string(results.static_retargeted.status)}}},
        {"steps",
         {{"count", results.steps.count},
          {"not_converged", results.steps.not_converged},
          {"newton_iterations_mean", results.steps.newton_iterations_mean()},
          {"newton_iterations_max", results.steps.newton_iterations_max},
          {"inverted_cells_max", results.steps.inverted_cells_max},
          {"milliseconds_mean", results.steps.milliseconds_mean()}}},
        {"largest_displacement_m", results.largest_displacement},
        {"setup_seconds", results.seconds_setup},
        {"peak_memory_bytes", peak_memory_bytes()},
        {"interrupted", results.interrupted},
    };
    softtissue::AtomicFile file(path);
    file.write(json.dump(2) + "\n");
    file.commit();
}

/// What the results come to, for the terminal and for the page.
inline std::vector<std::pair<std::string, std::string>> result_rows(const AvatarResults& results) {
    std::vector<std::pair<std::string, std::string>> rows;
    const auto row = [&](const char* name, const std::string& value) { rows.emplace_back(name, value); };
    row("cells, vertices, of them free", std::to_string(results.cells) + ", " + std::to_string(results.vertices) +
                                             ", " + std::to_string(results.free_vertices));
    row("inverted cells at rest, ever",
        std::to_string(results.inverted_at_rest) + ", " + std::to_string(results.steps.inverted_cells_max));
    const auto static_row = [&](const char* name, const StaticPose& pose) {
        row(name, formatted("%.3g mm from the skinned body, ", 1e3 * pose.error) + to_string(pose.status));
    };
    static_row("static pose, unposed strain", results.static_unposed);
    static_row("static pose, world strain", results.static_world);
    static_row("static pose, retargeted strain", results.static_retargeted);
    row("time steps, not converged",
        std::to_string(results.steps.count) + ", " + std::to_string(results.steps.not_converged));
    row("Newton iterations a step", formatted("%.2f", results.steps.newton_iterations_mean()) + ", at most " +
                                        std::to_string(results.steps.newton_iterations_max));
    row("time a step", formatted("%.1f ms", results.steps.milliseconds_mean()));
    row("largest soft-tissue displacement", formatted("%.1f mm", 1e3 * results.largest_displacement));
    row("set-up, peak memory",
        formatted("%.1f s, ", results.seconds_setup) + formatted("%.0f MB", double(peak_memory_bytes()) / 1e6));
    return rows;
}

inline void print_results(const AvatarResults& results, const std::filesystem::path& json) {
    std::printf("\n");
    for (const auto& [name, value] : result_rows(results)) {
        std::printf("  %-34s %s\n", name.c_str(), value.c_str());
    }
    std::printf("\n%s", results.interrupted ? "interrupted; results up to there in\n" : "results in\n");
    for (const std::filesystem::path& file : results.pictures) {
        std::printf("  %s\n", file.c_str());
    }
    std::printf("  %s\n", json.c_str());
}

/// Collects the skin of every frame; write() makes the files.
class AvatarOutput {
public:
    AvatarOutput(std::filesystem::path folder, const softtissue::SmplBody<double>& body,
                 const softtissue::SoftLayer<double>& layer, double frame_rate, bool vtu)
        : folder_(std::move(folder)),
          body_(body),
          layer_(layer),
          frame_rate_(frame_rate),
          stride_(std::max(1, int(frame_rate / 30.0 + 0.5))) {
        if (vtu) {
            softtissue::make_output_folder(folder_ / "vtu");
        }
    }

    /// `skinned`: the body's skin in the pose; `tissue`: positions of the layer's vertices.
    void add_frame(const Matrix3X<double>& skinned, const Matrix3X<double>& tissue) {
        Matrix3X<double> simulated = skinned;
        for (Index c = 0; c < layer_.num_columns(); ++c) {
            const Index vertex = layer_.skin_vertex(c);
            simulated.col(layer_.body_vertex(vertex)) = tissue.col(vertex);
        }
        const Eigen::VectorXd displacement = (simulated - skinned).colwise().norm();
        largest_ = std::max(largest_, displacement.maxCoeff());
        displacements_.push_back({time(), displacement.maxCoeff(), displacement.mean()});
        if (num_frames_ % stride_ == 0) {
            frames_.push_back({skinned.cast<float>(), simulated.cast<float>(), time(), displacement.maxCoeff()});
        }
        ++num_frames_;
    }

    template <int num_nodes>
    void add_vtu(const Matrix3X<double>& tissue, const Matrix3X<double>& skinned,
                 const softtissue::Connectivity<num_nodes>& cells) {
        char name[32];
        std::snprintf(name, sizeof name, "frame_%05d.vtu", num_frames_);
        softtissue::write_vtu(
            folder_ / "vtu" / name, tissue, cells,
            {.vertex_arrays = {{"displacement", (tissue - skinned).cast<float>()}}, .cell_arrays = {}});
        steps_.push_back({double(num_frames_ - 1) / frame_rate_, name});  // of the frame added last
    }

    void write() {
        if (frames_.empty()) {
            return;
        }
        write_animation(folder_ / "soft_tissue.glb");
        if (!steps_.empty()) {
            softtissue::write_pvd(folder_ / "vtu" / "soft_tissue.pvd", steps_);
        }
        write_contact_sheet(folder_ / "contact_sheet.png");
    }

    /// Of the frame that is added next [s].
    double time() const { return double(num_frames_) / frame_rate_; }

    /// Gives everything away.
    void move_into(AvatarResults& results) {
        results.pictures = std::move(files_);
        results.largest_displacement = largest_;
        results.displacement_scale = scale_top();
        results.frames = std::move(frames_);
        results.displacements = std::move(displacements_);
    }

private:
    using Frame = AvatarFrame;

    /// Top of the colour scale [m]: the largest displacement, rounded up to 1, 2 or 5 times a power of ten.
    double scale_top() const {
        const double largest = std::max(largest_, 1e-5);
        const double decade = std::pow(10.0, std::floor(std::log10(largest)));
        for (const double step : {1.0, 2.0, 5.0}) {
            if (step * decade >= largest) {
                return step * decade;
            }
        }
        return 10.0 * decade;
    }

    static Matrix3X<float> displacement_colors(const Frame& frame, double top) {
        Matrix3X<float> colors(3, frame.skinned.cols());
        const Eigen::VectorXf displacement = frame.displacement();
        for (Index v = 0; v < colors.cols(); ++v) {
            colors.col(v) = scale_color(double(displacement(v)) / top);
        }
        return colors;
    }

    void write_animation(const std::filesystem::path& path) {
        softtissue::GltfAnimation animation(frame_rate_ / stride_);
        const Index skinned = animation.add_mesh({.name = "skinned",
                                                  .triangles = body_.faces,
                                                  .translation = {-0.6, 0.0, 0.0},
                                                  .base_color = {0.7, 0.7, 0.7},
                                                  .smooth_shading = false});
        const Index simulated = animation.add_mesh({.name = "soft tissue",
                                                    .triangles = body_.faces,
                                                    .translation = {0.6, 0.0, 0.0},
                                                    .base_color = {0.85, 0.6, 0.5},
                                                    .smooth_shading = false});
        for (const Frame& frame : frames_) {
            animation.add_frame(skinned, frame.skinned);
            animation.add_frame(simulated, frame.simulated);
        }
        animation.write(path);
        files_.push_back(path);
    }

    /// Of each of six equal parts of the motion the frame with the largest displacement.
    std::vector<const Frame*> selected_frames() const {
        std::vector<const Frame*> selected;
        const size_t parts = std::min<size_t>(6, frames_.size());
        for (size_t part = 0; part < parts; ++part) {
            const auto begin = frames_.begin() + std::ptrdiff_t(part * frames_.size() / parts);
            const auto end = frames_.begin() + std::ptrdiff_t((part + 1) * frames_.size() / parts);
            selected.push_back(
                &*std::max_element(begin, end, [](const Frame& a, const Frame& b) { return a.largest < b.largest; }));
        }
        return selected;
    }

    void write_contact_sheet(const std::filesystem::path& path) {
        constexpr int panel_width = 250, panel_height = 400, margin = 60, legend_width = 150, row_gap = 60;
        const std::vector<const Frame*> selected = selected_frames();
        const View view(-0.5, 0.12);
        Picture picture(margin + panel_width * int(selected.size()) + legend_width,
                        2 * panel_height + row_gap + 2 * margin);
        const double top = scale_top();
        const double scale = panel_scale(selected, view, panel_width, panel_height);
        const Matrix3X<float> plain = Matrix3X<float>::Constant(3, body_.num_vertices(), 0.82F);
        for (size_t column = 0; column < selected.size(); ++column) {
            const Frame& frame = *selected[column];
            const int x = margin + panel_width * int(column);
            const Eigen::Vector3d center = box_center(frame.skinned);
            picture.mesh(frame.skinned.cast<double>(), body_.faces, plain, view, center, scale, x, margin, panel_width,
                         panel_height);
            picture.mesh(frame.simulated.cast<double>(), body_.faces, displacement_colors(frame, top), view, center,
                         scale, x, margin + panel_height + row_gap, panel_width, panel_height);
            char caption[64];
            std::snprintf(caption, sizeof caption, "%.2f s,  %.3g mm", frame.time, 1e3 * frame.largest);
            picture.text(caption, x + 0.5 * panel_width, 2 * panel_height + row_gap + margin + 34, 17, 0.5);
        }
        picture.text("skinned", margin, margin - 24, 22);
        picture.text("with soft tissue, coloured by its displacement from the skinned body", margin,
                     margin + panel_height + row_gap - 18, 22);
        draw_legend(picture, margin + panel_width * int(selected.size()) + 20, margin + panel_height + row_gap + 40,
                    panel_height - 80, top);
        picture.write(path);
        files_.push_back(path);
    }

    static Eigen::Vector3d box_center(const Matrix3X<float>& positions) {
        return (0.5F * (positions.rowwise().minCoeff() + positions.rowwise().maxCoeff())).cast<double>();
    }

    /// Pixels a metre at which every selected frame fits its panel.
    double panel_scale(const std::vector<const Frame*>& selected, const View& view, int width, int height) const {
        double scale = 1e9;
        for (const Frame* frame : selected) {
            const Matrix3X<double> screen =
                view.rotation * (frame->skinned.cast<double>().colwise() - box_center(frame->skinned));
            const Eigen::Vector3d reach = screen.cwiseAbs().rowwise().maxCoeff() + Eigen::Vector3d::Constant(0.02);
            scale = std::min({scale, 0.5 * width / reach(0), 0.5 * height / reach(1)});
        }
        return scale;
    }

    static void draw_legend(Picture& picture, int x, int y, int height, double top) {
        for (int row = 0; row < height; ++row) {
            picture.rectangle(x, y + row, 22, 1, scale_color(1.0 - double(row) / height));
        }
        for (int tick = 0; tick <= 4; ++tick) {
            char label[32];
            std::snprintf(label, sizeof label, "%.3g mm", 1e3 * top * tick / 4.0);
            picture.text(label, x + 28, y + height - tick * height / 4.0 + 5, 15);
        }
    }

    std::filesystem::path folder_;
    const softtissue::SmplBody<double>& body_;
    const softtissue::SoftLayer<double>& layer_;
    double frame_rate_;
    int stride_;
    int num_frames_ = 0;
    double largest_ = 0.0;
    std::vector<Frame> frames_;
    std::vector<softtissue::PvdStep> steps_;
    std::vector<DisplacementRecord> displacements_;
    std::vector<std::filesystem::path> files_;
};

}  // namespace examples
