// SPDX-License-Identifier: MIT
/// @file
/// What elasticity keeps of the rest shape, in packs of cells: gradient operators, volumes, reference gradients.
///
/// What        cell c in lane c % width of pack c / width (core/pack_array.hpp)
/// Equation    F = F0 + sum_i d_i g_i^T; without reference gradients F0 is the identity
/// Shapes      g 3 x num_nodes [1/m], volume [m^3], F0 3x3, for a cell over Scalar, for a pack over Pack<Scalar, width>
/// Tests       tests/unit/energy/rest_packs_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/pack_array.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/element/concepts.hpp>
#include <softtissue/energy/rest_operators.hpp>

#include <cstddef>

namespace softtissue {

template <class ElementType, RealScalar S>
class RestPacks {
public:
    using Scalar = S;
    static constexpr int num_nodes = ElementType::num_nodes;
    static constexpr int width = PackArray<Scalar, 1>::width;
    using Lanes = Pack<Scalar, width>;

    explicit RestPacks(const RestOperators<ElementType, Scalar>& rest) : operators_(rest.volumes.size()) {
        for (Index c = 0; c < num_cells(); ++c) {
            set_cell(c, rest.cell_gradients(c), rest.volumes(c));
        }
    }

    Index num_cells() const { return operators_.num_items(); }
    Index num_packs() const { return operators_.num_packs(); }

    /// The cell in a lane of a pack.
    Index cell(Index pack, int lane) const { return operators_.item(pack, lane); }

    void set_cell(Index cell, const NodePositions<ElementType, Scalar>& gradients, Scalar volume) {
        operators_.set(cell, 0, gradients);
        operators_.set(cell, 3 * num_nodes, volume);
    }

    /// From the first call on every cell has a reference gradient, at first the identity.
    void set_reference_gradient(Index cell, const Matrix3<Scalar>& F0) {
        if (references_.num_items() == 0) {
            references_ = PackArray<Scalar, 9>(num_cells());
            for (Index c = 0; c < num_cells(); ++c) {
                references_.set(c, 0, Matrix3<Scalar>(Matrix3<Scalar>::Identity()));
            }
        }
        references_.set(cell, 0, F0);
    }

    Scalar volume(Index cell) const { return operators_.at(cell, 3 * num_nodes); }
    NodePositions<ElementType, Scalar> gradients(Index cell) const {
        return operators_.template matrix_at<NodePositions<ElementType, Scalar>>(cell);
    }
    Matrix3<Scalar> reference_gradient(Index cell) const {
        return references_.num_items() == 0 ? Matrix3<Scalar>(Matrix3<Scalar>::Identity())
                                            : references_.template matrix_at<Matrix3<Scalar>>(cell);
    }

    const Lanes& packed_volume(Index pack) const { return operators_.pack_at(pack, 3 * num_nodes); }
    auto packed_gradients(Index pack) const { return operators_.template packed_matrix_at<3, num_nodes>(pack); }
    Matrix3<Lanes> packed_reference_gradient(Index pack) const {
        return references_.num_items() == 0 ? Matrix3<Lanes>(Matrix3<Lanes>::Identity())
                                            : Matrix3<Lanes>(references_.template packed_matrix_at<3, 3>(pack));
    }

private:
    PackArray<Scalar, 3 * num_nodes + 1> operators_;
    PackArray<Scalar, 9> references_;  // empty for the identity
};

}  // namespace softtissue
