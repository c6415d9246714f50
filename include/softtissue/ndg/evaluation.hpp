// SPDX-License-Identifier: MIT
/// @file
/// How good an animation method is over many posed bodies: the figures of one, and what they come to.
///
/// What        PoseFigures of one posed body against the reference; MethodEvaluation collects them and says mean, standard
///             error and worst of each, and the mean error of every vertex. Any method serves: all it needs is positions.
/// Equation    figures: E_pos, E_grad, E_inv, E_vol, see metric/; mean m = sum_i e_i / n,
///             standard error = sqrt(sum_i (e_i - m)^2 / (n (n - 1)));
///             difference(): the same of a_i - b_i, the i-th pose of two methods being the same posed body
/// Shapes      x, reference 3 x vertices [m]; vertex errors one per vertex [m]
/// Valid       no poses give 0, one pose a standard error of 0. A figure that is not finite makes mean and worst not finite.
///             Sums run in the order of add(): add in the order of the poses, whatever order they were measured in.
/// Refuses     arrays of different sizes, methods of different numbers of poses (InvalidInput)
/// Source      Nolte et al. 2026, sec. 5.1, tables 1, 2, 4 and fig. 7
/// Tests       tests/unit/ndg/evaluation_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/energy/rest_operators.hpp>
#include <softtissue/mesh/cell_mesh.hpp>
#include <softtissue/metric/gradient_error.hpp>
#include <softtissue/metric/position_error.hpp>
#include <softtissue/metric/volume_change.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace softtissue {

template <RealScalar S>
struct PoseFigures {
    S position = S(0);          ///< E_pos [m]
    S largest_position = S(0);  ///< of one vertex [m]
    S gradient = S(0);          ///< E_grad
    Index inverted = 0;         ///< E_inv
    S volume = S(0);            ///< E_vol, the mean over the cells
    double milliseconds = 0.0;  ///< what the method took; the caller's to fill
};

/// What needs no reference: inversions and volume.
template <class ElementType, RealScalar S>
PoseFigures<S> measure_pose(const CellMesh<ElementType, S>& mesh, const Matrix3X<S>& x) {
    const VolumeChange<S> change = volume_change(mesh, x);
    PoseFigures<S> figures;
    figures.inverted = change.num_inverted;
    figures.volume = change.mean_square;
    return figures;
}

/// All figures.
template <class ElementType, RealScalar S>
PoseFigures<S> measure_pose(const CellMesh<ElementType, S>& mesh, const RestOperators<ElementType, S>& operators,
                            const PrescribedVertices& prescribed, const Matrix3X<S>& x, const Matrix3X<S>& reference) {
    PoseFigures<S> figures = measure_pose(mesh, x);
    const PositionError<S> error = position_error(x, reference, prescribed);
    figures.position = error.mean;
    figures.largest_position = error.largest;
    figures.gradient = gradient_error(mesh, operators, x, reference);
    return figures;
}

/// |x_v - x^_v| of every vertex [m].
template <RealScalar S>
VectorX<S> vertex_errors(const Matrix3X<S>& x, const Matrix3X<S>& reference) {
    require(x.cols() == reference.cols(), "vertex errors: ", x.cols(), " positions and ", reference.cols(),
            " reference positions, expected equal numbers");
    return (x - reference).colwise().norm().transpose();
}

/// One figure over all poses.
struct FigureSummary {
    double mean = 0.0;
    double standard_error = 0.0;
    double worst = 0.0;     ///< the largest
    Index worst_pose = -1;  ///< -1 without poses
};

inline FigureSummary summarise(const std::vector<double>& values) {
    FigureSummary summary;
    for (size_t i = 0; i < values.size(); ++i) {
        summary.mean += values[i] / double(values.size());
        if (i == 0 || (!std::isnan(summary.worst) && !(values[i] <= summary.worst))) {
            summary.worst = values[i];
            summary.worst_pose = static_cast<Index>(i);
        }
    }
    if (values.size() > 1) {
        double squares = 0.0;
        for (const double value : values) {
            squares += (value - summary.mean) * (value - summary.mean);
        }
        summary.standard_error = std::sqrt(squares / (double(values.size()) * double(values.size() - 1)));
    }
    return summary;
}

template <RealScalar S>
class MethodEvaluation {
public:
    using Scalar = S;

    void add(const PoseFigures<S>& figures) { poses_.push_back(figures); }

    /// Takes the vertex errors of the pose in as well: give them for all poses or for none.
    void add(const PoseFigures<S>& figures, const VectorX<S>& errors) {
        if (num_vertex_poses_ == 0) {
            vertex_sums_ = VectorX<double>::Zero(errors.size());
        }
        require(errors.size() == vertex_sums_.size(), "method evaluation: ", errors.size(), " vertex errors, expected ",
                vertex_sums_.size(), " as in the first pose");
        vertex_sums_ += errors.template cast<double>();
        ++num_vertex_poses_;
        add(figures);
    }

    Index num_poses() const { return static_cast<Index>(poses_.size()); }
    const std::vector<PoseFigures<S>>& poses() const { return poses_; }

    /// Of one member of PoseFigures: summary(&PoseFigures<S>::gradient).
    template <class T>
    FigureSummary summary(T PoseFigures<S>::*figure) const {
        return summarise(values(figure));
    }

    template <class T>
    std::vector<double> values(T PoseFigures<S>::*figure) const {
        std::vector<double> result;
        for (const PoseFigures<S>& pose : poses_) {
            result.push_back(static_cast<double>(pose.*figure));
        }
        return result;
    }

    /// Mean over the poses that came with vertex errors [m]; empty if none did.
    VectorX<S> mean_vertex_errors() const {
        return (vertex_sums_ / std::max(1.0, double(num_vertex_poses_))).template cast<S>();
    }

private:
    std::vector<PoseFigures<S>> poses_;
    VectorX<double> vertex_sums_;
    Index num_vertex_poses_ = 0;
};

/// How much larger a figure is by method a than by method b, pose by pose.
template <RealScalar S, class T>
FigureSummary difference(const MethodEvaluation<S>& a, const MethodEvaluation<S>& b, T PoseFigures<S>::*figure) {
    require(a.num_poses() == b.num_poses(), "difference of methods: ", a.num_poses(), " and ", b.num_poses(),
            " poses, expected equal numbers");
    std::vector<double> differences = a.values(figure);
    const std::vector<double> subtracted = b.values(figure);
    for (size_t i = 0; i < differences.size(); ++i) {
        differences[i] -= subtracted[i];
    }
    return summarise(differences);
}

}  // namespace softtissue
