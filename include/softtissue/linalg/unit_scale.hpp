// SPDX-License-Identifier: MIT
/// @file
/// Scales numbers so that the largest is 1, for algorithms that square them.
///
/// What        unit(x) = x / size, original(y) = y size
/// Shapes      float and double; lane by lane for packs
/// Valid       every finite size and |x| <= size, subnormal ones too, zero included
/// Accuracy    three roundings
/// Tests       tests/unit/linalg/unit_scale_test.cpp
#pragma once

#include <softtissue/core/pack_math.hpp>
#include <softtissue/core/reciprocal.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>

namespace softtissue {

template <RealLanes Scalar>
class UnitScale {
public:
    explicit UnitScale(const Scalar& size) : size_(size) {
        using std::max;
        using Real = RealOf<Scalar>;
        // Exact, and a normal number whose reciprocal is one: the largest size has no such reciprocal, nor has a subnormal one.
        constexpr Real up = Real(2) / std::numeric_limits<Real>::epsilon(), down = Real(1) / Real(16);
        first_ = select(size > Scalar(1), Scalar(down), Scalar(up));
        second_ = reciprocal(max(Scalar(size * first_), Scalar(std::numeric_limits<Real>::min())));
    }

    Scalar unit(const Scalar& x) const { return (x * first_) * second_; }
    Scalar original(const Scalar& y) const { return y * size_; }

private:
    Scalar size_, first_, second_;
};

/// The largest size of an entry of the lower triangle.
template <RealLanes Scalar, int N>
Scalar largest_entry(const Eigen::Matrix<Scalar, N, N>& lower) {
    using std::abs;
    using std::max;
    Scalar result(0);
    for (int j = 0; j < N; ++j) {
        Scalar of_column = abs(lower(j, j));
        for (int i = j + 1; i < N; ++i) {
            of_column = max(of_column, Scalar(abs(lower(i, j))));
        }
        result = max(result, of_column);
    }
    return result;
}

}  // namespace softtissue
