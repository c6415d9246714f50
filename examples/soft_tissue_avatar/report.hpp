// SPDX-License-Identifier: MIT
/// @file
/// The page of soft_tissue_avatar: the skinned body beside the one with soft tissue, and how its steps went.
#pragma once

#include "scene.hpp"

#include <filesystem>

namespace examples {

/// False without frames, and where the page was not built.
bool write_report(const std::filesystem::path& path, const Settings& settings, const Scene& scene,
                  const AvatarResults& results);

}  // namespace examples
