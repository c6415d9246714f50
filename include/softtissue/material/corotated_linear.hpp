// SPDX-License-Identifier: MIT
/// @file
/// Linear elasticity measured in a frame that is given, for example blended from the bones of a skeleton.
///
/// What        energy density, first Piola stress, the constant Hessian
/// Equation    psi = mu |e|^2 + lambda/2 tr(e)^2,   e = sym(R^T F) - I,   R constant
/// Shapes      F, P, R: 3x3.  H: 9x9 on column-major vec(F).
/// Units       psi, P, H, mu, lambda in Pa; F, R dimensionless
/// Parameters  Lamé's (mu, lambda) and the rotation R; small-strain limit about F = R: (mu, lambda), thus (E, nu)
/// Valid       every F.  Quadratic in F: H is constant and positive semi-definite, so no filter changes it.  Objective only
///             if R turns with the body.  Refuses mu <= 0, 2 mu + 3 lambda <= 0, R not a rotation (InvalidInput).
/// Source      Capell et al. 2002, "Interactive Skeleton-Driven Dynamic Deformations"
/// Cost        energy 80 flop; stress 110; Hessian 120
/// Tests       tests/unit/material/corotated_linear_test.cpp
#pragma once

#include <softtissue/material/concepts.hpp>

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/linalg/cofactor.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/material/elastic_constants.hpp>
#include <softtissue/material/orthonormal.hpp>

namespace softtissue {

template <FieldScalar ScalarType>
class CorotatedLinear {
public:
    using Scalar = ScalarType;
    using Parameters = LameParameters<Scalar>;

    CorotatedLinear(const Parameters& parameters, const Matrix3<Scalar>& rotation)
        : lame_(parameters), rotation_(rotation) {
        require_positive_definite(lame_);
        require_orthonormal(rotation, "rotation");
        const RealOf<Scalar> orientation = value_of(determinant(rotation));
        require(orientation > RealOf<Scalar>(0), "det rotation = ", orientation, ", expected +1");
    }

    /// For data that was checked before: nothing is.
    static CorotatedLinear unchecked(const Parameters& parameters, const Matrix3<Scalar>& rotation) {
        CorotatedLinear result;
        result.lame_ = parameters;
        result.rotation_ = rotation;
        return result;
    }

    /// The law of (E, nu) in the frame `rotation`.
    static CorotatedLinear from_young_poisson(const YoungPoisson<Scalar>& constants, const Matrix3<Scalar>& rotation) {
        return CorotatedLinear(lame_parameters(constants), rotation);
    }

    /// N laws side by side, law(i) in lane i.
    template <int N, class Law>
    static CorotatedLinear<Pack<Scalar, N>> packed(const Law& law) requires RealScalar<Scalar> {
        using Lanes = Pack<Scalar, N>;
        const LameParameters<Lanes> lame{.mu = Lanes::from_lanes([&](int i) { return law(i).lame_.mu; }),
                                         .lambda = Lanes::from_lanes([&](int i) { return law(i).lame_.lambda; })};
        return CorotatedLinear<Lanes>::unchecked(lame, packed_matrix<N>([&](int i) { return law(i).rotation_; }));
    }

    Parameters parameters() const { return lame_; }
    const Matrix3<Scalar>& rotation() const { return rotation_; }

    Scalar energy_density(const Matrix3<Scalar>& F) const {
        const Matrix3<Scalar> e = strain(F);
        const Scalar trace = e.trace();
        return lame_.mu * e.squaredNorm() + lame_.lambda / Scalar(2) * trace * trace;
    }

    Matrix3<Scalar> first_piola(const Matrix3<Scalar>& F) const {
        Matrix3<Scalar> stress = strain(F);
        const Scalar volumetric = lame_.lambda * stress.trace();
        stress *= Scalar(2) * lame_.mu;
        stress.diagonal().array() += volumetric;
        return rotation_ * stress;
    }

    /// The same for every F.
    Matrix9<Scalar> hessian(const Matrix3<Scalar>&) const {
        // Block (j, l) = dP e_j / dF e_l = mu (delta_jl I + r_l r_j^T) + lambda r_j r_l^T with the columns r of R.
        Matrix9<Scalar> H;
        for (int l = 0; l < 3; ++l) {
            for (int j = 0; j < 3; ++j) {
                const Matrix3<Scalar> outer = rotation_.col(l) * rotation_.col(j).transpose();
                H.template block<3, 3>(3 * j, 3 * l) = lame_.mu * outer + lame_.lambda * outer.transpose();
            }
        }
        H.diagonal().array() += lame_.mu;
        return H;
    }

    /// The Hessian itself: it has no negative eigenvalue.
    Matrix9<Scalar> projected_hessian(const Matrix3<Scalar>& F, PsdFilter) const { return hessian(F); }

private:
    CorotatedLinear() = default;

    Matrix3<Scalar> strain(const Matrix3<Scalar>& F) const {
        const Matrix3<Scalar> G = rotation_.transpose() * F;
        Matrix3<Scalar> e = (G + G.transpose()) / Scalar(2);
        e.diagonal().array() -= Scalar(1);
        return e;
    }

    LameParameters<Scalar> lame_;
    Matrix3<Scalar> rotation_;
};

}  // namespace softtissue
