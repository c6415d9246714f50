// SPDX-License-Identifier: MIT
/// @file
/// A rigged character of one's own (.glb, .gltf) with one of its clips, as a body and a motion.
#pragma once

#include <softtissue/anatomy/simulated_region.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/skinning/motion.hpp>
#include <softtissue/skinning/smpl_body.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace examples {

/// What to take from the file; empty: its only skinned mesh, its first clip, the whole surface.
struct CharacterChoice {
    std::string mesh, clip;
    std::string joints;  ///< file of SMPL's names for joints: head, hands and feet are left out of the simulation
};

struct CharacterScene {
    softtissue::SmplBody<double> body;
    softtissue::Motion<double> motion;
    softtissue::JointGroups extremities;
    std::vector<std::int32_t> hole_centers;  ///< vertices that carry no tissue
};

/// Whether the name is that of a glTF file.
bool is_character_file(const std::string& path);

CharacterScene read_character(const std::string& path, const CharacterChoice& choice);

}  // namespace examples
