// SPDX-License-Identifier: MIT
/// @file
/// Which vertices are prescribed and which are free: the elimination of hard Dirichlet conditions.
///
/// What        numbers the free vertices 0 .. num_free - 1 in mesh order; matrices and right-hand sides exist for those only.
/// Shapes      full arrays 3 x num_vertices, free vectors 3 num_free (dof 3 * free vertex + component).
/// Refuses     a vertex out of range or named twice (InvalidInput names it), more vertices than 32-bit indices can number.
/// Source      Romero et al. 2020, eq. (3), the matrix C_B.
/// Tests       tests/unit/energy/prescribed_vertices_test.cpp
#pragma once

#include <softtissue/core/checked_index.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace softtissue {

class PrescribedVertices {
public:
    static constexpr std::int32_t prescribed = -1;

    PrescribedVertices(Index num_vertices, std::span<const std::int32_t> vertices)
        : free_index_(size_t(checked_index(num_vertices, "prescribed vertices: vertices of the mesh")), 0) {
        for (const std::int32_t v : vertices) {
            require(v >= 0 && v < num_vertices, "prescribed vertex ", v, ", expected 0 to ", num_vertices - 1);
            require(free_index_[size_t(v)] != prescribed, "prescribed vertex ", v, " is named twice");
            free_index_[size_t(v)] = prescribed;
        }
        for (Index v = 0; v < num_vertices; ++v) {
            if (free_index_[size_t(v)] != prescribed) {
                free_index_[size_t(v)] = static_cast<std::int32_t>(free_vertices_.size());
                free_vertices_.push_back(static_cast<std::int32_t>(v));
            }
        }
    }

    Index num_vertices() const { return static_cast<Index>(free_index_.size()); }
    Index num_free() const { return static_cast<Index>(free_vertices_.size()); }

    /// The number of a vertex among the free ones, or `prescribed`.
    std::int32_t free_index(Index vertex) const { return free_index_[size_t(vertex)]; }
    bool is_prescribed(Index vertex) const { return free_index(vertex) == prescribed; }

    /// The mesh vertex of each free vertex, ascending.
    const std::vector<std::int32_t>& free_vertices() const { return free_vertices_; }

    /// The free columns of `full` as one vector.
    template <class Scalar>
    void restrict_into(const Matrix3X<Scalar>& full, VectorX<Scalar>& free) const {
        free.resize(3 * num_free());
        for (Index i = 0; i < num_free(); ++i) {
            free.template segment<3>(3 * i) = full.col(free_vertices_[size_t(i)]);
        }
    }

    /// full += factor * free on the free columns.
    template <class Scalar>
    void add_into(const VectorX<Scalar>& free, std::type_identity_t<Scalar> factor, Matrix3X<Scalar>& full) const {
        for (Index i = 0; i < num_free(); ++i) {
            full.col(free_vertices_[size_t(i)]) += factor * free.template segment<3>(3 * i);
        }
    }

private:
    std::vector<std::int32_t> free_index_;
    std::vector<std::int32_t> free_vertices_;
};

}  // namespace softtissue
