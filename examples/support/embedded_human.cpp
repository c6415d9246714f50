// SPDX-License-Identifier: MIT
#include "embedded_human.hpp"

#include "amass_motion.hpp"

#include <softtissue/io/smpl_file.hpp>
#include <softtissue/model/procedural_human.hpp>
#include <softtissue/model/procedural_motion.hpp>

namespace examples {

softtissue::SmplBody<double> embedded_human() {
    return softtissue::procedural_human<double>();
}

softtissue::Motion<double> embedded_motion() {
    return softtissue::procedural_motion<double>();
}

softtissue::SmplBody<double> read_human(const std::string& path) {
    return path.empty() ? embedded_human() : softtissue::read_smpl_body<double>(path);
}

softtissue::Motion<double> read_human_motion(const std::string& path, softtissue::Index num_joints) {
    return path.empty() ? embedded_motion() : read_motion(path, num_joints);
}

}  // namespace examples
