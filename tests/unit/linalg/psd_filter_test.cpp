// SPDX-License-Identifier: MIT
#include <softtissue/linalg/psd_filter.hpp>

#include <softtissue/core/notation.hpp>
#include <softtissue/core/pack.hpp>

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

using namespace softtissue;

namespace {

/// A small generator of numbers in [-1, 1).
struct Numbers {
    std::uint32_t state;
    double next() {
        state = state * 1664525u + 1013904223u;
        return double(state) / 2147483648.0 - 1.0;
    }
};

// Plain loops, because fixed-size decompositions and products of this size take long to compile.

/// Random columns, made orthonormal one after the other, twice.
template <class Scalar, int N>
Eigen::Matrix<Scalar, N, N> random_orthogonal(Numbers& numbers) {
    Eigen::Matrix<Scalar, N, N> Q;
    for (Scalar& entry : Q.reshaped()) {
        entry = Scalar(numbers.next());
    }
    for (int j = 0; j < N; ++j) {
        for (int k = 0; k < 2 * j; ++k) {
            Q.col(j) -= Q.col(k % j).dot(Q.col(j)) * Q.col(k % j);
        }
        Q.col(j) /= Q.col(j).norm();
    }
    return Q;
}

/// Q diag(eigenvalues) Q^T
template <class Scalar, int N>
Eigen::Matrix<Scalar, N, N> composed(const Eigen::Matrix<Scalar, N, N>& Q,
                                     const Eigen::Matrix<Scalar, N, 1>& eigenvalues) {
    Eigen::Matrix<Scalar, N, N> H;
    for (int j = 0; j < N; ++j) {
        for (int i = 0; i < N; ++i) {
            H(i, j) = Scalar(0);
            for (int k = 0; k < N; ++k) {
                H(i, j) += eigenvalues(k) * (Q(i, k) * Q(j, k));
            }
        }
    }
    return H;
}

}  // namespace

TEST_CASE_TEMPLATE("a filtered matrix has filtered eigenvalues and the same eigenvectors", Scalar, float, double) {
    using Matrix9 = Eigen::Matrix<Scalar, 9, 9>;
    using Vector9 = Eigen::Matrix<Scalar, 9, 1>;
    // Each stage (composition, decomposition, update, composition of what is expected) is backward stable to N epsilon |H|.
    const Scalar tolerance = Scalar(4 * 9) * std::numeric_limits<Scalar>::epsilon() * Scalar(7);
    Numbers numbers{7u};
    Vector9 eigenvalues;
    eigenvalues << Scalar(-7), Scalar(-2), Scalar(-2), Scalar(-1e-3), Scalar(0), Scalar(0.5), Scalar(1), Scalar(1),
        Scalar(4);
    for (int repeat = 0; repeat < 20; ++repeat) {
        const Matrix9 Q = random_orthogonal<Scalar, 9>(numbers);
        const Matrix9 H = composed<Scalar, 9>(Q, eigenvalues);

        const Matrix9 clamped = filtered(H, PsdFilter::clamp);
        CHECK((clamped == clamped.transpose()));
        CHECK((clamped - composed<Scalar, 9>(Q, eigenvalues.cwiseMax(Scalar(0)))).cwiseAbs().maxCoeff() < tolerance);

        const Matrix9 absolute = filtered(H, PsdFilter::absolute);
        CHECK((absolute == absolute.transpose()));
        CHECK((absolute - composed<Scalar, 9>(Q, eigenvalues.cwiseAbs())).cwiseAbs().maxCoeff() < tolerance);

        CHECK((filtered(H, PsdFilter::none) == H));
    }
}

TEST_CASE_TEMPLATE("a positive semi-definite matrix is returned bit for bit", Scalar, float, double) {
    using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;
    Numbers numbers{11u};
    const Matrix3 definite =
        composed<Scalar, 3>(random_orthogonal<Scalar, 3>(numbers), {Scalar(0.5), Scalar(1), Scalar(2)});
    const Matrix3 zero = Matrix3::Zero();
    const Matrix3 singular = Eigen::Matrix<Scalar, 3, 1>(Scalar(2), Scalar(0), Scalar(1)).asDiagonal();
    for (const PsdFilter filter : {PsdFilter::none, PsdFilter::clamp, PsdFilter::absolute}) {
        CHECK((filtered(definite, filter) == definite));
        CHECK((filtered(zero, filter) == zero));
        CHECK((filtered(singular, filter) == singular));
    }
}

TEST_CASE("only the lower triangle is read") {
    Eigen::Matrix2d H;
    H << 1, 99, 2, 1;  // as a symmetric matrix: eigenvalues -1 and 3
    const Eigen::Matrix2d clamped = filtered(H, PsdFilter::clamp);
    CHECK((clamped - Eigen::Matrix2d::Constant(1.5)).cwiseAbs().maxCoeff() < 1e-15);
}

TEST_CASE("a single eigenvalue is filtered on both sides of zero") {
    CHECK(filtered_eigenvalue(-2.0, PsdFilter::none) == -2.0);
    CHECK(filtered_eigenvalue(-2.0, PsdFilter::clamp) == 0.0);
    CHECK(filtered_eigenvalue(-2.0, PsdFilter::absolute) == 2.0);
    for (const PsdFilter filter : {PsdFilter::none, PsdFilter::clamp, PsdFilter::absolute}) {
        CHECK(filtered_eigenvalue(0.0, filter) == 0.0);
        CHECK(filtered_eigenvalue(2.0f, filter) == 2.0f);
    }
}

TEST_CASE("a matrix that is not finite stays so") {
    Eigen::Matrix3d H = Eigen::Matrix3d::Identity();
    H(1, 0) = H(0, 1) = std::numeric_limits<double>::quiet_NaN();
    CHECK_FALSE(filtered(H, PsdFilter::clamp).allFinite());
    CHECK_FALSE(filtered(H, PsdFilter::absolute).allFinite());
}

TEST_CASE_TEMPLATE("a lane depends on no other, overflow beside it included", S, float, double) {
    using Matrix3 = Eigen::Matrix<S, 3, 3>;
    constexpr int width = natural_lanes<S>;
    const S infinity = std::numeric_limits<S>::infinity();
    std::vector<Matrix3> list(std::size_t(width), -Matrix3::Identity());
    list[0] = Vector3<S>(infinity, 1, 1).asDiagonal();  // its Cholesky factorisation exists
    list[0](1, 0) = list[0](0, 1) = S(1);
    const auto together = filtered(packed_matrix<width>([&](int i) { return list[std::size_t(i)]; }), PsdFilter::clamp);
    for (int i = 0; i < width; ++i) {
        const auto alone = filtered(packed_matrix<width>([&](int) { return list[std::size_t(i)]; }), PsdFilter::clamp);
        CHECK(lane(together, i) == lane(alone, i));
    }
}

TEST_CASE_TEMPLATE("an eigenvalue too large for a number does no harm", S, float, double) {
    using Matrix4 = Eigen::Matrix<S, 4, 4>;
    Matrix4 H = Matrix4::Constant(std::numeric_limits<S>::max() / S(2));  // largest eigenvalue 2 max, others 0 and -1
    H(3, 3) = S(-1);
    H.col(3).head(3).setZero();
    H.row(3).head(3).setZero();
    const Matrix4 clamped = filtered(H, PsdFilter::clamp);
    CHECK(clamped.allFinite());
    CHECK((clamped / std::numeric_limits<S>::max() - H / std::numeric_limits<S>::max()).cwiseAbs().maxCoeff() <
          S(1e-5));
}
