// SPDX-License-Identifier: MIT
/// @file
/// Resistance of a skin's edges to a change of length.
///
/// What        EnergyTerm over all edges of a surface, boundary included; membrane_edge_stiffnesses() for a given material.
/// Equation    E = 1/2 sum_e k_e (l - L)^2 / L^2,  l and L the current and rest length
///             d2E/de2 = k_e / L^2 (t t^T + (1 - L/l) (I - t t^T)),  t the edge's direction
/// Units       k J, l m, energy J
/// Scaling     One k for all edges (as in the source) is not mesh independent: halving the edges quadruples their number, each
///             with the same relative elongation. Under strain eps an edge elongates by t.eps t; over all directions the mean
///             of (t.eps t)^2 is (2 eps:eps + tr(eps)^2)/8. With an area a_e = (A_1 + A_2)/3 for each edge (these tile the
///             surface) the energy per area is k_e/a_e (2 eps:eps + tr(eps)^2)/16: a membrane of Poisson's ratio 1/3 (mu =
///             lambda) and modulus Y t = k_e / (3 a_e) [N/m], exact on equilateral triangles. Hence k_e = 3 Y t a_e.
/// Packs       as many edges at a time as a register has lanes; an edge's numbers do not depend on its neighbours in the pack
/// Filter      closed form: the eigenvalues are 1 (along t) and 1 - L/l (across); only the latter is negative, in compression.
/// Valid       l > 0. At l = 0 the energy has a kink: the gradient there is taken as 0, the Hessian as k_e / L^2 I.
/// Refuses     an edge without rest length, positions or stiffnesses that do not fit the surface, a negative stiffness
/// Source      Nolte et al. 2026, eq. (6); Grinspun et al. 2003
/// Tests       tests/unit/energy/edge_stretch_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack_array.hpp>
#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/energy/placed_stencils.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/mesh/surface_normals.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>

#include <cmath>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

namespace softtissue {

/// Stiffness [J] of every edge of a membrane of the given modulus: Young's modulus times thickness [N/m].
template <RealScalar S>
VectorX<S> membrane_edge_stiffnesses(const TriangleMesh& surface, const Matrix3X<S>& rest_positions,
                                     std::type_identity_t<S> membrane_modulus) {
    const VectorX<S> areas = triangle_areas<S>(rest_positions, surface.triangles());
    VectorX<S> stiffnesses(Index(surface.edges().size()));
    for (Index e = 0; e < stiffnesses.size(); ++e) {
        const TriangleMesh::Edge& edge = surface.edges()[size_t(e)];
        const S area = areas(edge.triangles[0]) + (edge.is_boundary() ? S(0) : areas(edge.triangles[1]));
        stiffnesses(e) = membrane_modulus * area;  // 3 Y t (A_1 + A_2) / 3
    }
    return stiffnesses;
}

template <RealScalar S>
class EdgeStretch {
public:
    using Scalar = S;

    /// The same stiffness [J] for every edge.
    EdgeStretch(const TriangleMesh& surface, const Matrix3X<Scalar>& rest_positions, Scalar stiffness)
        : EdgeStretch(surface, rest_positions, VectorX<Scalar>::Constant(Index(surface.edges().size()), stiffness)) {}

    /// A stiffness [J] for each of surface.edges().
    EdgeStretch(const TriangleMesh& surface, const Matrix3X<Scalar>& rest_positions, VectorX<Scalar> stiffnesses)
        : stencils_(stencils_of(surface, rest_positions), rest_positions), stiffnesses_(std::move(stiffnesses)) {
        require(stiffnesses_.size() == num_edges(), "edge stretch: number of stiffnesses = ", stiffnesses_.size(),
                ", expected one for each of ", num_edges(), " edges");
        rest_lengths_.resize(num_edges());
        packs_ = PackArray<Scalar, 2>(num_edges());
        for (Index e = 0; e < num_edges(); ++e) {
            // in packs like all lengths: those at rest must not differ by rounding
            rest_lengths_(e) = length_of(stencils_.packed_rest_edges(e / width))[int(e % width)];
            packs_.set(e, 0, rest_lengths_(e));
            packs_.set(e, 1, stiffnesses_(e));
            require(rest_lengths_(e) > Scalar(0), "edge stretch: edge (", edges()(0, e), ", ", edges()(1, e),
                    ") has rest length ", rest_lengths_(e), " m, expected > 0");
            require(std::isfinite(stiffnesses_(e)) && stiffnesses_(e) >= Scalar(0), "edge stretch: stiffness of edge ",
                    e, " = ", stiffnesses_(e), " J, expected >= 0");
        }
    }

    Index num_edges() const { return stencils_.num_stencils(); }
    /// 2 x edges, as surface.edges().
    const Connectivity<2>& edges() const { return stencils_.stencils(); }
    const VectorX<Scalar>& rest_lengths() const { return rest_lengths_; }
    const VectorX<Scalar>& stiffnesses() const { return stiffnesses_; }

    void set_placement(const Placement<Scalar>& placement) { stencils_.set_placement(placement); }

    /// Drops the negative eigenvalues of compressed edges from the Hessian even where no filter is asked for. Slack skin then
    /// no longer makes the Hessian of a body indefinite, at the price of linear instead of quadratic convergence.
    void set_tension_only_hessian(bool is_tension_only) { is_tension_only_ = is_tension_only; }

    template <Executor E>
    Scalar energy(const Matrix3X<Scalar>& d, const E& executor) {
        return stencils_.sum_packed_energy(
            d, executor, [&](Index pack, const PackedEdge& edge) { return energies(pack, length_of(edge)); });
    }

    template <Executor E>
    void add_gradient(const Matrix3X<Scalar>& d, Matrix3X<Scalar>& gradient, const E& executor) {
        stencils_.add_packed_gradient(d, gradient, executor, [&](Index pack, const PackedEdge& edge) {
            return gradients(pack, edge, length_of(edge));
        });
    }

    template <Executor E>
    Scalar add_energy_and_gradient(const Matrix3X<Scalar>& d, Matrix3X<Scalar>& gradient, const E& executor) {
        return stencils_.add_packed_energy_and_gradient(d, gradient, executor,
                                                        [&](Index pack, const PackedEdge& edge, PackedEdge& by_edges) {
                                                            const Lanes length = length_of(edge);
                                                            by_edges = gradients(pack, edge, length);
                                                            return energies(pack, length);
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
        const PsdFilter applied = filter == PsdFilter::none && is_tension_only_ ? PsdFilter::clamp : filter;
        stencils_.add_packed_hessian(d, hessian, executor, [&](Index pack, const PackedEdge& edge) -> Matrix3<Lanes> {
            const Lanes length = length_of(edge);
            const auto is_long = length > Lanes(0);
            const Lanes ratio = rest_length(pack) / select(is_long, length, Lanes(1));
            const Lanes across = select(is_long, filtered_eigenvalue(Lanes(1 - ratio), applied), Lanes(1));
            const Lanes k = spring_constant(pack);
            const PackedEdge t = inverse_of(length) * edge;
            Matrix3<Lanes> H = (k * (1 - across)) * t * t.transpose();
            for (int i = 0; i < 3; ++i) {
                H(i, i) += k * across;
            }
            return H;
        });
    }

private:
    using Stencils = PlacedStencils<2, Scalar>;
    using Lanes = typename Stencils::Lanes;
    using PackedEdge = Vector3<Lanes>;
    static constexpr int width = Stencils::width;

    static Connectivity<2> stencils_of(const TriangleMesh& surface, const Matrix3X<Scalar>& rest_positions) {
        require(rest_positions.cols() == surface.num_vertices(),
                "edge stretch: number of rest positions = ", rest_positions.cols(), ", expected ",
                surface.num_vertices());
        Connectivity<2> edges(2, Index(surface.edges().size()));
        for (Index e = 0; e < edges.cols(); ++e) {
            const auto [from, to] = surface.edges()[size_t(e)].vertices;
            edges.col(e) << from, to;
        }
        return edges;
    }

    const Lanes& rest_length(Index pack) const { return packs_.pack_at(pack, 0); }
    Lanes spring_constant(Index pack) const {
        return packs_.pack_at(pack, 1) / (rest_length(pack) * rest_length(pack));
    }

    static Lanes length_of(const PackedEdge& edge) {
        return sqrt(edge(0) * edge(0) + edge(1) * edge(1) + edge(2) * edge(2));
    }
    /// 0 for an edge without length.
    static Lanes inverse_of(const Lanes& length) {
        const auto is_long = length > Lanes(0);
        return select(is_long, 1 / select(is_long, length, Lanes(1)), Lanes(0));
    }

    Lanes energies(Index pack, const Lanes& length) const {
        const Lanes strain = (length - rest_length(pack)) / rest_length(pack);
        return Scalar(0.5) * packs_.pack_at(pack, 1) * strain * strain;
    }
    PackedEdge gradients(Index pack, const PackedEdge& edge, const Lanes& length) const {
        return (spring_constant(pack) * (length - rest_length(pack)) * inverse_of(length)) * edge;
    }

    Stencils stencils_;
    VectorX<Scalar> stiffnesses_;
    VectorX<Scalar> rest_lengths_;
    PackArray<Scalar, 2> packs_;  // rest lengths, stiffnesses
    bool is_tension_only_ = false;
};

}  // namespace softtissue
