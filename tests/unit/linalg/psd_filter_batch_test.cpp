// SPDX-License-Identifier: MIT
#include <softtissue/linalg/psd_filter_batch.hpp>

#include <softtissue/core/random.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <vector>

using namespace softtissue;

namespace {

/// Random matrices of sizes from 1e-6 to 1e6, every fourth of them with equal eigenvalues, every seventh zero.
template <class S>
std::vector<Matrix9<S>> random_matrices(size_t count, std::uint64_t seed) {
    RandomGenerator random(seed);
    std::vector<Matrix9<S>> matrices(count);
    for (size_t k = 0; k < count; ++k) {
        Matrix9<S>& H = matrices[k];
        for (int j = 0; j < 9; ++j) {
            for (int i = j; i < 9; ++i) {
                H(i, j) = H(j, i) = S(random.uniform(-1, 1));
            }
        }
        if (k % 4 == 3) {
            const Vector9<S> v = H.col(0);
            H = v * v.transpose() - v.squaredNorm() * Matrix9<S>::Identity() / S(3);
        }
        H *= k % 7 == 6 ? S(0) : S(std::pow(10.0, random.uniform(-6, 6)));
    }
    return matrices;
}

}  // namespace

TEST_CASE_TEMPLATE("as one by one", S, float, double) {
    for (const size_t count : {0u, 1u, 7u, 8u, 9u, 60u}) {
        const std::vector<Matrix9<S>> given = random_matrices<S>(count, count);
        for (const PsdFilter filter : {PsdFilter::clamp, PsdFilter::absolute}) {
            std::vector<Matrix9<S>> matrices = given;
            filter_in_place<S, 9>(matrices, filter);
            for (size_t k = 0; k < count; ++k) {
                // both are sums over some two hundred rotations
                CHECK((matrices[k] - filtered(given[k], filter)).norm() <=
                      256 * std::numeric_limits<S>::epsilon() * given[k].norm());
                CHECK(matrices[k] == matrices[k].transpose());
            }
        }
        std::vector<Matrix9<S>> matrices = given;
        filter_in_place<S, 9>(matrices, PsdFilter::none);
        CHECK(matrices == given);
    }
}

TEST_CASE_TEMPLATE("a matrix does not notice its neighbours", S, float, double) {
    std::vector<Matrix9<S>> together = random_matrices<S>(21, 3);
    std::vector<Matrix9<S>> alone = together;
    together[4](3, 1) = std::numeric_limits<S>::quiet_NaN();
    together[12](0, 0) = std::numeric_limits<S>::infinity();
    filter_in_place<S, 9>(together, PsdFilter::clamp);
    for (size_t k = 0; k < alone.size(); ++k) {
        filter_in_place<S, 9>(std::span(alone).subspan(k, 1), PsdFilter::clamp);
        CHECK((k == 4 || k == 12 ? !together[k].allFinite() : together[k] == alone[k]));
    }
}

TEST_CASE_TEMPLATE("what is positive semi-definite to rounding keeps its digits", S, float, double) {
    std::vector<Eigen::Matrix<S, 3, 3>> matrices(3);
    matrices[0] << S(2), S(-1), S(0), S(-1), S(2), S(-1), S(0), S(-1), S(2);
    matrices[1].setZero();
    matrices[2] = Vector3<S>(S(2), S(0), S(1)).asDiagonal();
    std::vector<Eigen::Matrix<S, 3, 3>> filtered_ones = matrices;
    filter_in_place<S, 3>(filtered_ones, PsdFilter::clamp);
    CHECK(filtered_ones == matrices);
}

TEST_CASE("only the lower triangle is read") {
    Eigen::Matrix2d H;
    H << 1, 99, 2, 1;  // as a symmetric matrix: eigenvalues -1 and 3
    filter_in_place<double, 2>(std::span(&H, 1), PsdFilter::clamp);
    CHECK((H - Eigen::Matrix2d::Constant(1.5)).cwiseAbs().maxCoeff() < 1e-15);
}
