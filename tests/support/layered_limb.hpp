// SPDX-License-Identifier: MIT
// A limb in layers: a tube of skin over muscle over bone, open at both ends, on two joints; small enough for many solves.
#pragma once

#include <softtissue/anatomy/layered_body.hpp>
#include <softtissue/linalg/quaternion.hpp>
#include <softtissue/skinning/affine_transform.hpp>
#include <softtissue/skinning/linear_blend.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace softtissue_test {

using namespace softtissue;

template <class S>
struct LayeredLimb {
    static constexpr int around = 10;
    static constexpr int along = 9;

    LayeredBody<S> body;

    /// 0.4 m long; bone, muscle and skin 2, 4 and 5 cm from the axis.
    LayeredLimb() {
        const double radii[3] = {0.02, 0.04, 0.05};
        const Index num_columns = around * (along + 1);
        body.layers.num_columns = num_columns;
        Matrix3X<S>& X = body.mesh.rest_positions;
        X.resize(3, body.layers.num_vertices());
        MatrixX<S> weights(body.layers.num_vertices(), 2);
        for (int i = 0; i <= along; ++i) {
            for (int j = 0; j < around; ++j) {
                for (int level = 0; level < 3; ++level) {
                    const Index v = body.layers.vertex(i * around + j, level);
                    const double angle = 2 * 3.14159265358979 * j / around;
                    const double x = 0.4 * i / along - 0.2;
                    X.col(v) << S(x), S(radii[level] * std::cos(angle)), S(radii[level] * std::sin(angle));
                    const S second = S(1 / (1 + std::exp(-x / 0.02)));
                    weights.row(v) << S(1) - second, second;
                    if (level == 0 || i == 0 || i == along) {
                        body.prescribed.push_back(static_cast<std::int32_t>(v));
                    }
                }
            }
        }
        std::sort(body.prescribed.begin(), body.prescribed.end());
        body.weights = SkinningWeights<S>(weights);
        Triangles& triangles = body.region.triangles;
        triangles.resize(3, 2 * around * along);
        for (int i = 0; i < along; ++i) {
            for (int j = 0; j < around; ++j) {
                const int a = i * around + j, b = i * around + (j + 1) % around;
                triangles.col(2 * a) << a, b, a + around;
                triangles.col(2 * a + 1) << b, b + around, a + around;
            }
        }
        body.mesh.cells.resize(6, 2 * triangles.cols());
        for (Index layer = 0; layer < 2; ++layer) {
            for (Index t = 0; t < triangles.cols(); ++t) {
                for (int k = 0; k < 3; ++k) {
                    body.mesh.cells(k, layer * triangles.cols() + t) = int(body.layers.vertex(triangles(k, t), layer));
                    body.mesh.cells(k + 3, layer * triangles.cols() + t) = int(body.layers.vertex(triangles(k, t), layer + 1));
                }
            }
        }
        body.skin_offsets = Matrix3X<S>::Zero(3, num_columns);
    }

    /// The joint in the middle bent by `angle`.
    std::vector<AffineTransform<S>> transforms(double angle) const {
        std::vector<AffineTransform<S>> result(2);
        result[1].linear = rotation_matrix_from_rotation_vector<S>(Vector3<S>(S(0.3 * angle), S(0), S(angle)));
        return result;
    }

    /// All vertices by linear blend skinning.
    Matrix3X<S> bent(double angle) const {
        MatrixX<S> prepared;
        const LinearBlend<S> policy;
        policy.prepare_into(transforms(angle), prepared);
        Matrix3X<S> x = body.mesh.rest_positions;
        for (Index v = 0; v < x.cols(); ++v) {
            x.col(v) = policy.blend(prepared, body.weights.row(v))(x.col(v));
        }
        return x;
    }
};

}  // namespace softtissue_test
