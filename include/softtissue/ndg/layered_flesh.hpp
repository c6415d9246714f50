// SPDX-License-Identifier: MIT
/// @file
/// The quasi-static flesh of a layered body: muscle and fat as stable neo-Hookean prisms under a skin of discrete shells.
///
/// What        the equilibrium of a pose, given where the bone wrap and the cuts are: the reference that animation methods are
///             measured against and neural deformation gradients learn from.
/// Equation    E(x) = sum_p V_p psi(F_p(x)) + k_s E_stretch(x) + k_b E_bend(x),
///             psi = mu/2 (|F|^2 - 3) + lambda/2 (det F - alpha)^2 with Lamé's textbook (mu, lambda) of the layer's (E, nu)
/// Units       x m, E J, moduli Pa, k_s and k_b J
/// Method      Newton, see solver/newton.hpp: filtered Hessians while steps are long, then the exact one wherever it is positive
///             definite, in which the skin's negative curvature is left out; between them, steps by the last Hessian and what was
///             learned since, which follow soft wrinkles faster than more Hessians do. Stops by the decrement of an exact step: positions of soft wrinkles wander long after the energy stands.
/// Valid       any start, inverted prisms included: the energy has no barrier. Extreme poses have several equilibria; which one
///             is found depends on the start (see LayeredAnimation::start_dependence).
/// Source      Nolte et al. 2026, eq. (2) to (7); Smith et al. 2018; Grinspun et al. 2003
/// Departs     bending by the smooth DihedralChord by default, DihedralDifference is the source's; Hessian as above (a Hessian
///             that is filtered to the end does not converge: at equilibrium two thirds of the prisms are indefinite)
/// Linear      conjugate gradients between Gauss-Seidel sweeps by default, to a hundredth of the step's decrease; DirectSolver
///             factorises instead and finds the same equilibria within the tolerance.
/// Cost        an assembly and some ten products with the Hessian per iteration, about six iterations a pose
/// Tests       tests/unit/ndg/layered_flesh_test.cpp, tests/scenario/layered_animation_test.cpp
#pragma once

#include <softtissue/anatomy/layered_body.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/energy/convexified.hpp>
#include <softtissue/energy/dihedral_chord.hpp>
#include <softtissue/energy/edge_stretch.hpp>
#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/energy/hinge_bending.hpp>
#include <softtissue/material/elastic_constants.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/mesh/triangle_mesh.hpp>
#include <softtissue/solver/concepts.hpp>
#include <softtissue/solver/gauss_seidel_cg.hpp>
#include <softtissue/solver/newton.hpp>
#include <softtissue/solver/newton_workspace.hpp>
#include <softtissue/solver/objective.hpp>

#include <cstdint>
#include <utility>
#include <vector>

namespace softtissue {

template <RealScalar S>
struct FleshParameters {
    YoungPoisson<S> muscle = {S(45e3), S(0.47)};
    YoungPoisson<S> fat = {S(15e3), S(0.47)};
    S stretch = S(3e-2);  ///< k_s [J], every skin edge
    S bending = S(2e-3);  ///< k_b [J]
};

/// The constants of each cell's layer.
template <RealScalar S>
std::vector<LameParameters<S>> layer_moduli(const LayeredBody<S>& body, const FleshParameters<S>& parameters) {
    std::vector<LameParameters<S>> moduli(size_t(body.num_muscle_cells()), lame_parameters(parameters.muscle));
    moduli.insert(moduli.end(), size_t(body.num_fat_cells()), lame_parameters(parameters.fat));
    return moduli;
}

/// The skin's triangles in the vertices of the layered mesh.
template <RealScalar S>
TriangleMesh skin_surface(const LayeredBody<S>& body) {
    Triangles triangles = body.region.triangles;
    for (std::int32_t& v : triangles.reshaped()) {
        v = static_cast<std::int32_t>(body.layers.vertex(v, 2));
    }
    return TriangleMesh(std::move(triangles), body.layers.num_vertices(), "skin of the layered body");
}

/// Newton's options for quasi-static flesh.
template <RealScalar S>
NewtonOptions<S> quasi_static_options() {
    return {.max_iterations = 100,
            .step_tolerance = S(1e-6),
            .decrement_tolerance = S(1e-4),
            .linear_tolerance = S(0.1),
            .filter = PsdFilter::clamp,
            .far_step = S(4e-3),
            .filtered_after_failure = 2,
            .quasi_newton_steps = 20};
}

template <RealScalar S, Executor ExecutorType, NewtonLinearSolver LinearSolver = GaussSeidelCg<S>,
          HingeMeasure Measure = DihedralChord<S>>
class LayeredFlesh {
public:
    using Scalar = S;
    using Material = StableNeoHookean<Scalar>;

    /// The executor must outlive this; the body is copied as far as needed.
    LayeredFlesh(const LayeredBody<Scalar>& body, const FleshParameters<Scalar>& parameters,
                 const ExecutorType& executor)
        : rest_positions_(body.mesh.rest_positions),
          elastic_(body.mesh, materials(body, parameters)),
          stretch_(skin_surface(body), rest_positions_, parameters.stretch),
          bending_(skin_surface(body), rest_positions_, parameters.bending),
          objective_(PrescribedVertices(rest_positions_.cols(), body.prescribed), executor, elastic_, convex_stretch_,
                     convex_bending_) {}

    LayeredFlesh(const LayeredFlesh&) = delete;
    LayeredFlesh& operator=(const LayeredFlesh&) = delete;

    const PrescribedVertices& prescribed() const { return objective_.prescribed(); }

    /// E(x) [J]; at rest not 0 but sum_p V_p mu^2 / (2 lambda).
    Scalar energy(const Matrix3X<Scalar>& x) {
        displacement_ = x - rest_positions_;
        return objective_.energy(displacement_);
    }

    /// Replaces the free columns of x, from which the solve starts; the prescribed ones are given.
    template <class Observer = NoObserver>
    SolveReport<Scalar> solve_into(Matrix3X<Scalar>& x,
                                   const NewtonOptions<Scalar>& options = quasi_static_options<Scalar>(),
                                   const Observer& observer = {}) {
        require(x.cols() == rest_positions_.cols(), "layered flesh: ", x.cols(), " positions, expected ",
                rest_positions_.cols());
        displacement_ = x - rest_positions_;
        const SolveReport<Scalar> report =
            minimise(objective_, linear_solver_, displacement_, options, observer, workspace_);
        for (const std::int32_t v : prescribed().free_vertices()) {
            x.col(v) = rest_positions_.col(v) + displacement_.col(v);
        }
        return report;
    }

private:
    using Elastic = ElasticEnergy<Prism6, CellField<Material>>;

    static CellField<Material> materials(const LayeredBody<Scalar>& body, const FleshParameters<Scalar>& parameters) {
        std::vector<Material> result(size_t(body.num_muscle_cells()), Material::from_textbook_lame(parameters.muscle));
        result.insert(result.end(), size_t(body.num_fat_cells()), Material::from_textbook_lame(parameters.fat));
        return CellField<Material>(std::move(result));
    }

    Matrix3X<Scalar> rest_positions_;
    Elastic elastic_;
    EdgeStretch<Scalar> stretch_;
    HingeBending<Measure> bending_;
    Convexified<EdgeStretch<Scalar>> convex_stretch_{stretch_};
    Convexified<HingeBending<Measure>> convex_bending_{bending_};
    Objective<ExecutorType, Elastic, Convexified<EdgeStretch<Scalar>>, Convexified<HingeBending<Measure>>> objective_;
    LinearSolver linear_solver_;
    NewtonWorkspace<Scalar> workspace_;
    Matrix3X<Scalar> displacement_;
};

}  // namespace softtissue
