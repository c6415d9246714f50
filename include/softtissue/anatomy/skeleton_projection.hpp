// SPDX-License-Identifier: MIT
/// @file
/// Points on the skeleton for points on the skin.
///
/// What        closest points on the bones, and their smoothing along the skeleton.
/// Equation    bones = segments from each joint's parent to the joint (a leaf joint is the end of its parent's bone; a
///             skeleton of one joint is that point). Smoothing, per round and inner vertex: p_i <- closest point on the bones
///             to the mean of the neighbours' p_j. Vertices on the boundary of the surface keep their projection.
/// Shapes      joints 3 x num_joints [m]; projections 3 x n [m].
/// Source      Romero et al. 2020, section 3.2.
/// Departs     a fixed number of rounds instead of "until convergence": only the boundary anchors the projections, with many
///             rounds they slide together.
/// Cost        rounds x n x bones point-segment distances
/// Tests       tests/unit/anatomy/skeleton_projection_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>
#include <softtissue/skinning/kinematic_tree.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace softtissue {

template <RealScalar S>
class BoneSegments {
public:
    BoneSegments(const KinematicTree& tree, const Matrix3X<S>& joints) {
        require(joints.cols() == tree.num_joints(), "skeleton: ", joints.cols(), " joint positions, expected ",
                tree.num_joints());
        for (Index j = 0; j < joints.cols(); ++j) {
            require(joints.col(j).allFinite(), "skeleton: position of joint ", j, " is not finite");
            if (j != tree.root()) {
                const Vector3<S> start = joints.col(tree.parent(j));
                segments_.push_back({start, joints.col(j) - start});
            }
        }
        if (segments_.empty()) {
            segments_.push_back({joints.col(0), Vector3<S>::Zero()});
        }
    }

    /// The closest point on any bone; of equally close bones the first.
    Vector3<S> closest_point(const Vector3<S>& point) const {
        Vector3<S> closest = segments_.front().start;
        S smallest = std::numeric_limits<S>::infinity();
        for (const Segment& segment : segments_) {
            const S length_squared = segment.axis.squaredNorm();
            const S along = segment.axis.dot(point - segment.start);
            const S t = length_squared > S(0) ? std::clamp(along / length_squared, S(0), S(1)) : S(0);
            const Vector3<S> candidate = segment.start + t * segment.axis;
            const S distance = (candidate - point).squaredNorm();
            if (distance < smallest) {
                smallest = distance;
                closest = candidate;
            }
        }
        return closest;
    }

private:
    struct Segment {
        Vector3<S> start, axis;
    };
    std::vector<Segment> segments_;
};

/// The projection of every vertex of `mesh` to the bones, smoothed `rounds` times.
template <RealScalar S>
Matrix3X<S> project_to_skeleton(const TriangleMesh& mesh, const Matrix3X<S>& positions, const BoneSegments<S>& bones,
                                int rounds) {
    Matrix3X<S> projections(3, positions.cols());
    for (Index v = 0; v < positions.cols(); ++v) {
        projections.col(v) = bones.closest_point(positions.col(v));
    }
    std::vector<bool> is_boundary(size_t(mesh.num_vertices()), false);
    for (const TriangleMesh::Edge& edge : mesh.edges()) {
        if (edge.is_boundary()) {
            is_boundary[size_t(edge.vertices[0])] = is_boundary[size_t(edge.vertices[1])] = true;
        }
    }
    Matrix3X<S> previous;
    for (int round = 0; round < rounds; ++round) {
        previous = projections;
        for (Index v = 0; v < positions.cols(); ++v) {
            if (is_boundary[size_t(v)]) {
                continue;
            }
            Vector3<S> mean = Vector3<S>::Zero();
            for (const std::int32_t w : mesh.neighbours(v)) {
                mean += previous.col(w);
            }
            projections.col(v) = bones.closest_point(mean / S(mesh.neighbours(v).size()));
        }
    }
    return projections;
}

}  // namespace softtissue
