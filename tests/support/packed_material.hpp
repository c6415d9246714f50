// SPDX-License-Identifier: MIT
// What a law over a pack owes: the numbers of the plain law in every lane, whatever the other lanes hold.
#pragma once

#include <softtissue/core/pack.hpp>
#include <softtissue/material/concepts.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace softtissue_test {

/// Every class of state, and what breaks formulas: zero, rank one, rank two, reflected, equal and huge stretches.
template <class Scalar>
std::vector<softtissue::Matrix3<Scalar>> adversarial_states(int repeats, softtissue::RandomGenerator& random) {
    using namespace softtissue;
    using Matrix = Matrix3<Scalar>;
    std::vector<Matrix> states{Matrix::Identity(), -Matrix::Identity(), Matrix(Scalar(3) * Matrix::Identity())};
    for (int repeat = 0; repeat < repeats; ++repeat) {
        for (const StateClass state_class : all_state_classes) {
            states.push_back(random_state<Scalar>(state_class, random));
        }
        const Matrix U = random_rotation<Scalar>(random);
        const Matrix V = random_rotation<Scalar>(random);
        const Vector3<Scalar> rank_two(Scalar(1.2), Scalar(0.4), Scalar(0));
        const Vector3<Scalar> reflected(Scalar(1.5), Scalar(1.5), Scalar(-0.5));
        const Vector3<Scalar> large(Scalar(20), Scalar(1), Scalar(0.05));
        for (const Vector3<Scalar>& s : {rank_two, reflected, large}) {
            states.push_back(U * s.asDiagonal() * V.transpose());
        }
    }
    return states;
}

/// |packed - plain| in units of the size of the plain result, at least `floor`.
template <class A, class B>
double pack_difference(const A& packed, const B& plain, double floor) {
    const double size = std::max(double(plain.cwiseAbs().maxCoeff()), floor);
    return double((packed - plain).cwiseAbs().maxCoeff()) / size;
}

/// `law(k)` is the plain law of state k.
template <int N, class Law>
void check_packed_material(const Law& law, double scale, double tolerance) {
    using namespace softtissue;
    using Material = std::remove_cvref_t<decltype(law(0))>;
    using Scalar = typename Material::Scalar;
    using Lanes = Pack<Scalar, N>;
    RandomGenerator random(41);
    const auto states = adversarial_states<Scalar>(4, random);
    const int count = int(states.size());
    double energy = 0, stress = 0, exact = 0, clamped = 0, absolute = 0;
    for (int first = 0; first < count; ++first) {
        const auto index = [&](int i) { return (first + 7 * i) % count; };
        const auto packed_law = Material::template packed<N>([&](int i) { return law(index(i)); });
        const Matrix3<Lanes> F = packed_matrix<N>([&](int i) { return states[size_t(index(i))]; });
        const Lanes psi = packed_law.energy_density(F);
        const Matrix3<Lanes> P = packed_law.first_piola(F);
        const Matrix9<Lanes> H = packed_law.hessian(F);
        const Matrix9<Lanes> C = packed_law.projected_hessian(F, PsdFilter::clamp);
        const Matrix9<Lanes> A = packed_law.projected_hessian(F, PsdFilter::absolute);
        for (int i = 0; i < N; i += first == 0 ? 1 : N) {  // all lanes once, then every state in the first lane
            const Material plain = law(index(i));
            const Matrix3<Scalar>& f = states[size_t(index(i))];
            const Matrix3<Scalar> p = plain.first_piola(f);
            const Matrix9<Scalar> h = plain.hessian(f);
            const double e = double(plain.energy_density(f));
            energy = std::max(energy, std::abs(double(psi[i]) - e) / std::max(std::abs(e), scale));
            stress = std::max(stress, pack_difference(lane(P, i), p, scale));
            exact = std::max(exact, pack_difference(lane(H, i), h, scale));
            const double size = std::max(double(h.cwiseAbs().maxCoeff()), scale);
            clamped =
                std::max(clamped, pack_difference(lane(C, i), plain.projected_hessian(f, PsdFilter::clamp), size));
            absolute =
                std::max(absolute, pack_difference(lane(A, i), plain.projected_hessian(f, PsdFilter::absolute), size));
        }
        // Other neighbours, the same bits.
        const Matrix3<Lanes> alone = packed_matrix<N>([&](int) { return states[size_t(index(0))]; });
        const auto alone_law = Material::template packed<N>([&](int) { return law(index(0)); });
        CHECK(lane(alone_law.projected_hessian(alone, PsdFilter::clamp), 0) == lane(C, 0));
        CHECK(lane(alone_law.first_piola(alone), 0) == lane(P, 0));
    }
    CHECK(energy < tolerance);
    CHECK(stress < tolerance);
    CHECK(exact < tolerance);
    CHECK(clamped < tolerance);
    CHECK(absolute < tolerance);
}

}  // namespace softtissue_test
