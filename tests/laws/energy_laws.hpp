// SPDX-License-Identifier: MIT
// The laws of elastic energies over one element: derivatives and invariances, in every strain frame, for every material.
#pragma once

#include <softtissue/energy/elastic_energy.hpp>
#include <softtissue/energy/strain_frame.hpp>
#include <softtissue/material/arap.hpp>
#include <softtissue/material/corotated_linear_polar.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/fung_orthotropic_field.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/solver/objective.hpp>
#include <softtissue/testing/taylor_rate.hpp>

#include <support/solid_block.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

namespace softtissue_test {

/// A material for every cell; stiffness of about 1 Pa, so that float has no large numbers to carry.
template <class Field>
struct Make;
template <class S>
struct Make<UniformField<StableNeoHookean<S>>> {
    static auto field(Index, RandomGenerator&) {
        return UniformField{StableNeoHookean<S>::from_young_poisson({S(1), S(0.4)})};
    }
};
template <class S>
struct Make<UniformField<Arap<S>>> {
    static auto field(Index, RandomGenerator&) { return UniformField{Arap<S>()}; }
};
template <class S>
struct Make<UniformField<CorotatedLinearPolar<S>>> {
    static auto field(Index, RandomGenerator&) {
        return UniformField{CorotatedLinearPolar<S>::from_young_poisson({S(1), S(0.4)})};
    }
};
template <class S>
struct Make<FungOrthotropicField<S>> {
    static auto field(Index num_cells, RandomGenerator& random) {
        typename FungOrthotropicField<S>::Bases bases(9, num_cells);
        for (Index c = 0; c < num_cells; ++c) {
            bases.col(c) = vec<S>(random_rotation<S>(random));
        }
        return FungOrthotropicField<S>({.normal_modulus = S(1), .tangential_modulus = S(3), .exponent = S(2)}, bases);
    }
};

/// A block in a pose that no skeleton made: any affine map at each vertex, a random displacement on top.
template <class ElementType, class Field, class Frame>
struct EnergyLaws {
    using S = typename MaterialOf<Field>::Scalar;
    using Elastic = ElasticEnergy<ElementType, Field>;

    RandomGenerator random{11};
    CellMesh<ElementType, S> mesh = solid_block<ElementType, S>({.n = 2, .plan_noise = 0.05, .noise = 0.05}).mesh;
    Index n = mesh.num_vertices();
    Elastic elastic{mesh, Make<Field>::field(mesh.num_cells(), random)};
    Placement<S> placement;
    SequentialExecutor executor;
    Objective<SequentialExecutor, Elastic> objective{PrescribedVertices(n, {}), executor, elastic};
    Matrix3X<S> d = random_displacement<S>(n, 0.03, random);

    EnergyLaws() {
        Placement<S> skinned;
        const Matrix3<S> R = random_rotation<S>(random);
        skinned.origins = R * mesh.rest_positions + random_displacement<S>(n, 0.02, random);
        skinned.maps.resize(3, 3 * n);
        for (Index v = 0; v < n; ++v) {
            skinned.maps.template middleCols<3>(3 * v) =
                R * (Matrix3<S>::Identity() + S(0.2) * random_normal<Matrix3<S>>(random));
        }
        Frame::apply(mesh, skinned, elastic, placement);
    }

    void check_derivatives() {
        for (int sample = 0; sample < 3; ++sample) {
            const Matrix3X<S> D = random_displacement<S>(n, 0.2, random);
            const auto energy = [&](S h) { return objective.energy(d + h * D); };
            const S slope = objective.full_gradient(d).cwiseProduct(D).sum();
            const TaylorRate of_energy = taylor_rate(energy, slope);
            CAPTURE(of_energy.order);
            CHECK(of_energy.is_at_least(2));
            const auto gradient = [&](S h) -> Matrix3X<S> { return objective.full_gradient(d + h * D); };
            const VectorX<S> product = objective.hessian(d, PsdFilter::none).matrix() * VectorX<S>(D.reshaped());
            const Matrix3X<S> change = product.reshaped(3, n);
            const TaylorRate of_gradient = taylor_rate(gradient, change);
            CAPTURE(of_gradient.order);
            CHECK(of_gradient.is_at_least(2));
        }
    }

    /// The energy is that of a shape: rest + d in unposed space, p + d in the world.
    void check_invariance() {
        const S epsilon = std::numeric_limits<S>::epsilon();
        const Matrix3X<S> origin = Frame::is_unposed ? mesh.rest_positions : placement.origins;
        const Matrix3<S> R = random_rotation<S>(random);
        const Vector3<S> t(S(0.3), S(-0.2), S(0.1));
        const Matrix3X<S> moved = ((R * (origin + d)).colwise() + t) - origin;
        const S energy = objective.energy(d);
        REQUIRE(energy > S(0.01));
        CHECK(std::abs(objective.energy(moved) / energy - S(1)) < 256 * epsilon);
        // forces turn along; no net force, no net torque
        const Matrix3X<S> forces = objective.full_gradient(d);
        const S size = forces.cwiseAbs().sum();
        CHECK((objective.full_gradient(moved) - R * forces).cwiseAbs().sum() < 256 * epsilon * size);
        CHECK(forces.rowwise().sum().norm() < 64 * epsilon * size);
        Vector3<S> torque = Vector3<S>::Zero();
        for (Index v = 0; v < n; ++v) {
            torque += (origin.col(v) + d.col(v)).cross(forces.col(v));
        }
        CHECK(torque.norm() < 256 * epsilon * size);
    }
};

template <class ElementType, class Field>
void check_energy_laws() {
    EnergyLaws<ElementType, Field, UnposedFrame> unposed;
    EnergyLaws<ElementType, Field, WorldFrame> world;
    EnergyLaws<ElementType, Field, RestRetargetedFrame> retargeted;
    SUBCASE("derivatives, unposed") { unposed.check_derivatives(); }
    SUBCASE("derivatives, world") { world.check_derivatives(); }
    SUBCASE("derivatives, retargeted") { retargeted.check_derivatives(); }
    SUBCASE("invariance, unposed") { unposed.check_invariance(); }
    SUBCASE("invariance, world") { world.check_invariance(); }
    SUBCASE("invariance, retargeted") { retargeted.check_invariance(); }
}

}  // namespace softtissue_test

#define EVERY_FIELD                                                                                             \
    UniformField<StableNeoHookean<double>>, UniformField<Arap<double>>, UniformField<CorotatedLinearPolar<double>>, \
        FungOrthotropicField<double>, UniformField<StableNeoHookean<float>>, UniformField<Arap<float>>,          \
        UniformField<CorotatedLinearPolar<float>>, FungOrthotropicField<float>
