// SPDX-License-Identifier: MIT
/// @file
/// The corners and the bounding boxes of triangles, for trees over them.
///
/// Shapes      positions 3 x n [m], triangles 3 x m; corners 3x3, one a column.
/// Refuses     triangle_boxes(): a corner out of range or not finite (InvalidInput names triangle and vertex).
/// Tests       tests/unit/mesh/triangle_boxes_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/bounding_volume_hierarchy.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace softtissue {

template <RealScalar S>
Matrix3<S> triangle_corners(const Matrix3X<S>& positions, const Triangles& triangles, Index triangle) {
    Matrix3<S> corners;
    for (int k = 0; k < 3; ++k) {
        corners.col(k) = positions.col(triangles(k, triangle));
    }
    return corners;
}

template <RealScalar S>
std::vector<Box<S>> triangle_boxes(const Matrix3X<S>& positions, const Triangles& triangles) {
    std::vector<Box<S>> boxes;
    boxes.reserve(static_cast<std::size_t>(triangles.cols()));
    for (Index t = 0; t < triangles.cols(); ++t) {
        boxes.emplace_back();
        for (int k = 0; k < 3; ++k) {
            const std::int32_t v = triangles(k, t);
            require(v >= 0 && v < positions.cols(), "triangle ", t, " uses vertex ", v, ", expected 0 to ",
                    positions.cols() - 1);
            require(positions.col(v).allFinite(), "triangle ", t, ": position of vertex ", v, " is not finite");
            boxes.back().extend(positions.col(v));
        }
    }
    return boxes;
}

}  // namespace softtissue
