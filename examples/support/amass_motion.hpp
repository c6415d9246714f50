// SPDX-License-Identifier: MIT
/// @file
/// A motion from an AMASS file as people have them: fingers that the body lacks are left out, and that is said.
#pragma once

#include <softtissue/io/amass_file.hpp>

#include <cstdio>
#include <string>

namespace examples {

inline softtissue::Motion<double> read_motion(const std::string& path, softtissue::Index num_joints) {
    softtissue::AmassClip<double> clip =
        softtissue::read_amass_clip<double>(path, num_joints, softtissue::AmassHands::at_rest);
    if (clip.file_joints != num_joints) {
        std::fprintf(stderr, "%s: of %d joints the 22 of the body are used, hands stay at rest\n", path.c_str(),
                     int(clip.file_joints));
    }
    return clip.motion;
}

}  // namespace examples
