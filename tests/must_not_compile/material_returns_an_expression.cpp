// An Eigen expression must not leak out of a policy: it refers to temporaries.
// expect: m\.first_piola\(F\)
#include <softtissue/material/concepts.hpp>

using softtissue::Matrix3;
using softtissue::Matrix9;

struct ReturnsAnExpression {
    using Scalar = double;
    double energy_density(const Matrix3<double>& F) const { return F.squaredNorm(); }
    auto first_piola(const Matrix3<double>& F) const { return 2.0 * F; }
    Matrix9<double> hessian(const Matrix3<double>&) const { return 2.0 * Matrix9<double>::Identity(); }
};

template <softtissue::HyperelasticMaterial M>
void use(const M&) {}

int main() { use(ReturnsAnExpression{}); }
