// SPDX-License-Identifier: MIT
// A user's energy x element x strain frame x skinning in a soft-tissue avatar.
#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/material/field.hpp>
#include <softtissue/material/from_energy.hpp>

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

TEMPLATE_TEST_CASE("a user's energy in an avatar", "[composition]", Tet4, Prism6) {
    run_avatars<TestType>(UniformField{FromEnergy{UserEnergy{}}});
}
