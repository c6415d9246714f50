// SPDX-License-Identifier: MIT
/// @file
/// A Fung-orthotropic law per cell: a basis for each cell, moduli shared or per cell.
///
/// What        at(cell) returns the FungOrthotropic of a cell by value, without checking anything again
/// Shapes      bases: 9 x cells, column-major vec(B) per cell, first column of B along the skin's normal
/// Refuses     in the constructor, naming the cell: what FungOrthotropic refuses; as many parameter sets as neither 1 nor the
///             number of cells (InvalidInput)
/// Cost        at(): a copy of 13 numbers of moduli and 9 of basis
/// Tests       tests/unit/material/fung_orthotropic_field_test.cpp
#pragma once

#include <softtissue/material/concepts.hpp>

#include <softtissue/core/config.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/material/fung_orthotropic.hpp>
#include <softtissue/material/orthonormal.hpp>

#include <span>
#include <vector>

namespace softtissue {

template <FieldScalar ScalarType>
class FungOrthotropicField {
public:
    using Scalar = ScalarType;
    using Parameters = FungOrthotropicParameters<Scalar>;
    using Bases = Eigen::Matrix<Scalar, 9, Eigen::Dynamic>;

    /// One set of moduli for all cells.
    FungOrthotropicField(const Parameters& parameters, ConstRef<Bases> bases)
        : FungOrthotropicField(std::span<const Parameters>(&parameters, 1), bases) {}

    /// One set of moduli per cell (or one for all).
    FungOrthotropicField(std::span<const Parameters> parameters, ConstRef<Bases> bases) : bases_(bases) {
        const Index num_parameters = Index(parameters.size());
        require(num_parameters == 1 || num_parameters == num_cells(), "parameters: ", num_parameters,
                " sets, expected 1 or one per cell: ", num_cells());
        coefficients_.reserve(parameters.size());
        for (Index i = 0; i < num_parameters; ++i) {
            coefficients_.push_back(fung_coefficients(parameters[size_t(i)], "parameters ", i, ": "));
        }
        for (Index cell = 0; cell < num_cells(); ++cell) {
            require_orthonormal(basis(cell), "basis of cell ", cell);
        }
    }

    Index num_cells() const { return bases_.cols(); }

    /// The law of a cell.
    FungOrthotropic<Scalar> at(Index cell) const {
        SOFTTISSUE_ASSERT(cell >= 0 && cell < num_cells());
        return {coefficients_[coefficients_.size() == 1 ? 0 : size_t(cell)], basis(cell)};
    }

private:
    Matrix3<Scalar> basis(Index cell) const { return Eigen::Map<const Matrix3<Scalar>>(bases_.col(cell).data()); }

    Bases bases_;
    std::vector<FungOrthotropicCoefficients<Scalar>> coefficients_;
};

}  // namespace softtissue
