// SPDX-License-Identifier: MIT
/// @file
/// Resistance of a skin's hinges to bending.
///
/// What        EnergyTerm over the interior edges of a surface; the measure says how an angle is compared with its rest value.
///                 HingeBending<DihedralChord<double>> bending(surface, rest_positions, 2e-3);
/// Equation    E = k sum_e f_e,  f_e = 1/2 w_e (theta - Theta)^2 near rest, w_e = L^2/A; exactly: see the measure
/// Units       k J (bending rigidity), E J
/// Scaling     independent of the mesh: a cylinder of curvature c has E = 1/2 (3 k) c^2 per area on equilateral triangles, hence
///             k = D/3 for a plate of rigidity D = Y t^3 / (12 (1 - nu^2)); the hinges' own ratio of curvatures is nu = -1/3.
/// Rest        no energy and no stress, whatever the curvature of the rest shape
/// Filter      numeric, of the 9x9 Hessian without translations: the same as that of the 12x12 one
/// Refuses     an edge without rest length, positions that do not fit the surface, a negative stiffness, what the measure refuses
/// Source      Nolte et al. 2026, eq. (5); Grinspun et al. 2003; rigidity: Seung, Nelson 1988
/// Cost        about 2 kflop a hinge for the Hessian, twice that for a filtered one
/// Tests       tests/unit/energy/hinge_bending_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/hinge_invariants.hpp>
#include <softtissue/energy/placed_stencils.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/linalg/psd_filter_batch.hpp>
#include <softtissue/mesh/hinges.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>

#include <cmath>
#include <concepts>
#include <cstdint>
#include <span>
#include <vector>

namespace softtissue {

/// How much a hinge is bent, built from its rest shape; lengths are in units of the edge's rest length. Derivatives are those by
/// HingeInvariants::values().
template <class M>
concept HingeMeasure = RealScalar<typename M::Scalar> && std::copy_constructible<M> &&
    requires(const M& measure, const HingeInvariants<typename M::Scalar>& hinge) {
    M(hinge);
    { measure.energy(hinge) } -> std::same_as<typename M::Scalar>;
    { measure.gradient(hinge) } -> std::same_as<typename HingeInvariants<typename M::Scalar>::Values>;
    { measure.hessian(hinge) } -> std::same_as<typename HingeInvariants<typename M::Scalar>::SquareMatrix>;
};

template <HingeMeasure Measure>
class HingeBending {
public:
    using Scalar = typename Measure::Scalar;

    HingeBending(const TriangleMesh& surface, const Matrix3X<Scalar>& rest_positions, Scalar stiffness)
        : stencils_(stencils_of(surface, rest_positions), rest_positions), stiffness_(stiffness) {
        require(std::isfinite(stiffness) && stiffness >= Scalar(0), "hinge bending: stiffness = ", stiffness,
                " J, expected >= 0");
        inverse_lengths_.resize(num_hinges());
        measures_.reserve(size_t(num_hinges()));
        for (Index h = 0; h < num_hinges(); ++h) {
            const Matrix3<Scalar> edges = stencils_.rest_edges(h);
            const Scalar length = edges.col(0).norm();
            require(length > Scalar(0), "hinge bending: edge (", hinges()(0, h), ", ", hinges()(1, h),
                    ") has rest length ", length, " m, expected > 0");
            inverse_lengths_(h) = Scalar(1) / length;
            measures_.emplace_back(HingeInvariants<Scalar>(edges * inverse_lengths_(h)));
        }
    }

    Scalar stiffness() const { return stiffness_; }
    Index num_hinges() const { return stencils_.num_stencils(); }
    /// 4 x hinges, see interior_hinges().
    const Connectivity<4>& hinges() const { return stencils_.stencils(); }
    const Measure& measure(Index hinge) const { return measures_[size_t(hinge)]; }

    void set_placement(const Placement<Scalar>& placement) { stencils_.set_placement(placement); }

    /// Dihedral angle in (-pi, pi]: 0 where flat, positive where convex seen from outside.
    Scalar angle(const Matrix3X<Scalar>& d, Index hinge) const {
        return invariants(hinge, stencils_.edges(d, hinge)).angle();
    }

    template <Executor E>
    Scalar energy(const Matrix3X<Scalar>& d, const E& executor) {
        return stiffness_ * stencils_.sum_energy(d, executor, [&](Index h, const Matrix3<Scalar>& edges) {
            return measure(h).energy(invariants(h, edges));
        });
    }

    template <Executor E>
    void add_gradient(const Matrix3X<Scalar>& d, Matrix3X<Scalar>& gradient, const E& executor) {
        stencils_.add_gradient(d, gradient, executor, [&](Index h, const Matrix3<Scalar>& edges) -> Matrix3<Scalar> {
            const HingeInvariants<Scalar> hinge = invariants(h, edges);
            return stiffness_ * inverse_lengths_(h) *
                   unvec<Scalar>(hinge.jacobian().transpose() * measure(h).gradient(hinge));
        });
    }

    void add_neighbours(const PrescribedVertices& prescribed,
                        std::vector<std::vector<std::int32_t>>& neighbours) const {
        stencils_.add_neighbours(prescribed, neighbours);
    }

    void bind(const PrescribedVertices& prescribed, const BlockPattern& pattern) {
        stencils_.bind(prescribed, pattern);
    }

    template <Executor E>
    void add_hessian(const Matrix3X<Scalar>& d, PsdFilter filter, BlockMatrix<Scalar>& hessian, const E& executor) {
        stencils_.template add_hessian_in_batches<8>(hessian, executor,
                                                     [&](Index first, std::span<Matrix9<Scalar>> hessians) {
                                                         for (size_t k = 0; k < hessians.size(); ++k) {
                                                             const Index h = first + Index(k);
                                                             hessians[k] = hessian_by_edges(h, stencils_.edges(d, h));
                                                         }
                                                         filter_by_positions(hessians, filter);
                                                     });
    }

private:
    static Connectivity<4> stencils_of(const TriangleMesh& surface, const Matrix3X<Scalar>& rest_positions) {
        require(rest_positions.cols() == surface.num_vertices(),
                "hinge bending: number of rest positions = ", rest_positions.cols(), ", expected ",
                surface.num_vertices());
        return interior_hinges(surface);
    }

    /// In units of the edge's rest length: products of six lengths stay within the range of float.
    HingeInvariants<Scalar> invariants(Index h, const Matrix3<Scalar>& edges) const {
        return HingeInvariants<Scalar>(edges * inverse_lengths_(h));
    }

    Matrix9<Scalar> hessian_by_edges(Index h, const Matrix3<Scalar>& edges) const {
        const HingeInvariants<Scalar> hinge = invariants(h, edges);
        const Eigen::Matrix<Scalar, HingeInvariants<Scalar>::size, 9> J = hinge.jacobian();
        Matrix9<Scalar> H = hinge.contracted_hessian(measure(h).gradient(hinge));
        H.noalias() += J.transpose() * (measure(h).hessian(hinge) * J).eval();
        H *= stiffness_ * inverse_lengths_(h) * inverse_lengths_(h);
        return H;
    }

    /// e = T x with T T^T = I + 1 1^T = (I + 1 1^T / 3)^2: e = (I + 1 1^T / 3) y with y = Q x and orthonormal rows of Q.
    /// By y the eigenvalues are those of the Hessian by x.
    static void filter_by_positions(std::span<Matrix9<Scalar>> hessians, PsdFilter filter) {
        if (filter == PsdFilter::none) {
            return;
        }
        for (Matrix9<Scalar>& H : hessians) {
            add_row_sums(H, Scalar(1) / Scalar(3));
        }
        filter_in_place<Scalar, 9>(hessians, filter);
        for (Matrix9<Scalar>& H : hessians) {
            add_row_sums(H, Scalar(-1) / Scalar(6));
        }
    }

    /// H <- B H B on 3x3 blocks, B = I + factor 1 1^T.
    static void add_row_sums(Matrix9<Scalar>& H, Scalar factor) {
        const Eigen::Matrix<Scalar, 9, 3> columns =
            factor * (H.template leftCols<3>() + H.template middleCols<3>(3) + H.template rightCols<3>());
        for (int b = 0; b < 3; ++b) {
            H.template middleCols<3>(3 * b) += columns;
        }
        const Eigen::Matrix<Scalar, 3, 9> rows =
            factor * (H.template topRows<3>() + H.template middleRows<3>(3) + H.template bottomRows<3>());
        for (int a = 0; a < 3; ++a) {
            H.template middleRows<3>(3 * a) += rows;
        }
    }

    PlacedStencils<4, Scalar> stencils_;
    Scalar stiffness_;
    VectorX<Scalar> inverse_lengths_;
    std::vector<Measure> measures_;
};

}  // namespace softtissue
