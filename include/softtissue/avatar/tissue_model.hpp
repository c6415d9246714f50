// SPDX-License-Identifier: MIT
/// @file
/// The skinned model of a tissue volume: SMPL carried from the skin to every vertex of a mesh.
///
/// What        blend shapes and weights of the skin, interpolated harmonically through the tets of the volume.
/// Equation    V_s = L S_s, V_p = L S_p, Z = L W with L the cotangent-Laplacian interpolation from the skin's vertices
/// Shapes      as VolumetricSmpl, over the vertices of the volume
/// Refuses     a volume vertex that no cell joins to the skin (InvalidInput names it)
/// Source      Romero et al. 2020, sec. 3.3, eq. (2)
/// Tests       tests/unit/avatar/tissue_model_test.cpp
#pragma once

#include <softtissue/anatomy/soft_layer.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/mesh/cell_mesh.hpp>
#include <softtissue/mesh/harmonic.hpp>
#include <softtissue/mesh/laplacian.hpp>
#include <softtissue/mesh/split_prisms.hpp>
#include <softtissue/skinning/volumetric_smpl.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace softtissue {

/// For any tets whose vertices `matches` lie on the skin, at the current shape of `skin`.
template <RealScalar S, SkinningPolicy Policy>
VolumetricSmpl<S, Policy> make_tissue_model(const VolumetricSmpl<S, Policy>& skin, const CellMesh<Tet4, S>& tets,
                                            std::span<const VertexMatch> matches) {
    std::vector<std::int32_t> known;
    for (const VertexMatch& match : matches) {
        known.push_back(match.volume);
    }
    const HarmonicInterpolation<S> from_skin(cotangent_laplacian(tets), known);
    return skin.carried_into(tets.rest_positions, matches,
                             [&](const MatrixX<S>& values) { return from_skin.interpolate(values); });
}

/// For the vertices of a soft layer, which prisms and the tets of their split share.
template <RealScalar S, SkinningPolicy Policy>
VolumetricSmpl<S, Policy> make_tissue_model(const VolumetricSmpl<S, Policy>& skin, const SoftLayer<S>& layer) {
    std::vector<VertexMatch> matches;
    for (Index column = 0; column < layer.num_columns(); ++column) {
        const std::int32_t vertex = static_cast<std::int32_t>(layer.skin_vertex(column));
        matches.push_back({vertex, layer.body_vertex(vertex)});
    }
    return make_tissue_model(skin, split_prisms(layer.mesh), std::span<const VertexMatch>(matches));
}

}  // namespace softtissue
