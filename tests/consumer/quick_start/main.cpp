// A material in both precisions, with few includes.
#include <softtissue/core/version.hpp>
#include <softtissue/material/arap.hpp>

template <class Scalar>
static bool rests_at_the_identity() {
    const softtissue::Arap<Scalar> material;
    return material.first_piola(softtissue::Matrix3<Scalar>::Identity()).norm() < Scalar(1e-6);
}

int main() {
    static_assert(SOFTTISSUE_VERSION_MAJOR == 0);
    return rests_at_the_identity<float>() && rests_at_the_identity<double>() ? 0 : 1;
}
