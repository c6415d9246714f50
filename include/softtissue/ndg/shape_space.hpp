// SPDX-License-Identifier: MIT
/// @file
/// The shapes of layered bodies as a few numbers.
///
/// What        principal components of the rest positions of all vertices of all layers, over many bodies.
/// Equation    PCA: R^(3 N_v) -> R^d, b = diag(s)^-1 C^T (vec X - mean)
/// Shapes      rest positions 3 x vertices [m]; coefficients in standard deviations
/// Valid       any body of the same connectivity; one unlike those of the training gets large coefficients
/// Refuses     bodies of different sizes, what principal_components() refuses, positions or coefficients that are not finite
///             (InvalidInput)
/// Source      Nolte et al. 2026, eq. (13)
/// Tests       tests/unit/ndg/shape_space_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/principal_components.hpp>

#include <cmath>
#include <utility>
#include <vector>

namespace softtissue {

template <RealScalar S>
class ShapeSpace {
public:
    using Scalar = S;

    /// Of nothing.
    ShapeSpace() = default;

    explicit ShapeSpace(PrincipalComponents<S> components) : components_(std::move(components)) {
        const PrincipalComponents<S>& c = components_;
        require(c.mean.size() % 3 == 0 && c.components.rows() == c.mean.size() &&
                    c.standard_deviations.size() == c.components.cols(),
                "shape space: a mean of ", c.mean.size(), " numbers, components of ", c.components.rows(), " x ",
                c.components.cols(), ", ", c.standard_deviations.size(),
                " deviations, expected three numbers a vertex");
        require(c.mean.allFinite() && c.components.allFinite() && c.standard_deviations.allFinite() &&
                    (c.standard_deviations.array() > S(0)).all(),
                "shape space: expected finite numbers and positive deviations");
    }

    /// From the rest positions of bodies.
    template <Executor E = SequentialExecutor>
    static ShapeSpace from_bodies(const std::vector<Matrix3X<S>>& bodies, const PrincipalComponentsOptions& options,
                                  const E& executor = {}) {
        require(!bodies.empty(), "shape space: no bodies");
        MatrixX<S> samples(bodies.front().size(), Index(bodies.size()));
        for (size_t b = 0; b < bodies.size(); ++b) {
            require(bodies[b].size() == samples.rows(), "shape space: body ", b, " has ", bodies[b].cols(),
                    " vertices, expected ", samples.rows() / 3);
            samples.col(Index(b)) = bodies[b].reshaped();
        }
        return ShapeSpace(principal_components<S>(std::move(samples), options, executor));
    }

    Index num_vertices() const { return components_.mean.size() / 3; }
    Index num_coefficients() const { return components_.num_components(); }
    const PrincipalComponents<S>& components() const { return components_; }

    VectorX<S> encode(const Matrix3X<S>& rest_positions) const {
        require(rest_positions.cols() == num_vertices(), "shape space: a body of ", rest_positions.cols(),
                " vertices, expected ", num_vertices());
        for (Index v = 0; v < num_vertices(); ++v) {
            require(rest_positions.col(v).allFinite(), "shape space: rest position of vertex ", v, " is not finite");
        }
        return components_.encode(rest_positions.reshaped());
    }

    Matrix3X<S> decode(const VectorX<S>& coefficients) const {
        for (Index k = 0; k < coefficients.size(); ++k) {
            require(std::isfinite(coefficients(k)), "shape space: coefficient ", k, " = ", coefficients(k),
                    ", expected a finite value");
        }
        return components_.decode(coefficients).reshaped(3, num_vertices());
    }

private:
    PrincipalComponents<S> components_;
};

}  // namespace softtissue
