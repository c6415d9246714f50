// SPDX-License-Identifier: MIT
#include <softtissue/linalg/symmetric_eigen.hpp>

#include <softtissue/core/pack.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

using namespace softtissue;

namespace {

template <class Scalar, int N>
using Square = Eigen::Matrix<Scalar, N, N>;

/// Q diag(values) Q^T with a random orthogonal Q: a product of rotations in every plane.
template <class Scalar, int N>
Square<Scalar, N> with_spectrum(const std::array<double, std::size_t(N)>& values, RandomGenerator& random) {
    Square<double, N> Q = Square<double, N>::Identity();
    for (int p = 0; p < N; ++p) {
        for (int q = p + 1; q < N; ++q) {
            const double angle = random.uniform(0, 6.28), c = std::cos(angle), s = std::sin(angle);
            const Eigen::Matrix<double, N, 1> u = Q.col(p), v = Q.col(q);
            Q.col(p) = c * u - s * v;
            Q.col(q) = s * u + c * v;
        }
    }
    const Square<double, N> H =
        Q * Eigen::Map<const Eigen::Matrix<double, N, 1>>(values.data()).asDiagonal() * Q.transpose();
    return H.template cast<Scalar>();
}

template <class Scalar, int N>
Square<Scalar, N> random_symmetric(RandomGenerator& random) {
    Square<Scalar, N> H;
    for (int j = 0; j < N; ++j) {
        for (int i = j; i < N; ++i) {
            H(i, j) = H(j, i) = Scalar(random.normal());
        }
    }
    return H;
}

/// A few units in the last place of the largest eigenvalue, for N rotations a column.
template <class Scalar, int N>
Scalar tolerance(Scalar largest) {
    return Scalar(16 * N) * std::numeric_limits<Scalar>::epsilon() * largest;
}

template <class Scalar, int N>
void check(const Square<Scalar, N>& H) {
    const SymmetricEigen<Scalar, N> eigen = symmetric_eigen<Scalar, N>(H);
    const Scalar size = std::max(H.cwiseAbs().maxCoeff(), std::numeric_limits<Scalar>::min());
    const Square<Scalar, N> rebuilt = eigen.vectors * eigen.values.asDiagonal() * eigen.vectors.transpose();
    const Square<Scalar, N> gram = eigen.vectors.transpose() * eigen.vectors;
    CHECK((rebuilt - H).cwiseAbs().maxCoeff() <= tolerance<Scalar, N>(size * Scalar(N)));
    CHECK((gram - Square<Scalar, N>::Identity()).cwiseAbs().maxCoeff() <= tolerance<Scalar, N>(Scalar(1)));
}

}  // namespace

TEST_CASE_TEMPLATE("random symmetric matrices are decomposed", Scalar, float, double) {
    RandomGenerator random(1);
    for (int sample = 0; sample < 200; ++sample) {
        check<Scalar, 2>(random_symmetric<Scalar, 2>(random));
        check<Scalar, 3>(random_symmetric<Scalar, 3>(random));
        check<Scalar, 4>(random_symmetric<Scalar, 4>(random));
        check<Scalar, 9>(random_symmetric<Scalar, 9>(random));
    }
}

TEST_CASE_TEMPLATE("a known spectrum is found, repeated and zero eigenvalues included", Scalar, float, double) {
    RandomGenerator random(2);
    const std::array<double, 9> spectrum{-3, -3, -1, 0, 0, 0, 2, 2, 7};
    for (int sample = 0; sample < 50; ++sample) {
        const Square<Scalar, 9> H = with_spectrum<Scalar, 9>(spectrum, random);
        check<Scalar, 9>(H);
        Eigen::Matrix<Scalar, 9, 1> values = symmetric_eigen<Scalar, 9>(H).values;
        std::sort(values.data(), values.data() + 9);
        for (std::size_t k = 0; k < 9; ++k) {
            CHECK(std::abs(values(Index(k)) - Scalar(spectrum[k])) <= tolerance<Scalar, 9>(Scalar(7)));
        }
    }
}

TEST_CASE_TEMPLATE("special matrices", Scalar, float, double) {
    check<Scalar, 3>(Square<Scalar, 3>::Zero());
    check<Scalar, 3>(Square<Scalar, 3>::Identity());
    check<Scalar, 3>(Square<Scalar, 3>::Ones());
    check<Scalar, 3>(Square<Scalar, 3>(Vector3<Scalar>(3, -1, 2).asDiagonal()));
    // sizes whose squares leave the range
    const Scalar huge = std::sqrt(std::numeric_limits<Scalar>::max());
    check<Scalar, 3>(huge * Square<Scalar, 3>::Ones());
    check<Scalar, 3>(Square<Scalar, 3>::Ones() / huge);
}

TEST_CASE_TEMPLATE("only the lower triangle is read", Scalar, float, double) {
    RandomGenerator random(3);
    const Square<Scalar, 9> H = random_symmetric<Scalar, 9>(random);
    Square<Scalar, 9> lower = H;
    for (int j = 1; j < 9; ++j) {
        lower.col(j).head(j).setConstant(std::numeric_limits<Scalar>::quiet_NaN());
    }
    const SymmetricEigen<Scalar, 9> a = symmetric_eigen<Scalar, 9>(H), b = symmetric_eigen<Scalar, 9>(lower);
    CHECK(a.values == b.values);
    CHECK(a.vectors == b.vectors);
}

TEST_CASE_TEMPLATE("what is not finite gives NaN throughout, and leaves its neighbours in a pack alone", Scalar, float,
                   double) {
    using Limits = std::numeric_limits<Scalar>;
    using Lanes = Pack<Scalar, 4>;
    RandomGenerator random(12);
    const auto check_size = [&]<int N>(std::integral_constant<int, N>) {
        const Square<Scalar, N> good = random_symmetric<Scalar, N>(random);
        for (const Scalar bad : {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity()}) {
            for (int j = 0; j < N; ++j) {
                for (int i = j; i < N; ++i) {
                    Square<Scalar, N> H = good;
                    H(i, j) = bad;
                    const SymmetricEigen<Scalar, N> eigen = symmetric_eigen<Scalar, N>(H);
                    CHECK(eigen.values.array().isNaN().all());
                    CHECK(eigen.vectors.array().isNaN().all());
                    Square<Lanes, N> packed;
                    for (int k = 0; k < N * N; ++k) {
                        packed.data()[k] =
                            Lanes::from_lanes([&](int lane) { return (lane == 2 ? H : good).data()[k]; });
                    }
                    const SymmetricEigen<Lanes, N> lanes = symmetric_eigen<Lanes, N>(packed);
                    const SymmetricEigen<Lanes, N> alone = symmetric_eigen<Lanes, N>(good.template cast<Lanes>());
                    for (int k = 0; k < N; ++k) {
                        CHECK(std::isnan(lanes.values(k)[2]));
                        CHECK(lanes.values(k)[1] == alone.values(k)[1]);
                    }
                }
            }
        }
    };
    check_size(std::integral_constant<int, 3>());
    check_size(std::integral_constant<int, 9>());
}
