// SPDX-License-Identifier: MIT
/// @file
/// A complete material from an energy density alone: stress and Hessian by automatic differentiation.
///
///     struct MyMaterial {
///         double mu = 1e4;
///         template <class S>
///         S energy_density(const Eigen::Matrix<S, 3, 3>& F) const {
///             const S J = F.determinant();
///             return mu * (F.squaredNorm() - 3 + (J - 2) * (J - 2) - 1);
///         }
///     };
///     const FromEnergy material{MyMaterial{.mu = 2e4}};   // FromEnergy<MyMaterial>, in double
///
/// What        energy density, first Piola stress, Hessian of F
/// Equation    P = d psi / d F,  H = d^2 psi / d vec(F)^2, exact to round-off, no step length
/// Shapes      F, P: 3x3.  H: 9x9 on column-major vec(F), exactly symmetric.
/// Units       those of the user's energy; J/m^3 in gives Pa out.
/// Valid       where the energy is twice differentiable; a branch is differentiated as the piece it takes
/// Cost        a product in the energy becomes 19 in the stress and 361 in the Hessian: right at once, and the
///             reference for hand-written derivatives, which are far cheaper
/// Tests       tests/unit/material/from_energy_test.cpp, tests/laws/material_laws_test.cpp
#pragma once

#include <softtissue/core/dual.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Geometry>  // cross(), and with LU
#include <Eigen/LU>        // determinant(), inverse(): a user's energy needs no include of its own

#include <concepts>
#include <cstddef>

namespace softtissue {

/// Has `template <class S> S energy_density(const Eigen::Matrix<S, 3, 3>& F) const`; shown for one S.
template <class E, class S>
concept HasEnergyDensity = requires(const E& energy, const Matrix3<S>& F) {
    { energy.energy_density(F) } -> std::same_as<S>;
};

/// An energy that can be differentiated twice: it takes numbers and numbers with derivatives.
template <class E, class Scalar = double>
concept EnergyDensityOnly = std::copy_constructible<E> && HasEnergyDensity<E, Scalar> &&
                            HasEnergyDensity<E, Dual<Scalar, 9>> && HasEnergyDensity < E,
        Dual < Dual<Scalar, 9>,
9 >> ;

/// The hyperelastic material of a user's energy density.
template <class UserEnergy, FieldScalar S = double>
struct FromEnergy {
    static_assert(
        EnergyDensityOnly<UserEnergy, S>,
        "FromEnergy needs a type with the member "
        "`template <class S> S energy_density(const Eigen::Matrix<S, 3, 3>& F) const`: "
        "a template over the scalar that returns S by value (name `S` for locals too, not `double` or `auto`)");

    using Scalar = S;

    UserEnergy energy{};

    Scalar energy_density(const Matrix3<Scalar>& F) const { return energy.energy_density(F); }

    Matrix3<Scalar> first_piola(const Matrix3<Scalar>& F) const {
        const First psi = energy.energy_density(with_variables<First>(F));
        return Eigen::Map<const Matrix3<Scalar>>(psi.derivative.data());
    }

    Matrix9<Scalar> hessian(const Matrix3<Scalar>& F) const {
        const Second psi = energy.energy_density(with_variables<Second>(with_variables<First>(F)));
        Matrix9<Scalar> H;
        for (std::size_t column = 0; column < 9; ++column) {
            for (std::size_t row = column; row < 9; ++row) {
                // One of the two mixed derivatives: they differ by round-off.
                H(Index(row), Index(column)) = H(Index(column), Index(row)) = psi.derivative[column].derivative[row];
            }
        }
        return H;
    }

private:
    using First = Dual<Scalar, 9>;
    using Second = Dual<First, 9>;

    /// F with entry k of vec(F) as variable k.
    template <class D, class Value>
    static Matrix3<D> with_variables(const Matrix3<Value>& F) {
        Matrix3<D> result;
        for (int k = 0; k < 9; ++k) {
            result.data()[k] = D::variable(F.data()[k], k);
        }
        return result;
    }
};

template <class UserEnergy>
FromEnergy(UserEnergy) -> FromEnergy<UserEnergy, double>;

}  // namespace softtissue
