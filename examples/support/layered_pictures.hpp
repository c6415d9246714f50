// SPDX-License-Identifier: MIT
/// @file
/// Layered bodies side by side: local volume change on the skin (as Nolte et al. 2026, fig. 9), and what lies under it.
#pragma once

#include "layered_scene.hpp"

#include <softtissue/core/notation.hpp>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace softtissue {
class GltfAnimation;
}

namespace examples {

/// Volume changes at the ends of the colour scale.
inline constexpr double volume_scale = 0.3;

inline const Eigen::Vector3f bone_color(0.93F, 0.86F, 0.62F);
inline const Eigen::Vector3f muscle_color(0.75F, 0.20F, 0.18F);
inline const Eigen::Vector3f skin_color(0.62F, 0.72F, 0.86F);

/// Relative change of volume under each column of the layers, and over all cells.
struct ColumnChange {
    VectorX<Scalar> relative;
    double root_mean_square = 0.0;
    Index num_inverted = 0;
};

ColumnChange column_change(const Scene& scene, const Matrix3X<Scalar>& x);

/// One pose by one method; the label says which.
struct Shot {
    std::string label;
    Scene::Frame frame;
    Matrix3X<float> colors;  // of the skin, by volume change
    double mean_change = 0.0;
};

/// Coloured by column_change().
Shot make_shot(const std::string& label, const Scene& scene, const Matrix3X<Scalar>& x, Scene::Frame frame);

/// Above the skins coloured by volume change, below the same bodies transparent over bones and muscles.
void write_comparison(const std::filesystem::path& path, const Scene& scene, const std::vector<Shot>& shots,
                      const std::string& title);

/// One row of bodies: the skins of all methods, bones and muscles of the first.
class Animation {
public:
    Animation(const Scene& scene, const std::vector<std::string>& methods, double frame_rate);
    ~Animation();

    void add(size_t method, const Scene::Frame& frame);
    void write(const std::filesystem::path& path);

private:
    std::unique_ptr<GltfAnimation> gltf_;
    std::vector<Index> skins_;
    Index bones_ = 0, muscles_ = 0;
};

}  // namespace examples
