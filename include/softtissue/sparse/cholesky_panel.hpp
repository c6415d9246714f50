// SPDX-License-Identifier: MIT
/// @file
/// Cholesky factorisation of a dense trapezoid: the columns that a front of a sparse matrix eliminates.
///
/// What        panel = [A11; A21] -> [L11; L21] with A11 = L11 L11^T, L21 = A21 L11^-T, in place.
/// Shapes      height x width, height >= width, column-major; the strict upper triangle of A11 is not read and holds no result
/// Valid       false if A11 is not positive definite; the panel then is worthless.
/// Method      halves of columns recursively: the left one, a matrix product, the right one; up to eight columns in registers
/// Tests       tests/unit/sparse/cholesky_panel_test.cpp
#pragma once

#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>

#include <array>
#include <cmath>
#include <limits>

namespace softtissue {

namespace detail {

template <RealScalar S>
using PanelMap = Eigen::Map<MatrixX<S>, 0, Eigen::OuterStride<>>;

/// At most eight columns: the square by the textbook, then the rows below, some at a time, by forward substitution.
template <int width, RealScalar S>
bool factor_narrow_panel(S* panel, Index stride, Index height) {
    Eigen::Matrix<S, width, width> L;
    std::array<S, size_t(width)> inverse_pivots;
    for (int j = 0; j < width; ++j) {
        for (int i = j; i < width; ++i) {
            S value = panel[j * stride + i];
            for (int k = 0; k < j; ++k) {
                value -= L(i, k) * L(j, k);
            }
            if (i == j) {
                if (!(value > S(0) && value <= std::numeric_limits<S>::max())) {
                    return false;
                }
                value = std::sqrt(value);
                inverse_pivots[size_t(j)] = S(1) / value;
            } else {
                value *= inverse_pivots[size_t(j)];
            }
            L(i, j) = value;
            panel[j * stride + i] = value;
        }
    }
    const auto substitute = [&]<int num_rows>(Index i) {
        using Rows = Eigen::Array<S, num_rows, 1>;
        std::array<Rows, size_t(width)> x;
        for (int j = 0; j < width; ++j) {
            Eigen::Map<Rows> column(panel + j * stride + i);
            x[size_t(j)] = column;
            for (int k = 0; k < j; ++k) {
                x[size_t(j)] -= L(j, k) * x[size_t(k)];
            }
            x[size_t(j)] *= inverse_pivots[size_t(j)];
            column = x[size_t(j)];
        }
    };
    Index i = width;
    for (; i + 8 <= height; i += 8) {
        substitute.template operator()<8>(i);
    }
    for (; i < height; ++i) {
        substitute.template operator()<1>(i);
    }
    return true;
}

}  // namespace detail

/// False if the upper square is not positive definite; `stride` is the distance of columns.
template <RealScalar S>
bool factor_panel(S* panel, Index stride, Index height, Index width) {
    switch (width) {
        case 0:
            return true;
        case 1:
            return detail::factor_narrow_panel<1>(panel, stride, height);
        case 2:
            return detail::factor_narrow_panel<2>(panel, stride, height);
        case 3:
            return detail::factor_narrow_panel<3>(panel, stride, height);
        case 4:
            return detail::factor_narrow_panel<4>(panel, stride, height);
        case 5:
            return detail::factor_narrow_panel<5>(panel, stride, height);
        case 6:
            return detail::factor_narrow_panel<6>(panel, stride, height);
        case 7:
            return detail::factor_narrow_panel<7>(panel, stride, height);
        case 8:
            return detail::factor_narrow_panel<8>(panel, stride, height);
        default:
            break;
    }
    const Index left = (width / 2 + 7) / 8 * 8;
    const Index right = width - left;
    if (!factor_panel(panel, stride, height, left)) {
        return false;
    }
    const detail::PanelMap<S> factored(panel + left, height - left, left, Eigen::OuterStride<>(stride));
    detail::PanelMap<S> rest(panel + left * stride + left, height - left, right, Eigen::OuterStride<>(stride));
    rest.noalias() -= factored * factored.topRows(right).transpose();
    return factor_panel(rest.data(), stride, height - left, right);
}

}  // namespace softtissue
