// SPDX-License-Identifier: MIT
#include <softtissue/sparse/factor_strips.hpp>

#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;

namespace {

/// A lower triangular matrix of `size` places, in strips of alternating width, and its strips.
template <class S>
struct Example {
    using Block = typename FactorStrips<S>::Block;
    static constexpr int size = 16;
    MatrixX<double> L = MatrixX<double>::Identity(size, size);
    FactorStrips<S> strips;

    explicit Example(int node_size) : strips(node_size) {
        RandomGenerator random(2);
        for (int begin = 0, k = 0; begin < size; ++k) {
            const int columns = k % 2 == 0 && begin + 4 <= size ? FactorStrips<S>::widest : node_size;
            Block D = Block::Identity(columns, columns);
            for (int r = 0; r < columns; ++r) {
                for (int c = 0; c < r; ++c) {
                    D(r, c) = 0.3 * random.normal();
                }
            }
            L.block(begin, begin, columns, columns) = D;
            strips.add_strip(begin, D.template triangularView<Eigen::Lower>().solve(Block::Identity(columns, columns)));
            for (int row = begin + columns; row < size; row += node_size) {
                if (row / node_size % 3 != k % 3) {
                    Block block(node_size, columns);
                    for (int e = 0; e < block.size(); ++e) {
                        block.data()[e] = 0.3 * random.normal();
                    }
                    L.block(row, begin, node_size, columns) = block;
                    strips.add_block(row, block);
                }
            }
            begin += columns;
        }
    }
};

}  // namespace

TEST_CASE_TEMPLATE("both sweeps are those of the matrix", S, float, double) {
    for (const int node_size : {1, 2}) {
        const Example<S> example(node_size);
        CHECK(example.strips.num_entries() > 0);
        CHECK(example.strips.num_bytes() > Index(sizeof(S)) * example.strips.num_entries());
        RandomGenerator random(3);
        Eigen::Matrix<S, 4, Example<S>::size> y, x;
        for (int k = 0; k < x.size(); ++k) {
            x.data()[k] = S(random.normal());
        }
        const double tolerance = 100 * double(std::numeric_limits<S>::epsilon());
        for (const bool is_up : {false, true}) {
            MatrixX<double> A = is_up ? MatrixX<double>(example.L) : MatrixX<double>(example.L.transpose());
            for (int v = 0; v < y.cols(); ++v) {  // y = x A^T or x A, by hand: no product of matrices to compile
                Eigen::Matrix<double, 4, 1> sum = Eigen::Matrix<double, 4, 1>::Zero();
                for (int u = 0; u < y.cols(); ++u) {
                    sum += A(v, u) * x.col(u).template cast<double>();
                }
                y.col(v) = sum.cast<S>();
            }
            is_up ? example.strips.eliminate(y.data()) : example.strips.substitute(y.data());
            CHECK((y - x).template cast<double>().cwiseAbs().maxCoeff() < tolerance);
        }
    }
}

TEST_CASE("without strips nothing moves") {
    double y[4] = {1, 2, 3, 4};
    const FactorStrips<double> none(1);
    none.eliminate(y);
    none.substitute(y);
    CHECK(y[3] == 4);
    CHECK(none.num_bytes() == 0);
}
