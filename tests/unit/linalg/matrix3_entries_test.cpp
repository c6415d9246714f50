// SPDX-License-Identifier: MIT
#include <softtissue/linalg/matrix3_entries.hpp>

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <vector>

using namespace softtissue;

namespace {

template <class S>
Matrix3Entries<S> row_after_row(const Matrix3<S>& M) {
    Matrix3Entries<S> result;
    Eigen::Map<Eigen::Matrix<S, 3, 3, Eigen::RowMajor>>(result.e) = M;
    return result;
}

}  // namespace

TEST_CASE_TEMPLATE("products", S, float, double) {
    RandomGenerator random(1);
    const Matrix3<S> A = random_normal<Matrix3<S>>(random), B = random_normal<Matrix3<S>>(random);
    const Matrix3Entries<S> C = product(row_after_row(A), row_after_row(B));
    for (int i = 0; i < 9; ++i) {
        CHECK(double(C.e[i]) == doctest::Approx(double(row_after_row<S>(A * B).e[i])).epsilon(1e-6));
    }
}

TEST_CASE_TEMPLATE("columns become lanes and come back, full blocks and the rest, dense and with a stride", S, float,
                   double) {
    RandomGenerator random(2);
    for (const Index stride : {9, 11}) {
        for (const Index count : {16, 1, 7}) {
            std::vector<S> from(size_t(16 * stride), S(-1)), to = from;
            for (S& entry : from) {
                entry = S(random.normal());
            }
            Matrix3Lanes<S> block;
            block.load(from.data(), stride, count);
            for (Index l = 0; l < 16; ++l) {
                for (int i = 0; i < 9; ++i) {
                    CHECK(block.lane(l).e[i] == (l < count ? from[size_t(stride * l + i)] : S(0)));
                }
            }
            block.store(to.data(), stride, count);
            for (Index k = 0; k < 16 * stride; ++k) {
                const bool is_written = k / stride < count && k % stride < 9;
                CHECK(to[size_t(k)] == (is_written ? from[size_t(k)] : S(-1)));
            }
        }
    }
}

TEST_CASE("lanes are set and transposed") {
    Matrix3Lanes<double> block;
    block.set_lane(3, {{0, 1, 2, 3, 4, 5, 6, 7, 8}});
    block.transpose();
    const Matrix3Entries<double> M = block.lane(3);
    const double expected[] = {0, 3, 6, 1, 4, 7, 2, 5, 8};
    for (int i = 0; i < 9; ++i) {
        CHECK(M.e[i] == expected[i]);
    }
}

TEST_CASE("every column is in one block of at most 32") {
    for (const Index columns : {0, 1, 32, 33, 100}) {
        std::vector<int> visits(size_t(columns), 0);
        for_each_lane_block(ThreadExecutor(3), columns, [&](Index first, Index count) {
            for (Index column = first; column < first + count; ++column) {
                ++visits[size_t(column)];
            }
        });
        CHECK(visits == std::vector<int>(size_t(columns), 1));
    }
}
