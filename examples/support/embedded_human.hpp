// SPDX-License-Identifier: MIT
/// @file
/// The bodies and the motion that examples start from, compiled once for all of them.
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/skinning/motion.hpp>
#include <softtissue/skinning/smpl_body.hpp>

#include <string>

namespace examples {

softtissue::SmplBody<double> embedded_human();
softtissue::Motion<double> embedded_motion();

/// The body or the motion of a file, the embedded one without a file.
softtissue::SmplBody<double> read_human(const std::string& path);
softtissue::Motion<double> read_human_motion(const std::string& path, softtissue::Index num_joints);

}  // namespace examples
