// SPDX-License-Identifier: MIT
/// @file
/// A body in layers with bones and muscles inside, and everything of one frame of it.
#pragma once

#include <softtissue/anatomy/bone_interior.hpp>
#include <softtissue/anatomy/layered_body.hpp>
#include <softtissue/mesh/embedding.hpp>
#include <softtissue/skinning/pose.hpp>
#include <softtissue/skinning/smpl_body.hpp>
#include <softtissue/skinning/volumetric_smpl.hpp>

#include <string>

namespace examples {

using namespace softtissue;
using Scalar = double;

/// What a scene is made of; empty: embedded or procedural.
struct SceneFiles {
    std::string body = {}, bones = {}, muscles = {};
};

/// Bones or muscles as one surface that rides on the layers.
struct EmbeddedSurface {
    Triangles triangles;
    Embedding<Scalar> embedding;
};

struct Scene {
    SmplBody<Scalar> body;
    VolumetricSmpl<Scalar> skin;  // of the whole body, without pose correctives: the cuts follow plain linear blending
    LayeredBody<Scalar> layered;
    BoneInterior<Scalar> interior;  // its first vertices are those of the layers
    EmbeddedSurface bones, muscles;

    /// Everything of one frame; x: the layers. The skin is that of the layers, mended where no layer could exist below it.
    struct Frame {
        Matrix3X<Scalar> skin, bones, muscles;
    };

    Frame frame(const Pose<Scalar>& pose, const Matrix3X<Scalar>& x) const;
};

/// The body of a file, or the embedded one; `betas` become its template, so that its shape is 0.
SmplBody<Scalar> shaped_body(const std::string& file, const VectorX<Scalar>& betas = {});

Scene make_scene(const SceneFiles& files, const VectorX<Scalar>& betas = {});

}  // namespace examples
