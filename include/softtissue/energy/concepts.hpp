// SPDX-License-Identifier: MIT
/// @file
/// What an energy term is: anything with an energy, a gradient and a Hessian in the displacement of the vertices.
///
/// The unknown of every solver is the displacement d, 3 x vertices [m]. A term T offers
///   T.energy(d, executor)                             [J]
///   T.add_gradient(d, gradient, executor)             gradient += dE/dd, 3 x vertices [N]
///   T.add_neighbours(prescribed, neighbours)          which vertices it couples, asked once
///   T.bind(prescribed, pattern)                       told where its blocks go, once
///   T.add_hessian(d, filter, hessian, executor)       hessian += d2E/dd2 on the free vertices [N/m], each stencil filtered
/// and, where that is less work than one after the other,
///   T.add_energy_and_gradient(d, gradient, executor)  gradient += dE/dd, returns the energy
/// and, where it has one in closed form,
///   T.add_convex_hessian(d, hessian, executor)        a positive semi-definite Hessian, see convexified.hpp
/// A term owns its scratch memory: one object serves one solver at a time.
///
/// Laws        gradient and Hessian are derivatives (Taylor rates), tests/laws/energy_laws_test.cpp
#pragma once

#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/energy/prescribed_vertices.hpp>
#include <softtissue/linalg/psd_filter.hpp>
#include <softtissue/sparse/block_matrix.hpp>

#include <concepts>
#include <cstdint>
#include <vector>

namespace softtissue {

template <class T>
concept EnergyTerm = requires(T& term, const Matrix3X<typename T::Scalar>& d, Matrix3X<typename T::Scalar>& gradient,
                              BlockMatrix<typename T::Scalar>& hessian, const PrescribedVertices& prescribed,
                              const BlockPattern& pattern, std::vector<std::vector<std::int32_t>>& neighbours,
                              PsdFilter filter, const SequentialExecutor& executor) {
    { term.energy(d, executor) } -> std::same_as<typename T::Scalar>;
    term.add_gradient(d, gradient, executor);
    term.add_neighbours(prescribed, neighbours);
    term.bind(prescribed, pattern);
    term.add_hessian(d, filter, hessian, executor);
};

template <EnergyTerm T, Executor E>
typename T::Scalar add_energy_and_gradient(T& term, const Matrix3X<typename T::Scalar>& d,
                                           Matrix3X<typename T::Scalar>& gradient, const E& executor) {
    if constexpr (requires { term.add_energy_and_gradient(d, gradient, executor); }) {
        return term.add_energy_and_gradient(d, gradient, executor);
    } else {
        term.add_gradient(d, gradient, executor);
        return term.energy(d, executor);
    }
}

}  // namespace softtissue
