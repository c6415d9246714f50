// SPDX-License-Identifier: MIT
/// @file
/// From a value to a colour: neutral where nothing happens, dark red at the end of the scale; blue for negative values.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>

namespace examples {

/// sRGB in [0, 1].
inline Eigen::Vector3f scale_color(double value) {
    static const std::array<Eigen::Vector3f, 5> stops{
        Eigen::Vector3f(0.82F, 0.82F, 0.80F), Eigen::Vector3f(0.99F, 0.90F, 0.55F),
        Eigen::Vector3f(0.98F, 0.60F, 0.25F), Eigen::Vector3f(0.85F, 0.20F, 0.15F),
        Eigen::Vector3f(0.42F, 0.02F, 0.15F)};
    const double place = std::clamp(value, 0.0, 1.0) * double(stops.size() - 1);
    const size_t below = std::min(size_t(place), stops.size() - 2);
    const float t = float(place - double(below));
    return (1.0F - t) * stops[below] + t * stops[below + 1];
}

/// For values in [-1, 1]: blue below zero, red above.
inline Eigen::Vector3f signed_scale_color(double value) {
    const Eigen::Vector3f color = scale_color(std::abs(value));
    return value < 0.0 ? Eigen::Vector3f(color.reverse()) : color;
}

}  // namespace examples
