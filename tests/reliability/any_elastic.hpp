// SPDX-License-Identifier: MIT
// An elastic energy whose element and law are hidden from the solvers, which are then compiled once for all of them.
#pragma once

#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/sparse/block_matrix.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace reliability {

using namespace softtissue;

template <class S>
class AnyElastic {
public:
    using Scalar = S;

    virtual ~AnyElastic() = default;
    virtual S energy(const Matrix3X<S>& d, const SequentialExecutor& executor) = 0;
    virtual S add_energy_and_gradient(const Matrix3X<S>& d, Matrix3X<S>& gradient,
                                      const SequentialExecutor& executor) = 0;
    virtual void add_neighbours(const PrescribedVertices& prescribed,
                                std::vector<std::vector<std::int32_t>>& neighbours) = 0;
    virtual void bind(const PrescribedVertices& prescribed, const BlockPattern& pattern) = 0;
    virtual void add_hessian(const Matrix3X<S>& d, PsdFilter filter, BlockMatrix<S>& hessian,
                             const SequentialExecutor& executor) = 0;

    void add_gradient(const Matrix3X<S>& d, Matrix3X<S>& gradient, const SequentialExecutor& executor) {
        static_cast<void>(add_energy_and_gradient(d, gradient, executor));
    }
};

/// Any energy term that has everything.
template <class Term>
class HeldElastic final : public AnyElastic<typename Term::Scalar> {
public:
    using S = typename Term::Scalar;

    template <class... Arguments>
    explicit HeldElastic(Arguments&&... arguments) : term_(std::forward<Arguments>(arguments)...) {}

    S energy(const Matrix3X<S>& d, const SequentialExecutor& executor) override { return term_.energy(d, executor); }
    S add_energy_and_gradient(const Matrix3X<S>& d, Matrix3X<S>& gradient,
                              const SequentialExecutor& executor) override {
        return term_.add_energy_and_gradient(d, gradient, executor);
    }
    void add_neighbours(const PrescribedVertices& prescribed,
                        std::vector<std::vector<std::int32_t>>& neighbours) override {
        term_.add_neighbours(prescribed, neighbours);
    }
    void bind(const PrescribedVertices& prescribed, const BlockPattern& pattern) override {
        term_.bind(prescribed, pattern);
    }
    void add_hessian(const Matrix3X<S>& d, PsdFilter filter, BlockMatrix<S>& hessian,
                     const SequentialExecutor& executor) override {
        term_.add_hessian(d, filter, hessian, executor);
    }

private:
    Term term_;
};

}  // namespace reliability
