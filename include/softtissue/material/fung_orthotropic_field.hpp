// SPDX-License-Identifier: MIT
/// @file
/// A Fung-orthotropic law per cell: a basis for each cell, moduli shared or per cell.
///
/// What        at(cell) returns the FungOrthotropic of a cell by value, without checking anything again; packed_at(pack) those of
///             a pack of cells (core/pack_array.hpp)
/// Shapes      bases: 9 x cells, column-major vec(B) per cell, first column of B along the skin's normal
/// Refuses     in the constructor, naming the cell: what FungOrthotropic refuses; as many parameter sets as neither 1 nor the
///             number of cells (InvalidInput)
/// Cost        at(): a copy of 13 numbers of moduli and 9 of basis
/// Tests       tests/unit/material/fung_orthotropic_field_test.cpp
#pragma once

#include <softtissue/material/concepts.hpp>

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/pack_array.hpp>
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
    FungOrthotropicField(std::span<const Parameters> parameters, ConstRef<Bases> bases) : bases_(bases.cols()) {
        const Index num_parameters = Index(parameters.size());
        require(num_parameters == 1 || num_parameters == num_cells(), "parameters: ", num_parameters,
                " sets, expected 1 or one per cell: ", num_cells());
        coefficients_.reserve(parameters.size());
        for (Index i = 0; i < num_parameters; ++i) {
            coefficients_.push_back(fung_coefficients(parameters[size_t(i)], "parameters ", i, ": "));
        }
        for (Index cell = 0; cell < num_cells(); ++cell) {
            const Matrix3<Scalar> basis = Eigen::Map<const Matrix3<Scalar>>(bases.col(cell).data());
            require_orthonormal(basis, "basis of cell ", cell);
            bases_.set(cell, 0, basis);
        }
    }

    Index num_cells() const { return bases_.num_items(); }

    /// The law of a cell.
    FungOrthotropic<Scalar> at(Index cell) const {
        return {coefficients_[is_uniform() ? 0 : size_t(cell)], bases_.template matrix_at<Matrix3<Scalar>>(cell)};
    }

    /// The laws of a pack of cells.
    auto packed_at(Index pack) const requires RealScalar<Scalar> {
        constexpr int width = PackArray<Scalar, 9>::width;
        using Lanes = Pack<Scalar, width>;
        const Matrix3<Lanes> basis = bases_.template packed_matrix_at<3, 3>(pack);
        if (is_uniform()) {
            return FungOrthotropic<Lanes>(coefficients_[0].template cast<Lanes>(), basis);
        }
        return FungOrthotropic<Lanes>(packed_fung_coefficients<width>([&](int lane) -> decltype(auto) {
                                          return coefficients_[size_t(bases_.item(pack, lane))];
                                      }),
                                      basis);
    }

private:
    bool is_uniform() const { return coefficients_.size() == 1; }

    PackArray<Scalar, 9> bases_;
    std::vector<FungOrthotropicCoefficients<Scalar>> coefficients_;
};

}  // namespace softtissue
