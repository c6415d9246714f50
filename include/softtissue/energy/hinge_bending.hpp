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
/// Packs       as many hinges at a time as a register has lanes; a hinge's numbers do not depend on its neighbours in the pack
/// Filter      numeric, of the 9x9 Hessian without translations: the same as that of the 12x12 one
/// Convex      add_convex_hessian(), in closed form: k sum_e (f'' dtheta dtheta^T)+ + (f' d2theta)+, the second one triangle by
///             triangle (angle_curvature.hpp); the same at rest as the exact one, elsewhere about the filtered one
/// Refuses     an edge without rest length, positions that do not fit the surface, a negative stiffness, what the measure refuses
/// Source      Nolte et al. 2026, eq. (5); Grinspun et al. 2003; rigidity: Seung, Nelson 1988
/// Cost        about 2 kflop a hinge for the Hessian, some ten times that for a filtered one, 1 kflop for the convex one
/// Tests       tests/unit/energy/hinge_bending_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack_array.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/angle_curvature.hpp>
#include <softtissue/energy/hinge_invariants.hpp>
#include <softtissue/energy/placed_stencils.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/mesh/hinges.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace softtissue {

/// How much a hinge is bent, built from its rest shape; lengths are in units of the edge's rest length. Derivatives are those by
/// HingeInvariants::values(). Over<T> is the same over T, a number or a pack of numbers.
template <class M>
concept HingeMeasure = RealLanes<typename M::Scalar> && std::copy_constructible<M> &&
    requires(const M& measure, const HingeInvariants<typename M::Scalar>& hinge) {
    M(hinge);
    { measure.energy(hinge) } -> std::same_as<typename M::Scalar>;
    { measure.gradient(hinge) } -> std::same_as<typename HingeInvariants<typename M::Scalar>::Values>;
    { measure.hessian(hinge) } -> std::same_as<typename HingeInvariants<typename M::Scalar>::SquareMatrix>;
    typename M::template Over<typename M::Scalar>;
};

/// A measure that knows what of its Hessian is positive semi-definite.
template <class M>
concept HasConvexPart = HingeMeasure<M> &&
    requires(const M& measure, const HingeInvariants<typename M::Scalar>& hinge) {
    { measure.convex_part(hinge).moment } -> std::convertible_to<typename M::Scalar>;
};

template <HingeMeasure Measure>
class HingeBending {
public:
    using Scalar = typename Measure::Scalar;

    HingeBending(const TriangleMesh& surface, const Matrix3X<Scalar>& rest_positions, Scalar stiffness)
        : stencils_(stencils_of(surface, rest_positions), rest_positions),
          stiffness_(stiffness),
          inverse_lengths_(num_hinges()) {
        require(std::isfinite(stiffness) && stiffness >= Scalar(0), "hinge bending: stiffness = ", stiffness,
                " J, expected >= 0");
        for (Index h = 0; h < num_hinges(); ++h) {
            const Scalar length = stencils_.rest_edges(h).col(0).norm();
            require(length > Scalar(0), "hinge bending: edge (", hinges()(0, h), ", ", hinges()(1, h),
                    ") has rest length ", length, " m, expected > 0");
            inverse_lengths_.set(h, 0, Scalar(1) / length);
        }
        measures_.reserve(size_t(stencils_.num_packs()));
        for (Index p = 0; p < stencils_.num_packs(); ++p) {
            measures_.emplace_back(invariants(p, stencils_.packed_rest_edges(p)));
        }
    }

    Scalar stiffness() const { return stiffness_; }
    Index num_hinges() const { return stencils_.num_stencils(); }
    /// 4 x hinges, see interior_hinges().
    const Connectivity<4>& hinges() const { return stencils_.stencils(); }

    void set_placement(const Placement<Scalar>& placement) { stencils_.set_placement(placement); }

    /// Dihedral angle in (-pi, pi]: 0 where flat, positive where convex seen from outside.
    Scalar angle(const Matrix3X<Scalar>& d, Index hinge) const {
        return HingeInvariants<Scalar>(stencils_.edges(d, hinge) * inverse_lengths_.at(hinge, 0)).angle();
    }

    template <Executor E>
    Scalar energy(const Matrix3X<Scalar>& d, const E& executor) {
        return stiffness_ * stencils_.sum_packed_energy(d, executor, [&](Index pack, const Edges& edges) {
            return measure(pack).energy(invariants(pack, edges));
        });
    }

    template <Executor E>
    void add_gradient(const Matrix3X<Scalar>& d, Matrix3X<Scalar>& gradient, const E& executor) {
        stencils_.add_packed_gradient(d, gradient, executor, [&](Index pack, const Edges& edges) {
            return gradient_by_edges(pack, invariants(pack, edges));
        });
    }

    template <Executor E>
    Scalar add_energy_and_gradient(const Matrix3X<Scalar>& d, Matrix3X<Scalar>& gradient, const E& executor) {
        return stiffness_ * stencils_.add_packed_energy_and_gradient(
                                d, gradient, executor, [&](Index pack, const Edges& edges, Edges& by_edges) {
                                    const HingeInvariants<Lanes> hinge = invariants(pack, edges);
                                    by_edges = gradient_by_edges(pack, hinge);
                                    return measure(pack).energy(hinge);
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
        stencils_.add_packed_hessian(d, hessian, executor, [&](Index pack, const Edges& edges) {
            return filtered_by_positions(hessian_by_edges(pack, invariants(pack, edges)), filter);
        });
    }

    /// A positive semi-definite Hessian for a fraction of the cost; see the file comment.
    template <Executor E>
    void add_convex_hessian(const Matrix3X<Scalar>& d, BlockMatrix<Scalar>& hessian,
                            const E& executor) requires HasConvexPart<Measure> {
        stencils_.add_packed_hessian(d, hessian, executor, [&](Index pack, const Edges& edges) -> Matrix9<Lanes> {
            const Matrix3<Lanes> scaled = edges * inverse_length(pack);
            const HingeInvariants<Lanes> hinge(scaled);
            const auto part = measure(pack).convex_part(hinge);
            const typename HingeInvariants<Lanes>::Jacobian J = hinge.jacobian();
            const Eigen::Matrix<Lanes, 9, 4> curvature = angle_curvature_roots<Lanes>(scaled, part.moment);
            Matrix9<Lanes> H = Matrix9<Lanes>::Zero();
            for (int k = 0; k < part.roots.cols(); ++k) {
                add_square(J.transpose() * part.roots.col(k), H);
            }
            for (int k = 0; k < 4; ++k) {
                add_square(curvature.col(k), H);
            }
            H *= hessian_scale(pack);
            return H;
        });
    }

private:
    using Stencils = PlacedStencils<4, Scalar>;
    using Lanes = typename Stencils::Lanes;
    using Edges = Matrix3<Lanes>;
    using PackedMeasure = typename Measure::template Over<Lanes>;

    static Connectivity<4> stencils_of(const TriangleMesh& surface, const Matrix3X<Scalar>& rest_positions) {
        require(rest_positions.cols() == surface.num_vertices(),
                "hinge bending: number of rest positions = ", rest_positions.cols(), ", expected ",
                surface.num_vertices());
        return interior_hinges(surface);
    }

    const PackedMeasure& measure(Index pack) const { return measures_[size_t(pack)]; }
    const Lanes& inverse_length(Index pack) const { return inverse_lengths_.pack_at(pack, 0); }
    Lanes hessian_scale(Index pack) const { return stiffness_ * inverse_length(pack) * inverse_length(pack); }

    /// In units of the edge's rest length: products of six lengths stay within the range of float.
    HingeInvariants<Lanes> invariants(Index pack, const Edges& edges) const {
        return HingeInvariants<Lanes>(edges * inverse_length(pack));
    }

    Edges gradient_by_edges(Index pack, const HingeInvariants<Lanes>& hinge) const {
        const Lanes scale = stiffness_ * inverse_length(pack);
        return scale * unvec<Lanes>(hinge.jacobian().transpose() * measure(pack).gradient(hinge));
    }

    Matrix9<Lanes> hessian_by_edges(Index pack, const HingeInvariants<Lanes>& hinge) const {
        const typename HingeInvariants<Lanes>::Jacobian J = hinge.jacobian();
        Matrix9<Lanes> H = hinge.contracted_hessian(measure(pack).gradient(hinge));
        const typename HingeInvariants<Lanes>::SquareMatrix by_invariants = measure(pack).hessian(hinge);
        for (int j = 0; j < 9; ++j) {
            const typename HingeInvariants<Lanes>::Values column = by_invariants * J.col(j);
            for (int i = 0; i < 9; ++i) {
                for (int k = 0; k < HingeInvariants<Lanes>::size; ++k) {
                    H(i, j) += J(k, i) * column(k);
                }
            }
        }
        H *= hessian_scale(pack);
        return H;
    }

    /// H + r r^T
    static void add_square(const Vector9<Lanes>& r, Matrix9<Lanes>& H) {
        for (int j = 0; j < 9; ++j) {
            for (int i = 0; i < 9; ++i) {
                H(i, j) += r(i) * r(j);
            }
        }
    }

    /// e = T x with T T^T = I + 1 1^T = (I + 1 1^T / 3)^2: e = (I + 1 1^T / 3) y with y = Q x and orthonormal rows of Q.
    /// By y the eigenvalues are those of the Hessian by x.
    static Matrix9<Lanes> filtered_by_positions(Matrix9<Lanes> H, PsdFilter filter) {
        if (filter == PsdFilter::none) {
            return H;
        }
        add_row_sums(H, Scalar(1) / Scalar(3));
        H = filtered(H, filter);
        add_row_sums(H, Scalar(-1) / Scalar(6));
        return H;
    }

    /// H <- B H B on 3x3 blocks, B = I + factor 1 1^T.
    static void add_row_sums(Matrix9<Lanes>& H, Scalar factor) {
        const Lanes f(factor);
        const Eigen::Matrix<Lanes, 9, 3> columns =
            f * (H.template leftCols<3>() + H.template middleCols<3>(3) + H.template rightCols<3>());
        for (int b = 0; b < 3; ++b) {
            H.template middleCols<3>(3 * b) += columns;
        }
        const Eigen::Matrix<Lanes, 3, 9> rows =
            f * (H.template topRows<3>() + H.template middleRows<3>(3) + H.template bottomRows<3>());
        for (int a = 0; a < 3; ++a) {
            H.template middleRows<3>(3 * a) += rows;
        }
    }

    Stencils stencils_;
    Scalar stiffness_;
    PackArray<Scalar, 1> inverse_lengths_;
    std::vector<PackedMeasure> measures_;
};

}  // namespace softtissue
