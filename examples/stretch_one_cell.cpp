// SPDX-License-Identifier: MIT
// ctest:
//
// The smallest use of the library: one cell, one deformation gradient, the stress of every law.
#include <softtissue/element/prism6.hpp>
#include <softtissue/material/arap.hpp>
#include <softtissue/material/corotated_linear_polar.hpp>
#include <softtissue/material/fung_orthotropic.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>

#include <cstdio>

using namespace softtissue;

int main() {
    // a prism of skin, 1 cm thick along z
    NodePositions<Prism6, double> X;
    X << 0.00, 0.02, 0.00, 0.00, 0.02, 0.00,  //
        0.00, 0.00, 0.02, 0.00, 0.00, 0.02,   //
        0.00, 0.00, 0.00, 0.01, 0.01, 0.01;
    const NodePositions<Prism6, double> g = Prism6::gradient_operator(X);
    std::printf("volume %.3g cm^3\n\n", 1e6 * Prism6::rest_volume(X));

    const YoungPoisson<double> soft{.young_modulus = 10e3, .poisson_ratio = 0.2};
    const auto neo_hookean = StableNeoHookean<double>::from_young_poisson(soft);
    const CorotatedLinearPolar<double> corotated(lame_parameters(soft));
    const Arap<double> arap({.stiffness = lame_parameters(soft).mu});
    Matrix3<double> B;  // first column: the skin's normal, here z
    B << 0, 1, 0, 0, 0, 1, 1, 0, 0;
    const FungOrthotropic<double> fung({.normal_modulus = 5e3, .tangential_modulus = 10e3}, B);

    std::printf("stretch   first Piola stress along x [kPa]\n           Fung     neo-Hookean  co-rotated  ARAP\n");
    for (const double stretch : {0.7, 0.9, 1.0, 1.1, 1.3, 1.6, 2.0}) {
        NodePositions<Prism6, double> x = X;
        x.row(0) *= stretch;
        const Matrix3<double> F = x * g.transpose();
        std::printf("%6.1f  %9.2f  %9.2f  %9.2f  %9.2f\n", stretch, 1e-3 * fung.first_piola(F)(0, 0),
                    1e-3 * neo_hookean.first_piola(F)(0, 0), 1e-3 * corotated.first_piola(F)(0, 0),
                    1e-3 * arap.first_piola(F)(0, 0));
    }
}
