// SPDX-License-Identifier: MIT
/// @file
/// What elasticity keeps of the rest shape, in packs of cells: gradient operators, volumes, reference gradients.
///
/// What        cell c in lane c % width of pack c / width; the lanes beyond the last cell repeat it
/// Equation    F = F0 + sum_i d_i g_i^T; without reference gradients F0 is the identity
/// Shapes      g 3 x num_nodes [1/m], volume [m^3], F0 3x3, for a cell over Scalar, for a pack over Pack<Scalar, width>
/// Layout      a pack's numbers lie together, each `width` times: one contiguous read a pack
/// Tests       tests/unit/energy/rest_packs_test.cpp
#pragma once

#include <softtissue/core/config.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/element/concepts.hpp>
#include <softtissue/energy/rest_operators.hpp>

#include <algorithm>
#include <cstddef>

namespace softtissue {

template <class ElementType, RealScalar S>
class RestPacks {
public:
    using Scalar = S;
    static constexpr int num_nodes = ElementType::num_nodes;
    static constexpr int width = natural_lanes<Scalar>;
    using Lanes = Pack<Scalar, width>;

    explicit RestPacks(const RestOperators<ElementType, Scalar>& rest)
        : num_cells_(rest.volumes.size()), operators_(operator_size * width, num_packs()) {
        for (Index c = 0; c < num_cells_; ++c) {
            set_cell(c, rest.cell_gradients(c), rest.volumes(c));
        }
    }

    Index num_cells() const { return num_cells_; }
    Index num_packs() const { return (num_cells_ + width - 1) / width; }

    /// The cell in a lane of a pack.
    Index cell(Index pack, int lane) const { return std::min(width * pack + lane, num_cells_ - 1); }

    void set_cell(Index cell, const NodePositions<ElementType, Scalar>& gradients, Scalar volume) {
        for_each_lane_of(cell, [&](Index pack, int lane) {
            for (int k = 0; k < 3 * num_nodes; ++k) {
                operators_(k * width + lane, pack) = gradients.data()[k];
            }
            operators_(3 * num_nodes * width + lane, pack) = volume;
        });
    }

    /// From the first call on every cell has a reference gradient, at first the identity.
    void set_reference_gradient(Index cell, const Matrix3<Scalar>& F0) {
        if (references_.cols() == 0) {
            references_.setZero(9 * width, num_packs());
            for (int k = 0; k < 9; k += 4) {
                references_.middleRows(k * width, width).setOnes();
            }
        }
        for_each_lane_of(cell, [&](Index pack, int lane) {
            for (int k = 0; k < 9; ++k) {
                references_(k * width + lane, pack) = F0.data()[k];
            }
        });
    }

    Scalar volume(Index cell) const { return operators_(3 * num_nodes * width + cell % width, cell / width); }
    NodePositions<ElementType, Scalar> gradients(Index cell) const {
        NodePositions<ElementType, Scalar> result;
        for (int k = 0; k < 3 * num_nodes; ++k) {
            result.data()[k] = operators_(k * width + cell % width, cell / width);
        }
        return result;
    }
    Matrix3<Scalar> reference_gradient(Index cell) const {
        Matrix3<Scalar> result = Matrix3<Scalar>::Identity();
        if (references_.cols() > 0) {
            for (int k = 0; k < 9; ++k) {
                result.data()[k] = references_(k * width + cell % width, cell / width);
            }
        }
        return result;
    }

    Lanes packed_volume(Index pack) const { return Lanes::load(&operators_(3 * num_nodes * width, pack)); }
    NodePositions<ElementType, Lanes> packed_gradients(Index pack) const {
        NodePositions<ElementType, Lanes> result;
        for (int k = 0; k < 3 * num_nodes; ++k) {
            result.data()[k] = Lanes::load(&operators_(k * width, pack));
        }
        return result;
    }
    Matrix3<Lanes> packed_reference_gradient(Index pack) const {
        Matrix3<Lanes> result = Matrix3<Lanes>::Identity();
        if (references_.cols() > 0) {
            for (int k = 0; k < 9; ++k) {
                result.data()[k] = Lanes::load(&references_(k * width, pack));
            }
        }
        return result;
    }

private:
    static constexpr int operator_size = 3 * num_nodes + 1;

    /// The cell's own lane, and for the last cell the lanes that repeat it.
    template <class F>
    void for_each_lane_of(Index cell, const F& f) const {
        SOFTTISSUE_ASSERT(cell >= 0 && cell < num_cells_);
        const int last = cell == num_cells_ - 1 ? width - 1 : int(cell % width);
        for (int lane = int(cell % width); lane <= last; ++lane) {
            f(cell / width, lane);
        }
    }

    Index num_cells_;
    MatrixX<Scalar> operators_;   // column: a pack
    MatrixX<Scalar> references_;  // column: a pack; empty for the identity
};

}  // namespace softtissue
