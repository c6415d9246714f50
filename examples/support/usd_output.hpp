// SPDX-License-Identifier: MIT
/// @file
/// The tissue of every frame with skin and skeleton as OpenUSD text.
#pragma once

#include <softtissue/anatomy/soft_layer.hpp>
#include <softtissue/io/usda.hpp>
#include <softtissue/mesh/split_prisms.hpp>
#include <softtissue/skinning/skeleton.hpp>
#include <softtissue/skinning/smpl_body.hpp>

#include <filesystem>
#include <string>

namespace examples {

class UsdOutput {
public:
    /// `joints`: at rest, 3 x joints.
    UsdOutput(const softtissue::SmplBody<double>& body, const softtissue::SoftLayer<double>& layer,
              const softtissue::Matrix3X<double>& joints, double frame_rate)
        : animation_(frame_rate),
          skin_(animation_.add_surface({.name = "skinned", .triangles = body.faces, .translation = {-0.6, 0.0, 0.0}})),
          tissue_(animation_.add_tets({.name = "tissue",
                                       .tets = softtissue::split_prisms(layer.mesh).cells,
                                       .translation = {0.6, 0.0, 0.0},
                                       .color = {0.85, 0.6, 0.5}})) {
        softtissue::Skeleton<double> skeleton{body.joint_names, body.tree, joints};
        for (softtissue::Index j = softtissue::Index(skeleton.joint_names.size()); j < body.num_joints(); ++j) {
            skeleton.joint_names.push_back("joint_" + std::to_string(j));
        }
        animation_.set_skeleton(skeleton);
    }

    void add_frame(const softtissue::Matrix3X<double>& skinned, const softtissue::Matrix3X<double>& tissue,
                   const softtissue::Pose<double>& pose) {
        animation_.add_frame(skin_, skinned);
        animation_.add_frame(tissue_, tissue);
        animation_.add_pose(pose);
    }

    void write(const std::filesystem::path& path) const { animation_.write(path); }

private:
    softtissue::UsdAnimation animation_;
    softtissue::Index skin_, tissue_;
};

}  // namespace examples
