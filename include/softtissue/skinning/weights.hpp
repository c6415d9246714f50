// SPDX-License-Identifier: MIT
/// @file
/// Which joints move which vertex, and how much: one sparse row of weights per vertex.
///
/// What        compressed rows of (joint, weight), each row summing to one.
/// Shapes      num_vertices rows over num_joints joints; dense form num_vertices x num_joints.
/// Refuses     a weight that is not finite or negative, a row that does not sum to one within sum_tolerance
///             (InvalidInput names vertex and value). Rows within the tolerance are normalised; rows that
///             sum to one within rounding stay as they are, so that going through dense() changes no bit.
/// Tests       tests/unit/skinning/weights_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace softtissue {

template <RealScalar S>
struct JointWeight {
    std::int32_t joint;
    S weight;
};

template <RealScalar S>
class SkinningWeights {
public:
    using Scalar = S;

    /// Rows of published float32 weights miss one by about 1e-7; anything further off is an error in the data.
    static constexpr double sum_tolerance = 1e-4;

    SkinningWeights() = default;

    /// From a dense num_vertices x num_joints array; zeros are dropped.
    explicit SkinningWeights(const MatrixX<Scalar>& dense) : num_joints_(dense.cols()) {
        for (Index v = 0; v < dense.rows(); ++v) {
            const size_t first = entries_.size();
            Scalar sum(0);
            for (Index j = 0; j < dense.cols(); ++j) {
                const Scalar w = dense(v, j);
                require(std::isfinite(w) && w >= Scalar(0), "weights[", v, ", ", j, "] = ", w,
                        ", expected a finite value >= 0");
                sum += w;
                if (w > Scalar(0)) {
                    entries_.push_back({static_cast<std::int32_t>(j), w});
                }
            }
            require(std::abs(double(sum) - 1.0) <= sum_tolerance, "weights of vertex ", v, " sum to ", sum,
                    ", expected 1");
            normalize_from(first, sum);
            offsets_.push_back(entries_.size());
        }
    }

    /// From one row of (joint, weight) per vertex, joints ascending; takes no more memory than the rows.
    SkinningWeights(Index num_joints, std::span<const std::vector<JointWeight<Scalar>>> rows)
        : num_joints_(num_joints) {
        for (size_t v = 0; v < rows.size(); ++v) {
            Scalar sum(0);
            std::int32_t last = -1;
            for (const auto& [joint, weight] : rows[v]) {
                require(joint > last && joint < num_joints, "weights of vertex ", v, ": joint ", joint, ", expected ",
                        last + 1, " to ", num_joints - 1);
                require(std::isfinite(weight) && weight > Scalar(0), "weights[", v, ", ", joint, "] = ", weight,
                        ", expected a finite value > 0");
                last = joint;
                sum += weight;
            }
            require(std::abs(double(sum) - 1.0) <= sum_tolerance, "weights of vertex ", v, " sum to ", sum,
                    ", expected 1");
            const size_t first = entries_.size();
            entries_.insert(entries_.end(), rows[v].begin(), rows[v].end());
            normalize_from(first, sum);
            offsets_.push_back(entries_.size());
        }
    }

    Index num_vertices() const { return static_cast<Index>(offsets_.size()) - 1; }
    Index num_joints() const { return num_joints_; }

    /// The joints that move `vertex`, ascending, weights > 0.
    std::span<const JointWeight<Scalar>> row(Index vertex) const {
        return {entries_.data() + offsets_[size_t(vertex)], entries_.data() + offsets_[size_t(vertex) + 1]};
    }

    /// num_vertices x num_joints.
    MatrixX<Scalar> dense() const {
        MatrixX<Scalar> result = MatrixX<Scalar>::Zero(num_vertices(), num_joints_);
        for (Index v = 0; v < num_vertices(); ++v) {
            for (const auto& [joint, weight] : row(v)) {
                result(v, joint) = weight;
            }
        }
        return result;
    }

private:
    /// Divides the entries from `first` on by their sum unless that is one within rounding.
    void normalize_from(size_t first, Scalar sum) {
        const Scalar rounding = Scalar(entries_.size() - first) * std::numeric_limits<Scalar>::epsilon();
        if (std::abs(sum - Scalar(1)) > rounding) {
            for (size_t k = first; k < entries_.size(); ++k) {
                entries_[k].weight /= sum;
            }
        }
    }

    Index num_joints_ = 0;
    std::vector<size_t> offsets_{0};
    std::vector<JointWeight<Scalar>> entries_;
};

}  // namespace softtissue
