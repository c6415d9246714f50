// SPDX-License-Identifier: MIT
/// @file
/// Materials over a mesh: one law for all cells, or one law per cell.
///
/// What        UniformField: every cell the same material;  CellField: material i belongs to cell i
/// Valid       UniformField has no size; CellField answers 0 <= cell < num_cells(), asserted in at().
///             Refuses a CellField without cells (InvalidInput).
/// Tests       tests/unit/material/field_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/material/concepts.hpp>

#include <cstddef>
#include <utility>
#include <vector>

namespace softtissue {

/// The same material in every cell.
template <HyperelasticMaterial M>
struct UniformField {
    M material;

    const M& at(Index /*cell*/) const { return material; }
};

template <class M>
UniformField(M) -> UniformField<M>;

/// A material per cell, such as skin whose fibres follow the surface.
template <HyperelasticMaterial M>
class CellField {
public:
    explicit CellField(std::vector<M> materials) : materials_(std::move(materials)) {
        require(!materials_.empty(), "CellField: number of materials = 0, expected one per cell");
    }

    const M& at(Index cell) const {
        SOFTTISSUE_ASSERT(cell >= 0 && cell < num_cells());
        return materials_[std::size_t(cell)];
    }

    Index num_cells() const { return Index(materials_.size()); }

private:
    std::vector<M> materials_;
};

/// Refuses a field whose number of materials is not the number of cells; a field without a size covers any mesh.
template <MaterialField Field>
void require_covers(const Field& field, Index num_cells) {
    if constexpr (requires { field.num_cells(); }) {
        require(field.num_cells() == num_cells, "material field: number of materials = ", field.num_cells(),
                ", expected one for each of ", num_cells, " cells");
    }
}

}  // namespace softtissue
