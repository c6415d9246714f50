// SPDX-License-Identifier: MIT
// Every law of the library over the cells of a mesh, from a tissue.
#pragma once

#include "solve_kinds.hpp"

#include <softtissue/material/arap.hpp>
#include <softtissue/material/corotated_linear_field.hpp>
#include <softtissue/material/corotated_linear_polar.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/fung_orthotropic_field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>

#include <numbers>
#include <vector>

namespace reliability {

template <class S>
YoungPoisson<S> constants(const Tissue& tissue) {
    return {S(tissue.young_modulus), S(tissue.poisson_ratio)};
}

struct NeoHookeanLaw {
    template <class Mesh, class S = typename Mesh::Scalar>
    UniformField<StableNeoHookean<S>> operator()(const Mesh&, const Tissue& tissue) const {
        return {StableNeoHookean<S>::from_young_poisson(constants<S>(tissue))};
    }
};

struct FungLaw {
    template <class Mesh, class S = typename Mesh::Scalar>
    FungOrthotropicField<S> operator()(const Mesh& mesh, const Tissue& tissue) const {
        typename FungOrthotropicField<S>::Bases bases(9, mesh.num_cells());
        const std::vector<Matrix3<S>> axes = random_rotations<S>(mesh.num_cells(), std::numbers::pi, tissue.seed);
        for (size_t c = 0; c < axes.size(); ++c) {
            bases.col(Index(c)) = vec<S>(axes[c]);
        }
        return FungOrthotropicField<S>({.normal_modulus = S(0.3 * tissue.young_modulus),
                                        .tangential_modulus = S(tissue.young_modulus),
                                        .poisson_ratio = S(tissue.poisson_ratio)},
                                       bases);
    }
};

struct PolarLaw {
    template <class Mesh, class S = typename Mesh::Scalar>
    UniformField<CorotatedLinearPolar<S>> operator()(const Mesh&, const Tissue& tissue) const {
        return {CorotatedLinearPolar<S>::from_young_poisson(constants<S>(tissue))};
    }
};

struct ArapLaw {
    template <class Mesh, class S = typename Mesh::Scalar>
    UniformField<Arap<S>> operator()(const Mesh&, const Tissue& tissue) const {
        return {Arap<S>({.stiffness = S(tissue.young_modulus)})};
    }
};

/// Co-rotated in rotations that are given: those of rest.
struct GivenRotationLaw {
    template <class Mesh, class S = typename Mesh::Scalar>
    CorotatedLinearField<S> operator()(const Mesh& mesh, const Tissue& tissue) const {
        return CorotatedLinearField<S>(
            std::vector<LameParameters<S>>(size_t(mesh.num_cells()), lame_parameters(constants<S>(tissue))));
    }
};

/// All kinds of trials of one law with one element.
template <class ElementType, class S, class Law>
void run_law(Ledger& ledger, const std::string& name, bool recovers, long count, std::uint64_t seed) {
    const std::string element = ElementType::num_nodes == 4 ? "tets" : "prisms";
    const SolveKind kind{name + ", " + element + ", " + (sizeof(S) == 4 ? "float" : "double"), recovers,
                         sizeof(S) == 4 ? 1e-3 : 1e-6};
    run_solves<S>(ledger, kind, block_maker<ElementType, S>(Law()), count, seed);
}

/// What sampled_laws.cpp tries over neither scalar.
template <class S>
void run_unsampled_laws(Ledger& ledger, long count, std::uint64_t seed) {
    run_law<Tet4, S, NeoHookeanLaw>(ledger, "neo-Hookean", true, count, seed);
    run_law<Prism6, S, FungLaw>(ledger, "Fung", false, count, seed);
    run_law<Prism6, S, PolarLaw>(ledger, "polar", false, count, seed);
    run_law<Tet4, S, ArapLaw>(ledger, "ARAP", false, count, seed);
    run_law<Prism6, S, ArapLaw>(ledger, "ARAP", false, count, seed);
    run_law<Tet4, S, GivenRotationLaw>(ledger, "given rotations", true, count, seed);
    run_law<Prism6, S, GivenRotationLaw>(ledger, "given rotations", true, count, seed);
}

}  // namespace reliability
