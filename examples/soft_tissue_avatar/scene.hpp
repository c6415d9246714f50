// SPDX-License-Identifier: MIT
/// @file
/// What soft_tissue_avatar is asked for, and everything it needs that does not depend on element and strain frame.
#pragma once

#include "../support/any_skinning.hpp"
#include "../support/avatar_output.hpp"
#include "../support/character_file.hpp"

#include <softtissue/anatomy/soft_layer.hpp>
#include <softtissue/core/thread_executor.hpp>
#include <softtissue/skinning/motion.hpp>
#include <softtissue/skinning/smpl_body.hpp>
#include <softtissue/skinning/volumetric_smpl.hpp>

#include <algorithm>
#include <string>
#include <thread>

namespace examples {

using Scalar = double;
using Skinning = AnySkinning<Scalar>;
using Model = softtissue::VolumetricSmpl<Scalar, Skinning>;

struct Settings {
    std::string body, motion;
    CharacterChoice character;
    int frames = 0;
    std::string material = "fung", skinning = "smpl", frame = "unposed", element = "tet";
    double time_step = 1.0 / 120.0;
    int threads = int(std::max(1U, std::thread::hardware_concurrency()));
    std::string out = "soft_tissue_avatar", json;
    bool vtu = false, usd = false;
};

struct Scene {
    softtissue::SmplBody<Scalar> body;
    softtissue::Motion<Scalar> motion;  // at the time step
    Model skin;
    softtissue::SoftLayer<Scalar> layer;
    Model tissue;  // skin carried to the vertices of the layer
};

/// Static poses in all three strain frames, then the motion in the chosen one. Defined for Tet4 and Prism6, a file each.
template <class ElementType>
void run_avatar(const Settings& settings, const Scene& scene, const softtissue::ThreadExecutor& executor,
                AvatarResults& results);

}  // namespace examples
