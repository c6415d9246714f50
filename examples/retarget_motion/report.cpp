// SPDX-License-Identifier: MIT
#include "report.hpp"

#include "../support/embedded_human.hpp"
#include "../support/html_report.hpp"

#include <softtissue/skinning/joint_transforms.hpp>
#include <softtissue/skinning/volumetric_smpl.hpp>

#include <algorithm>
#include <utility>

namespace examples {

using namespace softtissue;

namespace {

Connectivity<2> bones_of(const KinematicTree& tree) {
    Connectivity<2> bones(2, tree.num_joints() - 1);
    Index bone = 0;
    for (std::int32_t j = 0; j < tree.num_joints(); ++j) {
        if (tree.parent(j) != KinematicTree::no_parent) {
            bones.col(bone++) << tree.parent(j), j;
        }
    }
    return bones;
}

/// Joints of a pose of the source, in metres and axes of the target.
Matrix3X<double> source_joints(const RetargetScene& scene, const Pose<double>& pose) {
    const Skeleton<double>& skeleton = scene.source.skeleton;
    return scene.retargeter.scale() * scene.retargeter.axes() *
           posed_joints(joint_transforms(skeleton.tree, skeleton.joints, pose), skeleton.joints);
}

/// Heights of the last joint of each leg: where the source has it, and where the result has it.
class LegHeights {
public:
    explicit LegHeights(const RetargetScene& scene) {
        for (const std::vector<std::string>& leg : scene.map.legs) {
            const auto is_mapped = [&](const JointPair& pair) { return pair.target == leg.back(); };
            const auto pair = std::find_if(scene.map.pairs.begin(), scene.map.pairs.end(), is_mapped);
            legs_.emplace_back(scene.source.skeleton.joint(pair->source), scene.target.joint(leg.back()));
            chart_.series.push_back({.name = leg.back() + ", source", .is_dashed = true});
            chart_.series.push_back({.name = leg.back()});
        }
    }

    void add(double time, const Matrix3X<double>& source, const Matrix3X<double>& target) {
        for (size_t k = 0; k < legs_.size(); ++k) {
            add(chart_.series[2 * k], time, source(1, legs_[k].first));
            add(chart_.series[2 * k + 1], time, target(1, legs_[k].second));
        }
    }

    const LineChart& chart() const { return chart_; }

private:
    static void add(LineSeries& series, double time, double height) {
        series.x.push_back(time);
        series.y.push_back(height);
    }

    std::vector<std::pair<std::int32_t, std::int32_t>> legs_;
    LineChart chart_{.title = "Where the feet are", .x_title = "time [s]", .y_title = "height of the joint [m]"};
};

}  // namespace

bool write_report(const std::filesystem::path& path, const RetargetScene& scene) {
    HtmlReport page(
        {.program = "retarget_motion",
         .title = "A motion carried over to a body",
         .summary =
             "The performer's skeleton, at the size of the body, beside the body: rotations are copied, the feet "
             "stand where the performer's feet stood"});
    const VolumetricSmpl<double> skin(read_human(scene.body), {}, {.pose_correctives = false});
    const Triangles faces = read_human(scene.body).faces;
    const Index skin_layer =
        page.add_layer({.name = "Skin", .key = 's', .color = {0.80F, 0.78F, 0.75F}, .opacity = 0.45});
    const Index skeleton_layer = page.add_layer({.name = "Skeleton", .key = 'b', .color = {0.90F, 0.72F, 0.42F}});
    const Index source_view = page.add_view({.name = "Source", .caption = "as captured"});
    const Index target_view = page.add_view({.name = "Retargeted"});
    const Index source =
        page.add_mesh({.view = source_view, .layer = skeleton_layer, .bones = bones_of(scene.source.skeleton.tree)});
    const Index target =
        page.add_mesh({.view = target_view, .layer = skeleton_layer, .bones = bones_of(scene.target.tree)});
    const Index body = page.add_mesh({.view = target_view, .layer = skin_layer, .triangles = faces});

    const double rate = scene.result.frame_rate;
    const Index num_frames = scene.result.num_frames();
    const Index seen_rate = std::max<Index>(1, Index(rate / 30.0 + 0.5));
    const Index stride = seen_rate * page.choose_stride((num_frames + seen_rate - 1) / seen_rate, faces.maxCoeff() + 1);
    LegHeights heights(scene);
    PosedBody<double> posed;
    for (Index k = 0; k < num_frames; ++k) {
        const double time = double(k) / rate;
        const Matrix3X<double> source_places = source_joints(scene, scene.source.motion.poses[size_t(k)]);
        const Pose<double>& pose = scene.result.poses[size_t(k)];
        const Matrix3X<double> target_places =
            posed_joints(joint_transforms(scene.target.tree, scene.target.joints, pose), scene.target.joints);
        heights.add(time, source_places, target_places);
        if (k % stride == 0) {
            skin.pose_into(pose, posed);
            page.add_frame(time);
            page.set_positions(source, source_places.cast<float>());
            page.set_positions(target, target_places.cast<float>());
            page.set_positions(body, posed.positions.cast<float>());
        }
    }
    page.set_poster(num_frames / stride / 3);
    page.add_figure({.name = "Frames", .value = std::to_string(num_frames), .note = formatted("%.4g a second", rate)});
    page.add_figure({.name = "Scale",
                     .value = formatted("%.4g", scene.retargeter.scale()),
                     .note = "metres of the body per length of the source"});
    page.add_figure({.name = "Feet from their places, at most",
                     .value = formatted("%.2g", 1e3 * scene.report.largest_foot_error),
                     .unit = "mm"});
    page.add_figure({.name = "Poses not converged", .value = std::to_string(scene.report.not_converged)});
    page.add_chart(heights.chart(), ChartKind::over_frames);
    return page.write(path);
}

}  // namespace examples
