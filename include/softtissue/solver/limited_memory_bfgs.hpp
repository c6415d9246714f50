// SPDX-License-Identifier: MIT
/// @file
/// What the last steps of a minimisation told about the curvature, put on top of a Hessian that is known roughly.
///
/// What        directions of descent of the limited-memory BFGS method, whose initial metric is a factored matrix.
/// Equation    p = -B^-1 g, where B takes each remembered step s to the change y of the gradient that it made: B s = y
/// Valid       steps without positive curvature, s.y <= 0, are not remembered: B stays positive definite and p descends.
/// Source      Nocedal & Wright 2006, alg. 7.4
/// Cost        one solve with the matrix, 8 flop per unknown and remembered step. Allocates with the first step of a size.
/// Tests       tests/unit/solver/limited_memory_bfgs_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <array>
#include <cstddef>
#include <limits>

namespace softtissue {

template <RealScalar S>
class LimitedMemoryBfgs {
public:
    using Scalar = S;
    static constexpr size_t capacity = 12;

    void clear() { size_ = 0; }
    size_t size() const { return size_; }

    /// The oldest pair is forgotten when the memory is full.
    void remember(const VectorX<Scalar>& step, const VectorX<Scalar>& change) {
        const Scalar curvature = step.dot(change);
        if (!(curvature > std::numeric_limits<Scalar>::epsilon() * step.norm() * change.norm())) {
            return;
        }
        if (pairs_[0].step.size() != step.size()) {
            for (Pair& pair : pairs_) {
                pair.step.resize(step.size());
                pair.change.resize(step.size());
            }
        }
        Pair& pair = pairs_[next_];
        pair.step = step;
        pair.change = change;
        pair.curvature = curvature;
        next_ = (next_ + 1) % capacity;
        size_ = size_ < capacity ? size_ + 1 : capacity;
    }

    /// `solve(rhs, p)` writes the product of the initial metric's inverse with rhs.
    template <class Solve>
    void direction_into(const VectorX<Scalar>& gradient, const Solve& solve, VectorX<Scalar>& p) {
        rest_ = -gradient;
        for (size_t age = 1; age <= size_; ++age) {
            Pair& pair = at(age);
            pair.weight = pair.step.dot(rest_) / pair.curvature;
            rest_ -= pair.weight * pair.change;
        }
        solve(rest_, p);
        for (size_t age = size_; age >= 1; --age) {
            const Pair& pair = at(age);
            p += (pair.weight - pair.change.dot(p) / pair.curvature) * pair.step;
        }
    }

private:
    struct Pair {
        VectorX<Scalar> step, change;
        Scalar curvature, weight;
    };

    Pair& at(size_t age) { return pairs_[(next_ + capacity - age) % capacity]; }

    std::array<Pair, capacity> pairs_;
    VectorX<Scalar> rest_;
    size_t next_ = 0, size_ = 0;
};

}  // namespace softtissue
