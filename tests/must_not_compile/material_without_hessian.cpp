// The compiler names the member that is missing.
// expect: m\.hessian\(F\)
#include <softtissue/material/concepts.hpp>

struct WithoutHessian {
    using Scalar = double;
    double energy_density(const softtissue::Matrix3<double>& F) const { return F.squaredNorm(); }
    softtissue::Matrix3<double> first_piola(const softtissue::Matrix3<double>& F) const { return 2.0 * F; }
};

template <softtissue::HyperelasticMaterial M>
void use(const M&) {}

int main() { use(WithoutHessian{}); }
