// SPDX-License-Identifier: MIT
/// @file
/// A human body in SMPL's form, made by code: no file, no licence but this library's.
///
/// What        procedural_human<S>(): skin, 24 joints of SMPL, weights, ten shape directions, pose correctives and
///             joint regressor of a 1.73 m adult. For demonstrations, tests and benchmarks that must run anywhere.
/// Shapes      about 7,300 vertices [m], twice as many triangles, closed, genus 0, mirror symmetric about x = 0;
///             y up, facing +z, left = +x, soles on y = 0. Up to 6 joints a vertex.
/// Rest pose   an A-pose: arms 48 degrees below the horizontal (see HumanSolid). Rotations made for SMPL's T-pose
///             template do not fit directly.
/// Valid       shape coefficients as HumanBlendShapes says. The same bits at every call. The proportions are a design,
///             not statistics. Torso and limbs have no clefts: every vertex sees its triangles within 60 degrees.
/// Cost        about 1 s
/// Tests       tests/unit/model/procedural_human_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/model/human_blend_shapes.hpp>
#include <softtissue/model/human_mesh.hpp>
#include <softtissue/model/human_pose_correctives.hpp>
#include <softtissue/model/human_skinning.hpp>
#include <softtissue/model/human_solid.hpp>
#include <softtissue/model/joint_regressor.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>
#include <softtissue/skinning/smpl_body.hpp>
#include <softtissue/skinning/weights.hpp>

#include <concepts>
#include <vector>

namespace softtissue {

/// The embedded human.
template <RealScalar S>
SmplBody<S> procedural_human() {
    const Matrix3X<double> joints = human_rest_joints();
    const HumanMesh mesh = make_human_mesh();
    const MatrixX<double> weights = HumanSkinning(joints).weights(mesh);
    const HumanBlendShapes shapes(joints);
    const MatrixX<double> directions = shapes.displacement(mesh, weights);
    std::vector<Matrix3X<double>> joint_displacements;
    for (Index k = 0; k < HumanBlendShapes::num_shapes; ++k) {
        joint_displacements.push_back(shapes.joint_displacement(k));
    }
    const SmplBody<double> body{mesh.vertices,
                                mesh.faces,
                                KinematicTree(human_parents()),
                                SkinningWeights<double>(weights.transpose().eval()),
                                JointRegressor()(mesh.vertices, joints, directions, joint_displacements),
                                directions,
                                HumanPoseCorrectives(joints)(mesh, weights),
                                human_joint_names()};
    if constexpr (std::same_as<S, double>) {
        return body;
    } else {
        return body.template cast<S>();
    }
}

}  // namespace softtissue
