// SPDX-License-Identifier: MIT
/// @file
/// What benchmarks of materials share: states F = R (I + S), entries of S normal with deviation 0.12, one sample of every law,
/// and the loop that times a law over the states.
#pragma once

#include <softtissue/material/arap.hpp>
#include <softtissue/material/corotated_linear.hpp>
#include <softtissue/material/corotated_linear_polar.hpp>
#include <softtissue/material/fung_orthotropic.hpp>
#include <softtissue/material/stable_neo_hookean.hpp>
#include <softtissue/testing/random_states.hpp>

#include <benchmark/benchmark.h>

#include <vector>

namespace benchmarks {

using namespace softtissue;

inline constexpr int count = 1024;

template <class S>
std::vector<Matrix3<S>> states() {
    RandomGenerator random(1);
    std::vector<Matrix3<S>> result;
    for (int i = 0; i < count; ++i) {
        const Matrix3<S> strain = S(0.12) * random_normal<Matrix3<S>>(random);
        result.push_back(random_rotation<S>(random) * (Matrix3<S>::Identity() + (strain + strain.transpose()) / S(2)));
    }
    return result;
}

/// Times `kernel` over all states; the results go to memory.
template <class States, class Kernel>
void run(benchmark::State& state, const States& F, const Kernel& kernel) {
    std::vector<decltype(kernel(F.front()))> results(F.size());
    for (auto iteration : state) {
        for (size_t i = 0; i < F.size(); ++i) {
            results[i] = kernel(F[i]);
        }
        benchmark::DoNotOptimize(results.data());
        benchmark::ClobberMemory();
    }
    state.counters["cells/s"] = benchmark::Counter(double(count), benchmark::Counter::kIsIterationInvariantRate);
}

template <class S>
inline constexpr YoungPoisson<S> flesh = {S(45e3), S(0.47)};

template <class S>
StableNeoHookean<S> sample(const StableNeoHookean<S>*) {
    return StableNeoHookean<S>::from_textbook_lame(flesh<S>);
}
template <class S>
Arap<S> sample(const Arap<S>*) {
    return Arap<S>();
}
template <class S>
CorotatedLinear<S> sample(const CorotatedLinear<S>*) {
    return CorotatedLinear<S>::from_young_poisson(flesh<S>, Matrix3<S>::Identity());
}
template <class S>
CorotatedLinearPolar<S> sample(const CorotatedLinearPolar<S>*) {
    return CorotatedLinearPolar<S>::from_young_poisson(flesh<S>);
}
template <class S>
FungOrthotropic<S> sample(const FungOrthotropic<S>*) {
    return {{.normal_modulus = S(10e3), .tangential_modulus = S(30e3)}, Matrix3<S>::Identity()};
}

template <class M>
M sample() {
    return sample(static_cast<const M*>(nullptr));
}

}  // namespace benchmarks
