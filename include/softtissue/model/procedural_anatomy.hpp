// SPDX-License-Identifier: MIT
/// @file
/// Bones and muscles for any layered body of SMPL's skeleton, made by code: something to embed and to look at.
///
/// What        procedural_anatomy(): 67 bones in the bone wrap and 88 muscles between bone wrap and muscle wrap, each a
///             named surface ("left_femur", "right_rib_3", "sacrum").
/// Shapes      joints 3 x 24; both wraps 3 x n [m] over the same triangles, which may have boundary loops at head, hands and
///             feet. Every surface is closed, faces outwards, may consist of several overlapping pieces.
/// Parameters  density: rings and sectors of the surfaces; 0.75 gives about 29,000 vertices, they grow with its square.
/// Valid       rest poses that stand upright, y up, facing +z, left = +x; arms anywhere from hanging to level. What is mirror
///             symmetric about x = 0 gives mirror-symmetric anatomy. Bones that would leave the bone wrap are drawn back.
///             A design after anatomical plates, fitted by joints and wraps; not a scan. Skull, hands and feet are left out.
/// Refuses     other than 24 joints, anything not finite, density outside [0.3, 10] (InvalidInput)
/// Cost        0.2 s
/// Tests       tests/unit/model/procedural_anatomy_test.cpp
#pragma once

#include <softtissue/anatomy/body_anatomy.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/ray_distance.hpp>
#include <softtissue/model/anatomy_mesh.hpp>
#include <softtissue/model/body_side.hpp>
#include <softtissue/model/human_solid.hpp>
#include <softtissue/model/limb_bones.hpp>
#include <softtissue/model/procedural_muscles.hpp>
#include <softtissue/model/trunk_bones.hpp>

#include <utility>
#include <vector>

namespace softtissue {

struct ProceduralAnatomyOptions {
    double density = 0.75;
};

template <RealScalar S>
std::vector<AnatomyMesh<S>> procedural_anatomy(const Matrix3X<S>& joints, const Matrix3X<S>& bone_wrap,
                                               const Matrix3X<S>& muscle_wrap, const Triangles& triangles,
                                               const ProceduralAnatomyOptions& options = {}) {
    require(joints.cols() == human_joint::count && joints.allFinite(), "procedural anatomy: ", joints.cols(),
            " joint positions, expected SMPL's ", human_joint::count, ", all finite");
    require(options.density >= 0.3 && options.density <= 10.0, "procedural anatomy: density = ", options.density,
            ", expected 0.3 to 10");
    const Matrix3X<double> J = joints.template cast<double>();
    const RayDistance<double> bone(bone_wrap.template cast<double>(), triangles);
    const RayDistance<double> muscle(muscle_wrap.template cast<double>(), triangles);
    const double scale = smpl_anatomy().scale(J);

    std::vector<AnatomyMesh<S>> result;
    const auto add = [&result](std::vector<AnatomyMesh<double>> meshes, const char* prefix, bool is_mirrored) {
        for (AnatomyMesh<double>& mesh : meshes) {
            if (is_mirrored) {
                mesh.positions.row(0) *= -1.0;
                mesh.triangles.row(1).swap(mesh.triangles.row(2));
            }
            result.push_back(
                {prefix + mesh.name, mesh.kind, mesh.positions.template cast<S>(), std::move(mesh.triangles)});
        }
    };
    for (const bool is_right : {false, true}) {
        const BodySide side(J, bone, muscle, is_right);
        const char* prefix = is_right ? "right_" : "left_";
        TrunkBones trunk(side, scale, options.density);
        add(LimbBones(side, scale, options.density)(), prefix, is_right);
        add(trunk.paired(), prefix, is_right);
        if (!is_right) {
            add(trunk.middle(), "", false);
        }
        add(procedural_muscles(side, scale, options.density), prefix, is_right);
    }
    return result;
}

}  // namespace softtissue
