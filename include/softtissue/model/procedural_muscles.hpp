// SPDX-License-Identifier: MIT
/// @file
/// Muscles of one half of the procedural anatomy, between bone wrap and muscle wrap.
///
/// What        procedural_muscles(): spindles along the limbs, sheets over trunk, hip and shoulder.
/// Method      a muscle runs along stations (t, angle, half width in t, half width in degrees) of a BodyChart; across it, the
///             share f of the way from bone wrap to muscle wrap swings between `inner` and `outer`. Towards the ends of a
///             spindle it sinks to the bone, as tendons do.
/// Shapes      AnatomyMesh<double>, left half (BodySide), one closed piece each.
/// Source      a design after anatomical plates: suggestive, not measured.
/// Tests       tests/unit/model/procedural_muscles_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/model/anatomy_mesh.hpp>
#include <softtissue/model/body_side.hpp>
#include <softtissue/model/human_solid.hpp>
#include <softtissue/model/muscle_designs.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace softtissue {

/// All muscles of one side. `scale` of the body against the reference skeleton; `density` of rings and sectors.
inline std::vector<AnatomyMesh<double>> procedural_muscles(const BodySide& side, double scale, double density) {
    using namespace human_joint;
    const std::vector<BodyChart> charts{
        BodyChart::limb(side, hip, knee, .16 * scale), BodyChart::limb(side, knee, ankle, .09 * scale),
        BodyChart::limb(side, shoulder, elbow, .08 * scale), BodyChart::limb(side, elbow, wrist, .07 * scale),
        BodyChart::trunk(side, .19 * scale)};
    std::vector<AnatomyMesh<double>> meshes;
    for (const MuscleDesign& design : muscle_designs()) {
        const BodyChart& chart = charts[size_t(design.region)];
        meshes.push_back({design.name, AnatomyKind::muscle, Matrix3X<double>(3, 0), Triangles(3, 0)});
        const auto rings =
            std::max(Index(5), Index(std::lround((6.0 + 3.0 * double(design.stations.size())) * density)));
        const auto sectors = std::max(Index(6), Index(std::lround(14.0 * density)));
        // Flattened towards a rectangle: bellies that lie side by side leave no wide furrow.
        const auto flattened = [](double x) { return std::copysign(std::pow(std::abs(x), 0.75), x); };
        add_loft(meshes.back(), rings, sectors, [&](double u, double angle) {
            const MuscleDesign::Station s = along_stations<4>(design.stations, u);
            const double size = rounded_ends(u, 0.1);
            const double across = size * flattened(std::cos(angle));
            const double rise = std::pow(std::sin(std::numbers::pi * std::clamp(u, 0.0, 1.0)), 0.5);
            const double depth = 1.0 - design.sinking * (1.0 - rise);
            const double low = design.inner * depth;
            const double high = low + (design.outer - design.inner) * std::max(depth, 0.25);
            const double f = 0.5 * (low + high) + 0.5 * (high - low) * size * flattened(std::sin(angle));
            return chart.point(s(0) + across * s(2), s(1) + across * s(3), f);
        });
    }
    return meshes;
}

}  // namespace softtissue
