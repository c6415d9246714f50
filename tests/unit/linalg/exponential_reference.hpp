// SPDX-License-Identifier: MIT
// The exponential and its derivative in 80-bit arithmetic by the plainest method, and matrices to try them on.
#pragma once

#include <softtissue/testing/random_states.hpp>

namespace softtissue_test {

using namespace softtissue;

using ExactMatrix3 = Matrix3<long double>;

/// A pair that multiplies like the block matrix [[X, L], [0, X]].
struct ExactBlock {
    ExactMatrix3 X, L;

    ExactBlock operator*(const ExactBlock& b) const { return {X * b.X, X * b.L + L * b.X}; }
};

/// exp Q and the derivative of exp at Q applied to E.
inline ExactBlock exact_block(const ExactMatrix3& Q, const ExactMatrix3& E) {
    constexpr int squarings = 6;  // 2^6 of the last of 64 bits: a thirtieth of that of a double
    const long double scale = std::ldexp(1.0L, -squarings);
    const ExactBlock A{scale * Q, scale * E};
    ExactBlock result{ExactMatrix3::Identity(), ExactMatrix3::Zero()};
    for (int k = 26; k > 0; --k) {
        result = result * A;
        result.X = result.X / k + ExactMatrix3::Identity();
        result.L /= k;
    }
    for (int k = 0; k < squarings; ++k) {
        result = result * result;
    }
    return result;
}

template <class S>
ExactMatrix3 exact_exponential(const Matrix3<S>& Q) {
    return exact_block(Q.template cast<long double>(), ExactMatrix3::Zero()).X;
}
template <class S>
ExactMatrix3 exact_derivative(const Matrix3<S>& Q, const Matrix3<S>& E) {
    return exact_block(Q.template cast<long double>(), E.template cast<long double>()).L;
}

inline constexpr int num_matrix_kinds = 6;

/// A matrix of the given Frobenius norm: general, skew, symmetric, triangular, a multiple of I but for a little, nilpotent.
template <class S>
Matrix3<S> random_matrix_of_kind(RandomGenerator& random, int kind, double norm) {
    Matrix3<double> M = random_normal<Matrix3<double>>(random);
    switch (kind) {
        case 1:
            M = M - M.transpose().eval();
            break;
        case 2:
            M = M + M.transpose().eval();
            break;
        case 3:
            M = Matrix3<double>(M.triangularView<Eigen::Upper>());
            break;
        case 4:
            M = 1e-3 * M + (random.uniform() < 0.5 ? 1 : -1) * Matrix3<double>::Identity();
            break;
        case 5:
            M = Matrix3<double>(M.triangularView<Eigen::StrictlyUpper>());
            break;
        default:
            break;
    }
    return (norm / M.norm() * M).cast<S>();
}

}  // namespace softtissue_test
