// SPDX-License-Identifier: MIT
/// @file
/// A sum of energy terms over the free vertices of a mesh: what solvers minimise.
///
/// What        energy, gradient and Hessian of E(d) = sum of terms; prescribed columns of d are given and stay.
/// Shapes      d 3 x vertices [m]; gradient 3 num_free [N]; Hessian 3 num_free x 3 num_free [N/m]
/// Cost        one sparsity pattern for all terms, built once; no allocation afterwards
/// Tests       tests/unit/solver/objective_test.cpp
#pragma once

#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/energy/concepts.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/sparse/block_matrix.hpp>

#include <tuple>
#include <vector>

namespace softtissue {

template <Executor ExecutorType, EnergyTerm First, EnergyTerm... Rest>
class Objective {
public:
    using Scalar = typename First::Scalar;
    static_assert((std::same_as<Scalar, typename Rest::Scalar> && ...), "all energy terms need the same scalar");

    /// The terms and the executor must outlive the objective.
    Objective(PrescribedVertices prescribed, const ExecutorType& executor, First& first, Rest&... rest)
        : prescribed_(std::move(prescribed)), executor_(&executor), terms_(first, rest...) {
        std::vector<std::vector<std::int32_t>> neighbours(size_t(prescribed_.num_free()));
        std::apply([&](auto&... term) { (term.add_neighbours(prescribed_, neighbours), ...); }, terms_);
        hessian_ = BlockMatrix<Scalar>(BlockPattern(std::move(neighbours)));
        std::apply([&](auto&... term) { (term.bind(prescribed_, hessian_.pattern()), ...); }, terms_);
    }

    const PrescribedVertices& prescribed() const { return prescribed_; }
    const ExecutorType& executor() const { return *executor_; }

    Scalar energy(const Matrix3X<Scalar>& d) {
        return std::apply([&](auto&... term) { return (term.energy(d, *executor_) + ...); }, terms_);
    }

    /// dE/dd on the free vertices; valid until the next call.
    const VectorX<Scalar>& gradient(const Matrix3X<Scalar>& d) {
        full_gradient(d);
        prescribed_.restrict_into(full_gradient_, free_gradient_);
        return free_gradient_;
    }

    /// Energy, and dE/dd on the free vertices into `gradient`: less work than one after the other.
    Scalar energy_and_gradient(const Matrix3X<Scalar>& d, VectorX<Scalar>& gradient) {
        full_gradient_.setZero(3, d.cols());
        const Scalar energy = std::apply(
            [&](auto&... term) { return (add_energy_and_gradient(term, d, full_gradient_, *executor_) + ...); }, terms_);
        prescribed_.restrict_into(full_gradient_, gradient);
        return energy;
    }

    /// dE/dd on all vertices; on the prescribed ones the force that holds them. Valid until the next call.
    const Matrix3X<Scalar>& full_gradient(const Matrix3X<Scalar>& d) {
        full_gradient_.setZero(3, d.cols());
        std::apply([&](auto&... term) { (term.add_gradient(d, full_gradient_, *executor_), ...); }, terms_);
        return full_gradient_;
    }

    /// d2E/dd2 on the free vertices, negative curvature of each stencil treated as `filter` says; valid until the next call.
    const BlockMatrix<Scalar>& hessian(const Matrix3X<Scalar>& d, PsdFilter filter) {
        hessian_.set_zero();
        std::apply([&](auto&... term) { (term.add_hessian(d, filter, hessian_, *executor_), ...); }, terms_);
        return hessian_;
    }

private:
    PrescribedVertices prescribed_;
    const ExecutorType* executor_;
    std::tuple<First&, Rest&...> terms_;
    BlockMatrix<Scalar> hessian_;
    Matrix3X<Scalar> full_gradient_;
    VectorX<Scalar> free_gradient_;
};

}  // namespace softtissue
