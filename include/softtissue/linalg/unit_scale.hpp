// SPDX-License-Identifier: MIT
/// @file
/// Scales numbers so that the largest is 1, for algorithms that square them.
///
/// What        unit(x) = x / size, original(y) = y size
/// Shapes      float and double; lane by lane for packs
/// Valid       every finite size and |x| <= size: sizes below 2^4 times the smallest normal number count as that
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
    explicit UnitScale(const Scalar& size) {
        using std::max;
        using Real = RealOf<Scalar>;
        // The reciprocal of the largest number would not be normal, and a sixteenth of a small one loses digits.
        first_ = select(size > Scalar(1), Scalar(Real(1) / Real(16)), Scalar(16));
        size_ = max(size, Scalar(Real(16) * std::numeric_limits<Real>::min()));
        second_ = reciprocal(Scalar(size_ * first_));
    }

    Scalar unit(const Scalar& x) const { return (x * first_) * second_; }
    Scalar original(const Scalar& y) const { return y * size_; }

private:
    Scalar first_, second_, size_;
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
