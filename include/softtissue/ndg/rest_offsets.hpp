// SPDX-License-Identifier: MIT
/// @file
/// What linear blend skinning must be given instead of the rest shape to reach posed positions, and back.
///
/// What        rest_offsets_into(): what a vertex network learns; move_by_rest_offsets(): positions from offsets
/// Equation    d_v = A_v^-1 (x_v - t_v) - X_v   <=>   x_v = A_v (X_v + d_v) + t_v, for the free vertices
/// Shapes      offsets 3 x free vertices in their order, flat (xyz xyz ...) [m]; x 3 x vertices [m]
/// Valid       where A_v can be inverted. A blend that is nearly singular (near_singular_blend) would make a huge offset of a
///             small distance: such a vertex gets 0 and is counted.
/// Refuses     arrays of different sizes (InvalidInput)
/// Source      Nolte et al. 2026, eq. (21)
/// Cost        150 flop a vertex; same bits for every executor
/// Tests       tests/unit/ndg/rest_offsets_test.cpp
#pragma once

#include <softtissue/anatomy/layered_body.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/skinning/affine_transform.hpp>
#include <softtissue/skinning/inverse.hpp>
#include <softtissue/skinning/linear_blend.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace softtissue {

namespace detail {
template <RealScalar S>
void require_offsets(const LayeredBody<S>& body, const PrescribedVertices& prescribed, Index num_positions,
                     Index num_offsets) {
    require(prescribed.num_vertices() == body.mesh.num_vertices() && num_positions == body.mesh.num_vertices(),
            "rest offsets: ", num_positions, " positions, prescribed ones of ", prescribed.num_vertices(),
            ", expected ", body.mesh.num_vertices());
    require(num_offsets == 3 * prescribed.num_free(), "rest offsets: ", num_offsets,
            " numbers, expected three for each of ", prescribed.num_free(), " free vertices");
}
}  // namespace detail

/// d_v of the positions x; N is the network's scalar. Returns how many vertices got 0 because they have no inverse to speak of.
template <RealScalar N, RealScalar S, Executor E = SequentialExecutor>
Index rest_offsets_into(const LayeredBody<S>& body, const PrescribedVertices& prescribed,
                        std::span<const AffineTransform<S>> joint_transforms, const Matrix3X<S>& x,
                        Eigen::Ref<VectorX<N>> offsets, const E& executor = {}) {
    detail::require_offsets(body, prescribed, x.cols(), offsets.size());
    const LinearBlend<S> policy;
    MatrixX<S> prepared;
    policy.prepare_into(joint_transforms, prepared);
    const std::vector<std::int32_t>& free = prescribed.free_vertices();
    std::vector<std::uint8_t> is_skipped(free.size(), 0);
    executor.for_each_range(Index(free.size()), [&](Index begin, Index end) {
        for (Index k = begin; k < end; ++k) {
            const std::int32_t v = free[size_t(k)];
            const AffineTransform<S> T = policy.blend(prepared, body.weights.row(v));
            Vector3<S> d = Vector3<S>::Zero();
            if (detail::smallest_singular_value_estimate(T.linear) >= near_singular_blend<S>) {
                d = T.inverse()(x.col(v)) - body.mesh.rest_positions.col(v);
            } else {
                is_skipped[size_t(k)] = 1;
            }
            offsets.template segment<3>(3 * k) = d.template cast<N>();
        }
    });
    Index skipped = 0;
    for (const std::uint8_t flag : is_skipped) {
        skipped += flag;
    }
    return skipped;
}

/// Replaces the free columns of x.
template <RealScalar N, RealScalar S, Executor E = SequentialExecutor>
void move_by_rest_offsets(const LayeredBody<S>& body, const PrescribedVertices& prescribed,
                          std::span<const AffineTransform<S>> joint_transforms, ConstRef<VectorX<N>> offsets,
                          Matrix3X<S>& x, const E& executor = {}) {
    detail::require_offsets(body, prescribed, x.cols(), offsets.size());
    const LinearBlend<S> policy;
    MatrixX<S> prepared;
    policy.prepare_into(joint_transforms, prepared);
    const std::vector<std::int32_t>& free = prescribed.free_vertices();
    executor.for_each_range(Index(free.size()), [&](Index begin, Index end) {
        for (Index k = begin; k < end; ++k) {
            const std::int32_t v = free[size_t(k)];
            const Vector3<S> d = offsets.template segment<3>(3 * k).template cast<S>();
            x.col(v) = policy.blend(prepared, body.weights.row(v))(body.mesh.rest_positions.col(v) + d);
        }
    });
}

}  // namespace softtissue
