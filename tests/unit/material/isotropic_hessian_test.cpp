// SPDX-License-Identifier: MIT
#include <softtissue/material/isotropic_hessian.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

namespace {

template <class Scalar>
IsotropicSpectrum<Scalar> random_spectrum(RandomGenerator& random) {
    IsotropicSpectrum<Scalar> spectrum;
    const Matrix3<Scalar> A = random_normal<Matrix3<Scalar>>(random);
    spectrum.A = (A + A.transpose()) / Scalar(2);
    spectrum.twist = random_normal<Vector3<Scalar>>(random);
    spectrum.flip = random_normal<Vector3<Scalar>>(random);
    return spectrum;
}

/// The definition, mode by mode.
template <class Scalar>
Matrix9<Scalar> sum_over_modes(const Svd3<Scalar>& svd, const IsotropicSpectrum<Scalar>& spectrum) {
    const auto mode = [&svd](int i, int j) {
        const Matrix3<Scalar> outer = svd.U.col(i) * svd.V.col(j).transpose();
        return vec(outer);
    };
    Matrix9<Scalar> H = Matrix9<Scalar>::Zero();
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            H += spectrum.A(i, j) * mode(i, i) * mode(j, j).transpose();
        }
    }
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3;
        const int j = (k + 2) % 3;
        const Vector9<Scalar> twist = mode(i, j) - mode(j, i);
        const Vector9<Scalar> flip = mode(i, j) + mode(j, i);
        H += spectrum.twist(k) / Scalar(2) * twist * twist.transpose();
        H += spectrum.flip(k) / Scalar(2) * flip * flip.transpose();
    }
    return H;
}

}  // namespace

TEST_CASE_TEMPLATE("the Hessian is the sum over its modes, exactly symmetric", Scalar, float, double) {
    RandomGenerator random(1);
    for (int repeat = 0; repeat < 20; ++repeat) {
        const Svd3<Scalar> svd = svd3(random_normal<Matrix3<Scalar>>(random));
        const IsotropicSpectrum<Scalar> spectrum = random_spectrum<Scalar>(random);
        const Matrix9<Scalar> H = isotropic_hessian(svd, spectrum);
        CHECK(H == H.transpose());
        // Sums of 81 products of size |spectrum|.
        CHECK((H - sum_over_modes(svd, spectrum)).cwiseAbs().maxCoeff() <
              Scalar(81) * std::numeric_limits<Scalar>::epsilon());
    }
}

TEST_CASE_TEMPLATE("filtering the spectrum filters the 9x9 Hessian", Scalar, float, double) {
    RandomGenerator random(2);
    for (const PsdFilter filter : {PsdFilter::none, PsdFilter::clamp, PsdFilter::absolute}) {
        for (int repeat = 0; repeat < 20; ++repeat) {
            const Svd3<Scalar> svd = svd3(random_normal<Matrix3<Scalar>>(random));
            const IsotropicSpectrum<Scalar> spectrum = random_spectrum<Scalar>(random);
            const Matrix9<Scalar> closed_form = isotropic_hessian(svd, filtered(spectrum, filter));
            const Matrix9<Scalar> numeric = filtered(isotropic_hessian(svd, spectrum), filter);
            CHECK((closed_form - numeric).cwiseAbs().maxCoeff() < Scalar(200) * std::numeric_limits<Scalar>::epsilon());
        }
    }
}

TEST_CASE("an infinite negative eigenvalue is clamped away") {
    IsotropicSpectrum<double> spectrum{Matrix3<double>::Identity(), Vector3<double>::Ones(), Vector3<double>::Ones()};
    spectrum.twist(0) = -std::numeric_limits<double>::infinity();
    CHECK(filtered(spectrum, PsdFilter::clamp).twist == Vector3<double>(0, 1, 1));
}
