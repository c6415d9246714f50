// SPDX-License-Identifier: MIT
#include <softtissue/linalg/matrix_packs.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE_TEMPLATE("there and back, lanes beyond the last matrix repeat it", S, float, double) {
    constexpr int N = 4;
    for (const Index count : {1, 3, 4, 6}) {
        Matrix3X<S> matrices(3, 3 * count), back = Matrix3X<S>::Zero(3, 3 * count);
        for (Index k = 0; k < matrices.size(); ++k) {
            matrices.data()[k] = S(k);
        }
        for (Index first = 0; first < count; first += N) {
            const Matrix3<Pack<S, N>> packed = load_matrices<N>(matrices, first);
            for (int i = 0; i < N; ++i) {
                const Index c = std::min(first + i, count - 1);
                CHECK(lane(packed, i) == matrices.template middleCols<3>(3 * c));
            }
            store_matrices<N>(packed, first, back);
        }
        CHECK(back == matrices);
    }
}

TEST_CASE_TEMPLATE("packs side by side keep their lanes", S, float, double) {
    constexpr int N = natural_lanes<S>, count = N > 1 ? 3 : 1;
    Matrix3X<S> matrices(3, 3 * N * count);
    for (Index k = 0; k < matrices.size(); ++k) {
        matrices.data()[k] = S(k);
    }
    const auto joined = side_by_side<count>([&](int k) { return load_matrices<N>(matrices, N * k); });
    static_assert(num_lanes<typename decltype(joined)::Scalar> == N * count);
    for (int i = 0; i < N * count; ++i) {
        CHECK(lane(joined, i) == matrices.template middleCols<3>(3 * i));
    }
}
