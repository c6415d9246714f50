// SPDX-License-Identifier: MIT
/// @file
/// Wraps for tests of procedural anatomy: tubes around the bones of the procedural human within its skin.
#pragma once

#include <softtissue/mesh/ray_distance.hpp>
#include <softtissue/mesh/validate_surface.hpp>
#include <softtissue/mesh/winding_number.hpp>
#include <softtissue/model/anatomy_mesh.hpp>
#include <softtissue/model/body_side.hpp>
#include <softtissue/model/human_mesh.hpp>
#include <softtissue/model/human_solid.hpp>
#include <softtissue/model/marching_tetrahedra.hpp>
#include <softtissue/model/smooth_solid.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <vector>

namespace softtissue {

/// Bone wrap: 25 mm under the skin, where that leaves nothing capsules along the bones. Muscle wrap: 80 % of the way from
/// there to the skin, over the same triangles. Exactly mirror symmetric, closed.
struct TubeBody {
    Matrix3X<double> joints = human_rest_joints();
    Matrix3X<double> bone;
    Matrix3X<double> muscle;
    Triangles triangles;

    TubeBody() {
        using namespace human_joint;
        const HumanSolid skin;
        std::vector<TaperedCapsule> capsules;
        for (const auto& [a, b] : std::vector<std::array<Index, 2>>{
                 {hip, knee}, {knee, ankle}, {shoulder, elbow}, {elbow, hand}, {collar, shoulder}, {neck, head}}) {
            capsules.push_back({joints.col(a), joints.col(b), 0.021, 0.018});
        }
        const auto distance = [&](const Vector3<double>& x) {
            double d = skin(x) + 0.025;
            for (const TaperedCapsule& capsule : capsules) {
                d = smooth_union(d, capsule.distance(x), 0.01);
            }
            return d;
        };
        const SurfaceMesh half = marching_tetrahedra(distance, {0.0, -0.0237, -0.1913}, 0.0127, {55, 140, 31});
        const HumanMesh whole = detail::mirrored_whole(half);
        bone = whole.vertices;
        triangles = whole.faces;
        muscle = bone;
        for (Index v = 0; v < bone.cols(); ++v) {
            const DistanceSample sample = sample_distance(skin, bone.col(v));
            muscle.col(v) -= 0.8 * sample.value * sample.gradient;
        }
        for (Index v = 0; v < bone.cols(); ++v) {  // the samples are symmetric to rounding only
            muscle.col(whole.mirror[size_t(v)]) = mirrored(muscle.col(v));
        }
    }
};

/// Made once.
inline const TubeBody& tube_body() {
    static const TubeBody body;
    return body;
}

template <class S>
void check_surface(const AnatomyMesh<S>& mesh) {
    CAPTURE(mesh.name);
    CHECK_NOTHROW(validate_closed_surface(mesh.positions, mesh.triangles, mesh.name));
}

/// The part of the vertices that `surface` encloses.
inline double enclosed_part(const Matrix3X<double>& points, const WindingNumber<double>& surface) {
    Index count = 0;
    for (Index v = 0; v < points.cols(); ++v) {
        count += surface(points.col(v)) > 0.5 ? 1 : 0;
    }
    return double(count) / double(points.cols());
}

}  // namespace softtissue
