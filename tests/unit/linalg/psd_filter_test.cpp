// SPDX-License-Identifier: MIT
#include <softtissue/linalg/psd_filter.hpp>

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cstdint>
#include <limits>

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

template <class Scalar, int N>
Eigen::Matrix<Scalar, N, N> with_eigenvalues(const Eigen::Matrix<Scalar, N, 1>& eigenvalues, Numbers& numbers) {
    using Matrix = Eigen::Matrix<Scalar, N, N>;
    const Matrix random =
        Matrix::NullaryExpr([&numbers](Eigen::Index, Eigen::Index) { return Scalar(numbers.next()); });
    const Matrix Q = Eigen::HouseholderQR<Matrix>(random).householderQ();
    const Matrix H = Q * eigenvalues.asDiagonal() * Q.transpose();
    return (H + H.transpose()) / Scalar(2);
}

template <class Scalar, int N>
Eigen::Matrix<Scalar, N, 1> eigenvalues_of(const Eigen::Matrix<Scalar, N, N>& H) {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<Scalar, N, N>>(H, Eigen::EigenvaluesOnly).eigenvalues();
}

}  // namespace

TEST_CASE_TEMPLATE("the eigenvalues of a filtered matrix are the filtered eigenvalues", Scalar, float, double) {
    using Matrix9 = Eigen::Matrix<Scalar, 9, 9>;
    using Vector9 = Eigen::Matrix<Scalar, 9, 1>;
    // Each stage (QR, two products, decomposition, update, second decomposition) is backward stable to N epsilon |H|.
    const Scalar tolerance = Scalar(6 * 9) * std::numeric_limits<Scalar>::epsilon() * Scalar(7);
    Numbers numbers{7u};
    Vector9 eigenvalues;
    eigenvalues << Scalar(-7), Scalar(-2), Scalar(-2), Scalar(-1e-3), Scalar(0), Scalar(0.5), Scalar(1), Scalar(1),
        Scalar(4);
    for (int repeat = 0; repeat < 20; ++repeat) {
        const Matrix9 H = with_eigenvalues<Scalar, 9>(eigenvalues, numbers);

        const Matrix9 clamped = filtered(H, PsdFilter::clamp);
        CHECK((clamped - clamped.transpose()).cwiseAbs().maxCoeff() == Scalar(0));
        CHECK((eigenvalues_of(clamped) - eigenvalues.cwiseMax(Scalar(0))).cwiseAbs().maxCoeff() < tolerance);

        Vector9 expected = eigenvalues.cwiseAbs();
        std::sort(expected.data(), expected.data() + 9);
        const Matrix9 absolute = filtered(H, PsdFilter::absolute);
        CHECK((absolute - absolute.transpose()).cwiseAbs().maxCoeff() == Scalar(0));
        CHECK((eigenvalues_of(absolute) - expected).cwiseAbs().maxCoeff() < tolerance);

        // (H + |H|) / 2 is the clamped matrix: eigenvectors are kept, not only eigenvalues.
        CHECK(((H + absolute) / Scalar(2) - clamped).cwiseAbs().maxCoeff() < tolerance);
        CHECK(filtered(H, PsdFilter::none) == H);
    }
}

TEST_CASE_TEMPLATE("a positive semi-definite matrix is returned bit for bit", Scalar, float, double) {
    using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;
    Numbers numbers{11u};
    const Matrix3 definite = with_eigenvalues<Scalar, 3>({Scalar(0.5), Scalar(1), Scalar(2)}, numbers);
    const Matrix3 zero = Matrix3::Zero();
    const Matrix3 singular = Eigen::Matrix<Scalar, 3, 1>(Scalar(2), Scalar(0), Scalar(1)).asDiagonal();
    for (const PsdFilter filter : {PsdFilter::none, PsdFilter::clamp, PsdFilter::absolute}) {
        CHECK(filtered(definite, filter) == definite);
        CHECK(filtered(zero, filter) == zero);
        CHECK(filtered(singular, filter) == singular);
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
