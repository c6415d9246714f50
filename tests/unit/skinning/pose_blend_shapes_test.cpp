// SPDX-License-Identifier: MIT
#include <softtissue/skinning/pose_blend_shapes.hpp>

#include <softtissue/core/random.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <vector>

using namespace softtissue;

TEST_CASE_TEMPLATE("three rows of the product, whatever columns are zero", S, float, double) {
    constexpr int num_vertices = 23, num_features = 31;
    RandomGenerator random(1);
    std::vector<Eigen::Triplet<S>> entries;
    for (int v = 0; v < num_vertices; ++v) {
        for (int c = 0; c < num_features; ++c) {
            // vertex 0 has nothing, 1 everything, the others runs of any length
            const bool is_used = v == 1 || (v > 1 && (c / (v % 7 + 1)) % 3 == 0);
            for (int d = 0; d < 3; ++d) {
                if (is_used && (c + d) % 4 != 0) {
                    entries.emplace_back(3 * v + d, c, S(random.normal()));
                } else if (v == 2) {
                    entries.emplace_back(3 * v + d, c, S(0));  // stored zeros
                }
            }
        }
    }
    typename PoseBlendShapes<S>::SparseMatrix P(3 * num_vertices, num_features);
    P.setFromTriplets(entries.begin(), entries.end());
    const PoseBlendShapes<S> shapes(P);
    REQUIRE(shapes.num_vertices() == num_vertices);
    CHECK(shapes.num_features() == num_features);
    CHECK(shapes.num_bytes() > 0);
    VectorX<S> features(num_features);
    for (int c = 0; c < num_features; ++c) {
        features(c) = S(random.normal());
    }
    for (int v = 0; v < num_vertices; ++v) {
        Vector3<S> expected = Vector3<S>::Zero();
        S size = S(1);
        for (int d = 0; d < 3; ++d) {
            for (typename PoseBlendShapes<S>::SparseMatrix::InnerIterator entry(P, 3 * v + d); entry; ++entry) {
                expected(d) += entry.value() * features(entry.col());
                size += std::abs(entry.value() * features(entry.col()));
            }
        }
        CHECK((shapes.offset(v, features) - expected).norm() <= 4 * size * std::numeric_limits<S>::epsilon());
    }
    CHECK(shapes.offset(0, features) == Vector3<S>::Zero());
}

TEST_CASE("a column that is zero for a vertex is not read: its feature may be anything") {
    Eigen::SparseMatrix<double, Eigen::RowMajor> P(6, 3);
    P.insert(4, 1) = 2.0;
    P.makeCompressed();
    const PoseBlendShapes<double> shapes(P);
    VectorX<double> features(3);
    features << std::numeric_limits<double>::quiet_NaN(), 3, std::numeric_limits<double>::infinity();
    CHECK(shapes.offset(0, features) == Vector3<double>::Zero());
    CHECK(shapes.offset(1, features) == Vector3<double>(0, 6, 0));
}

TEST_CASE("no vertices, no features") {
    CHECK(PoseBlendShapes<float>().num_vertices() == 0);
}
