// SPDX-License-Identifier: MIT
/// @file
/// The page of retarget_motion: the performer's skeleton beside the body's, and the body's skin.
#pragma once

#include <softtissue/io/bvh.hpp>
#include <softtissue/skinning/motion.hpp>
#include <softtissue/skinning/retarget.hpp>
#include <softtissue/skinning/skeleton.hpp>

#include <filesystem>
#include <string>

namespace examples {

/// What the page is about. `body`: the file of the body, empty for the embedded one.
struct RetargetScene {
    const std::string& body;
    const softtissue::BvhClip<double>& source;
    const softtissue::Retargeter<double>& retargeter;
    const softtissue::JointMap& map;
    const softtissue::Skeleton<double>& target;
    const softtissue::Motion<double>& result;
    const softtissue::RetargetReport<double>& report;
};

bool write_report(const std::filesystem::path& path, const RetargetScene& scene);

}  // namespace examples
