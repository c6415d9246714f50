// SPDX-License-Identifier: MIT
#include "layered_scene.hpp"

#include "embedded_human.hpp"
#include "layered_human.hpp"

#include <softtissue/io/obj.hpp>
#include <softtissue/model/procedural_anatomy.hpp>

#include <utility>
#include <vector>

namespace examples {

namespace {

/// All surfaces of one kind as one.
ObjMesh<Scalar> joined(const std::vector<AnatomyMesh<Scalar>>& parts, AnatomyKind kind) {
    ObjMesh<Scalar> whole;
    for (const AnatomyMesh<Scalar>& part : parts) {
        if (part.kind == kind) {
            const Index vertices = whole.positions.cols();
            whole.positions.conservativeResize(3, vertices + part.positions.cols());
            whole.positions.rightCols(part.positions.cols()) = part.positions;
            whole.triangles.conservativeResize(3, whole.triangles.cols() + part.triangles.cols());
            whole.triangles.rightCols(part.triangles.cols()) = part.triangles.array() + int(vertices);
        }
    }
    return whole;
}

}  // namespace

Scene::Frame Scene::frame(const Pose<Scalar>& pose, const Matrix3X<Scalar>& x) const {
    const PosedBody<Scalar> posed = skin.pose(pose);
    Frame result{posed.positions, Matrix3X<Scalar>(3, bones.embedding.num_points()),
                 Matrix3X<Scalar>(3, muscles.embedding.num_points())};
    for (Index c = 0; c < layered.num_columns(); ++c) {
        result.skin.col(layered.region.body_vertices[size_t(c)]) = x.col(layered.layers.vertex(c, 2));
    }
    Matrix3X<Scalar> all(3, interior.mesh.num_vertices());
    all.leftCols(x.cols()) = x;
    const LinearBlend<Scalar> policy;
    for (Index v = x.cols(); v < all.cols(); ++v) {
        all.col(v) = policy.blend(posed.prepared_joints, interior.weights.row(v))(interior.mesh.rest_positions.col(v));
    }
    bones.embedding.apply_into(all, result.bones);
    muscles.embedding.apply_into(all, result.muscles);
    return result;
}

SmplBody<Scalar> shaped_body(const std::string& file, const VectorX<Scalar>& betas) {
    SmplBody<Scalar> body = read_human(file);
    if (betas.size() > 0) {
        body.template_vertices = VolumetricSmpl<Scalar>(body).rest_shape(betas);
    }
    return body;
}

Scene make_scene(const SceneFiles& files, const VectorX<Scalar>& betas) {
    SmplBody<Scalar> body = shaped_body(files.body, betas);
    VolumetricSmpl<Scalar> skin(body, {}, {.pose_correctives = false});
    LayeredBody<Scalar> layered = layered_body_of(body);
    const Triangles& triangles = layered.region.triangles;
    const Matrix3X<Scalar> bone_wrap = layered.level_positions(0);
    BoneInterior<Scalar> interior = join_to_layers(make_bone_interior(bone_wrap, triangles, layered.column_weights()),
                                                   layered.layers, layered.mesh.rest_positions, layered.weights);
    const auto parts = procedural_anatomy<Scalar>(skin.rest_joints(), bone_wrap, layered.level_positions(1), triangles,
                                                  {.density = 0.6});
    const auto embedded = [&](const std::string& file, AnatomyKind kind) {
        const ObjMesh<Scalar> mesh = file.empty() ? joined(parts, kind) : read_obj<Scalar>(file);
        return EmbeddedSurface{mesh.triangles, Embedding<Scalar>(mesh.positions, layered.mesh, interior.mesh)};
    };
    EmbeddedSurface bones = embedded(files.bones, AnatomyKind::bone);
    EmbeddedSurface muscles = embedded(files.muscles, AnatomyKind::muscle);
    return {std::move(body),     std::move(skin),  std::move(layered),
            std::move(interior), std::move(bones), std::move(muscles)};
}

}  // namespace examples
