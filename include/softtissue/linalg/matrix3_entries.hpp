// SPDX-License-Identifier: MIT
/// @file
/// 3x3 matrices in plain arithmetic, one or 32 at a time: compilers turn those into lanes.
///
/// What        Matrix3Entries: nine numbers, entrywise() and product(); Matrix3Lanes: 32 matrices, entry by entry;
///             for_each_lane_block: a loop over the columns of a 9 x n array, 32 at a time
/// Shapes      nine entries row after row, or column after column, as long as all are alike
/// Why         a loop over lanes whose body is straight arithmetic on Matrix3Entries vectorises; one over Eigen's does not
/// Threads     the same blocks for every executor
/// Tests       tests/unit/linalg/matrix3_entries_test.cpp
#pragma once

#include <softtissue/core/executor.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/linalg/nine_number_lanes.hpp>

#include <algorithm>
#include <utility>

namespace softtissue {

template <class S>
struct Matrix3Entries {
    S e[9];
};

/// f(0), ..., f(8): written out, since a loop over entries keeps compilers from taking them apart.
template <class F>
auto entrywise(const F& f) -> Matrix3Entries<decltype(f(0))> {
    return {{f(0), f(1), f(2), f(3), f(4), f(5), f(6), f(7), f(8)}};
}

/// a b, row after row (b a, column after column).
template <class S>
Matrix3Entries<S> product(const Matrix3Entries<S>& a, const Matrix3Entries<S>& b) {
    return {{a.e[0] * b.e[0] + a.e[1] * b.e[3] + a.e[2] * b.e[6], a.e[0] * b.e[1] + a.e[1] * b.e[4] + a.e[2] * b.e[7],
             a.e[0] * b.e[2] + a.e[1] * b.e[5] + a.e[2] * b.e[8], a.e[3] * b.e[0] + a.e[4] * b.e[3] + a.e[5] * b.e[6],
             a.e[3] * b.e[1] + a.e[4] * b.e[4] + a.e[5] * b.e[7], a.e[3] * b.e[2] + a.e[4] * b.e[5] + a.e[5] * b.e[8],
             a.e[6] * b.e[0] + a.e[7] * b.e[3] + a.e[8] * b.e[6], a.e[6] * b.e[1] + a.e[7] * b.e[4] + a.e[8] * b.e[7],
             a.e[6] * b.e[2] + a.e[7] * b.e[5] + a.e[8] * b.e[8]}};
}

template <class S>
struct Matrix3Lanes {
    static constexpr Index lanes = 32;
    alignas(64) S e[9][lanes];

    /// `count` columns of a 9 x n array that lie `stride` apart, and zeros for the other lanes.
    void load(const S* columns, Index stride, Index count) {
        if (count == lanes && stride == 9) {
            columns_to_lanes(columns, e);
            return;
        }
        for (Index l = 0; l < count; ++l) {
            const S* const column = columns + stride * l;
            set_lane(l, entrywise([column](int i) { return column[i]; }));
        }
        for (Index l = count; l < lanes; ++l) {
            set_lane(l, entrywise([](int) { return S(0); }));
        }
    }

    void store(S* columns, Index stride, Index count) const {
        if (count == lanes && stride == 9) {
            lanes_to_columns(e, columns);
            return;
        }
        for (Index l = 0; l < count; ++l) {
            S* const column = columns + stride * l;
            entrywise([&](int i) { return column[i] = e[i][l]; });
        }
    }

    void transpose() {
        std::swap(e[1], e[3]);
        std::swap(e[2], e[6]);
        std::swap(e[5], e[7]);
    }

    Matrix3Entries<S> lane(Index l) const {
        return entrywise([&](int i) { return e[i][l]; });
    }

    void set_lane(Index l, const Matrix3Entries<S>& M) {
        entrywise([&](int i) { return e[i][l] = M.e[i]; });
    }
};

/// body(first column, number of columns) for blocks of at most 32 columns.
template <class E, class Body>
void for_each_lane_block(const E& executor, Index columns, const Body& body) {
    constexpr Index lanes = Matrix3Lanes<float>::lanes;
    executor.for_each_range((columns + lanes - 1) / lanes, [&](Index begin, Index end) {
        for (Index block = begin; block < end; ++block) {
            body(lanes * block, std::min(lanes, columns - lanes * block));
        }
    });
}

}  // namespace softtissue
