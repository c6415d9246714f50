// What a stranger's program does with the package: a material in both precisions.
#include <softtissue/material/stable_neo_hookean.hpp>

namespace {

template <class Scalar>
bool rests_at_the_identity() {
    using Material = softtissue::StableNeoHookean<Scalar>;
    const Material material = Material::from_young_poisson({.young_modulus = 3000, .poisson_ratio = Scalar(0.4)});
    const softtissue::Matrix3<Scalar> P = material.first_piola(softtissue::Matrix3<Scalar>::Identity());
    return P.norm() < Scalar(0.1);  // Pa, of a modulus of 3000
}

}  // namespace

int main() { return rests_at_the_identity<float>() && rests_at_the_identity<double>() ? 0 : 1; }
