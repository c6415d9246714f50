// SPDX-License-Identifier: MIT
/// @file
/// A capsule with a skeleton in it, for tests that need a small skinned body.
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>
#include <softtissue/skinning/weights.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace softtissue {

/// Around the y axis from 0 to 1 m, radius 0.1 m; joints 0 - 1 - 2 at y = 0, 0.5, 1; the joints move what is nearest.
template <RealScalar S>
struct CapsuleBody {
    static constexpr std::int32_t num_rings = 31;
    static constexpr std::int32_t num_sectors = 16;

    Matrix3X<S> positions{3, num_rings* num_sectors + 2};
    Triangles faces{3, 2 * num_rings* num_sectors};
    SkinningWeights<S> weights;
    KinematicTree tree{{KinematicTree::no_parent, 0, 1}};
    Matrix3X<S> joints{3, 3};

    static std::int32_t vertex(std::int32_t ring, std::int32_t sector) {
        return ring * num_sectors + (sector + num_sectors) % num_sectors;
    }

    /// The first ring lies 0.05 m above the lower pole, the last 0.05 m below the upper one.
    static double height(std::int32_t ring) { return 0.05 + 0.9 * ring / (num_rings - 1); }

    CapsuleBody() {
        for (std::int32_t ring = 0; ring < num_rings; ++ring) {
            for (std::int32_t sector = 0; sector < num_sectors; ++sector) {
                const double angle = 2 * std::numbers::pi * sector / num_sectors;
                const double to_end = std::min({height(ring), 1 - height(ring), 0.1});
                const double radius = std::sqrt(0.01 - (0.1 - to_end) * (0.1 - to_end));
                positions.col(vertex(ring, sector)) << S(radius * std::cos(angle)), S(height(ring)),
                    S(-radius * std::sin(angle));
            }
        }
        const std::int32_t bottom = num_rings * num_sectors;
        positions.col(bottom) << S(0), S(0), S(0);
        positions.col(bottom + 1) << S(0), S(1), S(0);
        Index f = 0;
        for (std::int32_t k = 0; k < num_sectors; ++k) {
            faces.col(f++) << bottom, vertex(0, k + 1), vertex(0, k);
            faces.col(f++) << bottom + 1, vertex(num_rings - 1, k), vertex(num_rings - 1, k + 1);
            for (std::int32_t ring = 0; ring + 1 < num_rings; ++ring) {
                faces.col(f++) << vertex(ring, k), vertex(ring, k + 1), vertex(ring + 1, k + 1);
                faces.col(f++) << vertex(ring, k), vertex(ring + 1, k + 1), vertex(ring + 1, k);
            }
        }
        joints << S(0), S(0), S(0), S(0), S(0.5), S(1), S(0), S(0), S(0);
        MatrixX<S> dense = MatrixX<S>::Zero(positions.cols(), 3);
        for (Index v = 0; v < positions.cols(); ++v) {
            const S y = positions(1, v);
            dense(v, y < S(0.25) ? 0 : y < S(0.75) ? 1 : 2) = S(1);
        }
        weights = SkinningWeights<S>(dense);
    }

    /// Narrows the body to a fraction of its radius around y = 0.5, over 0.1 m to either side.
    void tie(double fraction) {
        for (Index v = 0; v < positions.cols(); ++v) {
            const double d = std::min(std::abs(double(positions(1, v)) - 0.5) / 0.1, 1.0);
            const double factor = fraction + (1 - fraction) * d * d * (3 - 2 * d);
            positions(0, v) *= S(factor);
            positions(2, v) *= S(factor);
        }
    }
};

}  // namespace softtissue
