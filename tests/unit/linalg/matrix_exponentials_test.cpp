// SPDX-License-Identifier: MIT
#include <softtissue/linalg/matrix_exponentials.hpp>

#include "exponential_reference.hpp"

#include <softtissue/core/thread_executor.hpp>

#include <support/allocation_counter.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;
using namespace softtissue_test;

namespace {

/// Matrices of norms up to 4, some of which need squarings; column after column.
template <class S>
Matrix9X<S> columns(Index count, std::uint64_t seed) {
    RandomGenerator random(seed);
    Matrix9X<S> result(9, count);
    for (Index c = 0; c < count; ++c) {
        result.col(c) = vec(random_matrix_of_kind<S>(random, int(c) % num_matrix_kinds, random.uniform(0, 4)));
    }
    return result;
}

template <class S>
bool is_near(const Matrix3<S>& A, const Matrix3<S>& B, double epsilons) {
    return (A - B).norm() <= S(epsilons) * std::numeric_limits<S>::epsilon() * B.norm();
}

}  // namespace

TEST_CASE_TEMPLATE("every column as by itself, row after row or column after column", S, float, double) {
    for (const Index count : {0, 1, 15, 16, 100}) {
        const Matrix9X<S> Q = columns<S>(count, 1), G = columns<S>(count, 2);
        Matrix9X<S> X(9, count), L(9, count), X_rows(9, count), L_rows(9, count), Q_rows(9, count), G_rows(9, count);
        const auto transpose = [](const auto& column) { return vec<S>(unvec<S>(column).transpose()); };
        for (Index c = 0; c < count; ++c) {
            Q_rows.col(c) = transpose(Vector9<S>(Q.col(c)));
            G_rows.col(c) = transpose(Vector9<S>(G.col(c)));
        }
        matrix_exponentials_into<S>(Q, X);
        matrix_exponential_pullbacks_into<S>(Q, G, L);
        matrix_exponentials_into<S>(Q_rows, X_rows);
        matrix_exponential_pullbacks_into<S>(Q_rows, G_rows, L_rows);
        for (Index c = 0; c < count; ++c) {
            const Matrix3<S> q = unvec<S>(Q.col(c)), g = unvec<S>(G.col(c));
            CHECK(is_near(unvec<S>(X.col(c)), matrix_exponential(q), 10));
            CHECK(is_near(unvec<S>(L.col(c)), matrix_exponential_pullback(q, g), 40));
            CHECK(is_near(unvec<S>(transpose(Vector9<S>(X_rows.col(c)))), matrix_exponential(q), 10));
            CHECK(is_near(unvec<S>(transpose(Vector9<S>(L_rows.col(c)))), matrix_exponential_pullback(q, g), 40));
        }
    }
}

TEST_CASE_TEMPLATE("a column's bits depend neither on its neighbours nor on threads, memory or stride", S, float,
                   double) {
    const Matrix9X<S> Q = columns<S>(301, 3), G = columns<S>(301, 4);
    Matrix9X<S> X(9, 301), L(9, 301);
    matrix_exponentials_into<S>(Q, X);
    matrix_exponential_pullbacks_into<S>(Q, G, L);
    for (const Index shift : {1, 7, 50}) {
        const Index count = 301 - shift;
        Matrix9X<S> shifted(9, count), in_place = Q.rightCols(count);
        MatrixX<S> strided = MatrixX<S>::Zero(13, count);
        matrix_exponentials_into<S>(Q.rightCols(count), strided.middleRows(2, 9), ThreadExecutor(int(shift)));
        matrix_exponentials_into<S>(in_place, in_place);
        matrix_exponential_pullbacks_into<S>(Q.rightCols(count), G.rightCols(count), shifted, ThreadExecutor(2));
        CHECK(strided.middleRows(2, 9) == X.rightCols(count));
        CHECK(in_place == X.rightCols(count));
        CHECK(shifted == L.rightCols(count));
    }
}

TEST_CASE("nothing is allocated") {
    const Matrix9X<float> Q = columns<float>(40, 5);
    Matrix9X<float> X(9, 40);
    const AllocationCounter counter;
    matrix_exponentials_into<float>(Q, X);
    matrix_exponential_pullbacks_into<float>(Q, Q, X);
    CHECK(counter.count() == 0);
}

TEST_CASE("results of another size are refused") {
    const Matrix9X<double> Q = columns<double>(3, 6);
    Matrix9X<double> X(9, 2);
    CHECK_THROWS_WITH_AS(matrix_exponentials_into<double>(Q, X), "matrix exponentials: 2 results, expected 3",
                         InvalidInput);
    CHECK_THROWS_WITH_AS(matrix_exponential_pullbacks_into<double>(Q, Q, X),
                         "matrix exponential pullbacks: 3 gradients and 2 results, expected 3", InvalidInput);
}
