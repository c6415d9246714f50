// SPDX-License-Identifier: MIT
/// @file
/// Generalised winding number: how often a triangle surface encloses a point, for surfaces of any kind.
///
/// What        1 inside and 0 outside a closed surface that faces outwards; smooth in between where it has holes; works for
///             triangle soups, duplicates and crossings.
/// Equation    w(q) = 1/(4 pi) sum_t Omega_t(q),
///             tan(Omega/2) = det(a, b, c) / (|a||b||c| + (a.b)|c| + (b.c)|a| + (c.a)|b|), corners as seen from q.
///             Far field of a cluster around its area centroid c, d = c - q:
///             A.d / r^3 + tr M / r^3 - 3 (d.M d + l.d/2) / r^5 + 15/2 T(d, d, d) / r^7, r = |d|, from the moments of the
///             area vectors, with y = x - c: A = sum int n dA, M = sum int n y^T dA, T = sum int n (x) y (x) y dA,
///             l = sum int 2 (n.y) y + |y|^2 n dA
/// Shapes      positions and queries 3 x n [m], triangles 3 x m; w dimensionless.
/// Parameters  separation: a cluster counts as far beyond separation times its radius; larger is slower and more exact. The
///             error of w falls like separation^-4. Largest ones met on bodies, open surfaces and soups: 1e-2 for 2 (the
///             default, enough to tell inside from outside), 2e-3 for 3, 4e-4 for 4, 2e-5 for 8.
/// Valid       A triangle whose plane holds the point exactly adds 0: on a face w is the mean of both sides. A point that is
///             not finite gives NaN.
/// Refuses     corners out of range or not finite, separation below 1 (InvalidInput).
/// Source      Jacobson, Kavan, Sorkine-Hornung 2013, "Robust inside-outside segmentation using generalized winding numbers";
///             solid angle: Van Oosterom, Strackee 1983; far field: Barill et al. 2018, "Fast winding numbers for soups and
///             clouds", to second order
/// Cost        exact 60 flop and one arctangent a triangle; hierarchical about 100 flop a cluster, O(log m) clusters a query
/// Tests       tests/unit/mesh/winding_number_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/mesh/bounding_volume_hierarchy.hpp>
#include <softtissue/mesh/triangle_boxes.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

namespace softtissue {

/// The solid angle of a triangle seen from the origin, positive seen from behind; in (-2 pi, 2 pi).
template <RealScalar S>
S solid_angle(const Matrix3<S>& corners) {
    using std::atan2;
    const Vector3<S> a = corners.col(0);
    const Vector3<S> b = corners.col(1);
    const Vector3<S> c = corners.col(2);
    const S determinant = a.dot(b.cross(c));
    if (determinant == S(0)) {
        return S(0);
    }
    const S la = a.norm();
    const S lb = b.norm();
    const S lc = c.norm();
    return S(2) * atan2(determinant, la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

template <RealScalar S>
class WindingNumber {
public:
    using Scalar = S;

    WindingNumber(const Matrix3X<S>& positions, Triangles triangles, S separation = S(2))
        : triangles_(std::move(triangles)), tree_(triangle_boxes(positions, triangles_)), separation_(separation) {
        require(separation >= S(1), "winding number: separation = ", separation, ", expected at least 1");
        set_clusters(positions);
    }

    /// The same triangles at new positions; the tree stays.
    void update(const Matrix3X<S>& positions) {
        tree_.refit(triangle_boxes(positions, triangles_));
        set_clusters(positions);
    }

    /// The tree over the triangles, for other queries.
    const BoundingVolumeHierarchy<S>& tree() const { return tree_; }

    /// The sum over all triangles.
    S exact(const Vector3<S>& q) const {
        S sum(0);
        for (const Matrix3<S>& corners : slot_corners_) {
            sum += solid_angle<S>(corners.colwise() - q);
        }
        return sum / full_angle;
    }

    /// Far clusters at once.
    S operator()(const Vector3<S>& q) const {
        S sum(0);
        for (std::size_t k = 0; k < clusters_.size();) {
            const Cluster& cluster = clusters_[k];
            const Vector3<S> d = cluster.centre - q;
            const S d2 = d.squaredNorm();
            if (d2 > cluster.far2) {
                sum += cluster.far_field(d, S(1) / d2);
                k = size_t(cluster.next);
                continue;
            }
            const auto& node = tree_.nodes()[k];
            if (node.is_leaf()) {
                for (std::int32_t slot = node.begin; slot < node.end; ++slot) {
                    sum += solid_angle<S>(slot_corners_[size_t(slot)].colwise() - q);
                }
            }
            ++k;
        }
        return sum / full_angle;
    }

    /// One number per query.
    template <Executor Exec = SequentialExecutor>
    void evaluate_into(ConstRef<Matrix3X<S>> queries, Eigen::Ref<VectorX<S>> out, const Exec& executor = {}) const {
        SOFTTISSUE_ASSERT(out.size() == queries.cols());
        executor.for_each_range(queries.cols(), [&](Index begin, Index end) {
            for (Index i = begin; i < end; ++i) {
                out(i) = (*this)(queries.col(i));
            }
        });
    }

private:
    static constexpr S full_angle = S(4) * std::numbers::pi_v<S>;

    struct Cluster {
        Vector3<S> centre;
        S far2;  ///< beyond this squared distance the far field stands for the triangles
        std::int32_t next;
        Vector3<S> area = Vector3<S>::Zero();                            ///< A
        Matrix3<S> first = Matrix3<S>::Zero();                           ///< M
        Vector3<S> linear = Vector3<S>::Zero();                          ///< l
        Eigen::Matrix<S, 3, 6> second = Eigen::Matrix<S, 3, 6>::Zero();  ///< T, columns xx yy zz 2xy 2xz 2yz

        S far_field(const Vector3<S>& d, S inverse2) const {
            Eigen::Matrix<S, 6, 1> products;
            products << d.cwiseAbs2(), d(0) * d(1), d(0) * d(2), d(1) * d(2);
            const S r3 = area.dot(d) + first.trace();
            const S r5 = S(-3) * (d.dot(first * d) + S(0.5) * linear.dot(d));
            const S r7 = S(7.5) * d.dot(second * products);
            return inverse2 * std::sqrt(inverse2) * (r3 + inverse2 * (r5 + inverse2 * r7));
        }

        /// Adds the moments of a triangle with the given corners, relative to the centre.
        void add(const Matrix3<S>& corners) {
            const Vector3<S> a = area_vector(corners);
            const Vector3<S> middle = corners.rowwise().mean();
            const Matrix3<S> spread =
                (corners * corners.transpose() + S(9) * middle * middle.transpose()) / S(12);  // mean of y y^T
            area += a;
            first += a * middle.transpose();
            linear += S(2) * (spread * a) + spread.trace() * a;
            second.template leftCols<3>() += a * spread.diagonal().transpose();
            second.col(3) += S(2) * spread(0, 1) * a;
            second.col(4) += S(2) * spread(0, 2) * a;
            second.col(5) += S(2) * spread(1, 2) * a;
        }
    };

    static Vector3<S> area_vector(const Matrix3<S>& corners) {
        const Vector3<S> e1 = corners.col(1) - corners.col(0);
        const Vector3<S> e2 = corners.col(2) - corners.col(0);
        return S(0.5) * e1.cross(e2);
    }

    void set_clusters(const Matrix3X<S>& positions) {
        slot_corners_.resize(tree_.slot_items().size());
        for (std::size_t slot = 0; slot < slot_corners_.size(); ++slot) {
            slot_corners_[slot] = triangle_corners(positions, triangles_, tree_.slot_items()[slot]);
        }
        clusters_.clear();
        clusters_.reserve(tree_.nodes().size());
        for (const auto& node : tree_.nodes()) {
            clusters_.push_back(make_cluster(node));
        }
    }

    Cluster make_cluster(const typename BoundingVolumeHierarchy<S>::Node& node) const {
        Cluster cluster{Vector3<S>::Zero(), S(0), node.next};
        const Vector3<S> middle = node.box.center();
        S weight(0);
        for (std::int32_t slot = node.begin; slot < node.end; ++slot) {
            const Matrix3<S>& corners = slot_corners_[size_t(slot)];
            const S area = area_vector(corners).norm();
            cluster.centre += area * (corners.rowwise().mean() - middle);
            weight += area;
        }
        cluster.centre = weight > S(0) ? Vector3<S>(middle + cluster.centre / weight) : middle;
        S radius2(0);
        for (std::int32_t slot = node.begin; slot < node.end; ++slot) {
            const Matrix3<S> corners = slot_corners_[size_t(slot)].colwise() - cluster.centre;
            cluster.add(corners);
            radius2 = std::max(radius2, corners.colwise().squaredNorm().maxCoeff());
        }
        cluster.far2 = separation_ * separation_ * radius2;
        return cluster;
    }

    Triangles triangles_;
    BoundingVolumeHierarchy<S> tree_;
    S separation_;
    std::vector<Matrix3<S>> slot_corners_;
    std::vector<Cluster> clusters_;
};

}  // namespace softtissue
