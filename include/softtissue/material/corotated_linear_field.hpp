// SPDX-License-Identifier: MIT
/// @file
/// Co-rotated linear elasticity with moduli and a rotation per cell, the rotations replaced in every pose.
///
/// What        at(cell) returns the CorotatedLinear of a cell by value
/// Shapes      rotations 3 x 3 cells; moduli [Pa], one set per cell
/// Refuses     in the constructor, naming the cell: moduli that CorotatedLinear refuses; set_rotations(): another number of
///             rotations, one that is not finite (InvalidInput). That they are rotations is the caller's word.
/// Source      Capell et al. 2005; Nolte et al. 2026, eq. (22) and (23)
/// Tests       tests/unit/material/corotated_linear_field_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/material/corotated_linear.hpp>
#include <softtissue/material/elastic_constants.hpp>

#include <span>
#include <utility>
#include <vector>

namespace softtissue {

template <FieldScalar ScalarType>
class CorotatedLinearField {
public:
    using Scalar = ScalarType;

    /// Rotations start as the identity.
    explicit CorotatedLinearField(std::vector<LameParameters<Scalar>> moduli) : moduli_(std::move(moduli)) {
        for (size_t c = 0; c < moduli_.size(); ++c) {
            require_positive_definite(moduli_[c], "moduli of cell ", c, ": ");
        }
        rotations_ = Matrix3<Scalar>::Identity().replicate(1, num_cells());
    }

    Index num_cells() const { return Index(moduli_.size()); }

    void set_rotations(std::span<const Matrix3<Scalar>> rotations) {
        require(Index(rotations.size()) == num_cells(), "co-rotated linear: ", rotations.size(),
                " rotations, expected ", num_cells());
        for (Index c = 0; c < num_cells(); ++c) {
            require(rotations[size_t(c)].allFinite(), "co-rotated linear: rotation of cell ", c, " is not finite");
            rotations_.template middleCols<3>(3 * c) = rotations[size_t(c)];
        }
    }

    CorotatedLinear<Scalar> at(Index cell) const {
        SOFTTISSUE_ASSERT(cell >= 0 && cell < num_cells());
        return CorotatedLinear<Scalar>::unchecked(moduli_[size_t(cell)], rotations_.template middleCols<3>(3 * cell));
    }

private:
    std::vector<LameParameters<Scalar>> moduli_;
    Matrix3X<Scalar> rotations_;
};

}  // namespace softtissue
