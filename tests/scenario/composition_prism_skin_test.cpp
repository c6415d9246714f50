// SPDX-License-Identifier: MIT
// Skin with axes per cell, and a user's energy, x strain frame x skinning over Prism6 in a soft-tissue avatar.
#include <softtissue/element/prism6.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/from_energy.hpp>
#include <softtissue/material/fung_orthotropic_field.hpp>

#include <support/composition.hpp>

using namespace softtissue;
using namespace softtissue_test;

namespace {

/// mu/2 (|F|^2 - 3) + lambda/2 (J - 1 - mu/lambda)^2
struct UserEnergy {
    double mu = 8e3, lambda = 2e4;

    template <class S>
    S energy_density(const Matrix3<S>& F) const {
        const S volume = F.determinant() - S(1 + mu / lambda);
        return S(mu / 2) * (F.squaredNorm() - S(3)) + S(lambda / 2) * volume * volume;
    }
};

}  // namespace

TEST_CASE("Prism6 x Fung's skin", "[composition]") {
    const Index num_cells = RiggedBar<Prism6>(2).mesh.num_cells();
    RandomGenerator random(4);
    FungOrthotropicField<double>::Bases bases(9, num_cells);
    for (Index c = 0; c < num_cells; ++c) {
        bases.col(c) = vec<double>(random_rotation<double>(random));
    }
    run_avatars<Prism6>(FungOrthotropicField<double>({.normal_modulus = 1e4, .tangential_modulus = 3e4}, bases));
}
TEST_CASE("Prism6 x a user's energy", "[composition]") { run_avatars<Prism6>(UniformField{FromEnergy{UserEnergy{}}}); }
