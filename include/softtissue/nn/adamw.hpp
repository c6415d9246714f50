// SPDX-License-Identifier: MIT
/// @file
/// AdamW: a step of adaptive moments with decoupled weight decay.
///
/// What        one update of a vector of parameters and of the two moments of its gradient g
/// Equation    m = beta1 m + (1 - beta1) g,  v = beta2 v + (1 - beta2) g^2,
///             p = (1 - eta w) p - eta m / (1 - beta1^n) / (sqrt(v) / sqrt(1 - beta2^n) + epsilon), entrywise,
///             eta the learning rate, w the weight decay, n = 1 for the first step
/// Refuses     vectors of different sizes, n < 1, options outside their range (InvalidInput)
/// Source      Kingma, Ba 2015; Loshchilov, Hutter 2019, algorithm 2; defaults and the decay of every parameter: PyTorch
/// Threads     same bits for every executor
/// Cost        28 bytes (float) or 56 (double) a parameter to and from memory, which is what bounds it
/// Tests       tests/unit/nn/adamw_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <algorithm>
#include <cmath>

namespace softtissue {

struct AdamWOptions {
    double learning_rate = 1e-3;
    double beta1 = 0.9;
    double beta2 = 0.999;
    double epsilon = 1e-8;
    double weight_decay = 1e-2;

    void validate() const {
        const auto require_range = [](const char* name, double value, bool is_in_range, const char* range) {
            require(is_in_range, "AdamW: ", name, " = ", value, ", expected ", range);
        };
        require_range("learning_rate", learning_rate, learning_rate >= 0 && std::isfinite(learning_rate), ">= 0");
        require_range("beta1", beta1, beta1 >= 0 && beta1 < 1, "0 <= beta1 < 1");
        require_range("beta2", beta2, beta2 >= 0 && beta2 < 1, "0 <= beta2 < 1");
        require_range("epsilon", epsilon, epsilon >= 0 && std::isfinite(epsilon), ">= 0");
        require_range("weight_decay", weight_decay, weight_decay >= 0 && std::isfinite(weight_decay), ">= 0");
    }
};

/// Step `n` (1 for the first) with a learning rate of its own.
template <RealScalar S, Executor E = SequentialExecutor>
void adamw_update(const AdamWOptions& options, double learning_rate, Index n, const VectorX<S>& gradient,
                  VectorX<S>& first_moment, VectorX<S>& second_moment, VectorX<S>& parameters, const E& executor = {}) {
    const Index size = parameters.size();
    require(n >= 1, "AdamW: step ", n, ", expected at least 1");
    require(gradient.size() == size && first_moment.size() == size && second_moment.size() == size,
            "AdamW: gradient of ", gradient.size(), " and moments of ", first_moment.size(), " and ",
            second_moment.size(), " entries, expected ", size);
    const S keep = S(1 - learning_rate * options.weight_decay);
    const S beta1 = S(options.beta1), rest1 = S(1 - options.beta1);
    const S beta2 = S(options.beta2), rest2 = S(1 - options.beta2);
    const S stride = S(learning_rate / (1 - std::pow(options.beta1, double(n))));
    const S deviation_scale = S(1 / std::sqrt(1 - std::pow(options.beta2, double(n))));
    const S epsilon = S(options.epsilon);
    constexpr Index chunk = 1 << 14;  // ranges that do not depend on the executor
    executor.for_each_range((size + chunk - 1) / chunk, [&](Index begin, Index end) {
        const S* const g = gradient.data();
        S* const m = first_moment.data();
        S* const v = second_moment.data();
        S* const p = parameters.data();
        for (Index i = begin * chunk; i < std::min(end * chunk, size); ++i) {
            const S first = beta1 * m[i] + rest1 * g[i];
            const S second = beta2 * v[i] + rest2 * (g[i] * g[i]);
            m[i] = first;
            v[i] = second;
            p[i] = keep * p[i] - stride * (first / (std::sqrt(second) * deviation_scale + epsilon));
        }
    });
}

}  // namespace softtissue
