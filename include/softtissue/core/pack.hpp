// SPDX-License-Identifier: MIT
/// @file
/// Several real numbers side by side: one number for formulas, one SIMD register for the machine.
///
/// What        Pack<T, N>: arithmetic, comparisons that give masks, select(); usable as an Eigen scalar
/// Equation    every operation acts lane by lane, (a + b)[i] = a[i] + b[i]: a lane never depends on the others
/// Width       natural_lanes<T> fill a register. A multiple of that is as many registers: for formulas whose every step waits for
///             the one before, which the processor then computes side by side. Other widths are plain arrays: right, but not fast.
/// Branching   a comparison gives a PackMask; `&`, `|`, `!` combine masks, select(mask, a, b) chooses, any_of() and all_of()
///             ask. There is no plain value: FieldScalar, RealLanes, not HasPlainValue.
/// Tests       tests/unit/core/pack_test.cpp
#pragma once

#include <softtissue/core/pack_mask.hpp>
#include <softtissue/core/scalar.hpp>

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <cstring>
#include <type_traits>

namespace softtissue {

/// N numbers of type T; see the file comment.
template <RealScalar T, int N>
struct Pack {
    static_assert(N > 0, "a pack has at least one lane");
    static constexpr bool is_vector = detail::fits_register<T, N>;     ///< one register
    static constexpr bool is_several = detail::fills_registers<T, N>;  ///< several, each a Pack of its own
    using Mask = PackMask<T, N>;
    using Lanes = typename detail::LaneStorage<T, N>::Values;

    Lanes lanes;

    /// Uninitialised like a plain number.
    Pack() = default;

    /// The same number in every lane; implicit, so that `S x = 1` and `2 * F` read as for a plain number.
    template <PlainNumber A>
    [[gnu::always_inline]] inline Pack(A number) {
        if constexpr (is_vector) {
            lanes = static_cast<T>(number) - Lanes{};  // keeps the sign of -0
        } else {
            lanes.fill(static_cast<T>(number));
        }
    }

    /// N numbers in memory, of any alignment.
    [[gnu::always_inline]] static inline Pack load(const T* numbers) {
        Pack result;
        if constexpr (is_several) {  // register by register: compilers call a routine for more than one
            for (std::size_t i = 0; i < result.lanes.size(); ++i) {
                result.lanes[i] = Pack<T, natural_lanes<T>>::load(numbers + i * std::size_t(natural_lanes<T>));
            }
        } else {
            std::memcpy(&result.lanes, numbers, sizeof(T) * std::size_t(N));
        }
        return result;
    }
    [[gnu::always_inline]] inline void store(T* numbers) const {
        if constexpr (is_several) {
            for (std::size_t i = 0; i < lanes.size(); ++i) {
                lanes[i].store(numbers + i * std::size_t(natural_lanes<T>));
            }
        } else {
            std::memcpy(numbers, &lanes, sizeof(T) * std::size_t(N));
        }
    }

    /// lane_value(i) in lane i.
    template <class F>
    [[gnu::always_inline]] static inline Pack from_lanes(const F& lane_value) {
        std::array<T, std::size_t(N)> numbers;
        for (int i = 0; i < N; ++i) {
            numbers[std::size_t(i)] = lane_value(i);
        }
        return load(numbers.data());
    }

    T operator[](int i) const {
        if constexpr (is_several) {
            return lanes[std::size_t(i / natural_lanes<T>)][i % natural_lanes<T>];
        } else {
            return lanes[std::size_t(i)];
        }
    }

    [[gnu::always_inline]] inline Pack& operator+=(const Pack& b) { return *this = *this + b; }
    [[gnu::always_inline]] inline Pack& operator-=(const Pack& b) { return *this = *this - b; }
    [[gnu::always_inline]] inline Pack& operator*=(const Pack& b) { return *this = *this * b; }
    [[gnu::always_inline]] inline Pack& operator/=(const Pack& b) { return *this = *this / b; }

    [[gnu::always_inline]] friend inline Pack operator+(const Pack& a) { return a; }
    [[gnu::always_inline]] friend inline Pack operator-(const Pack& a) {
        return map([](const auto& x) { return -x; }, a);
    }
    [[gnu::always_inline]] friend inline Pack operator+(const Pack& a, const Pack& b) {
        return map([](const auto& x, const auto& y) { return x + y; }, a, b);
    }
    [[gnu::always_inline]] friend inline Pack operator-(const Pack& a, const Pack& b) {
        return map([](const auto& x, const auto& y) { return x - y; }, a, b);
    }
    [[gnu::always_inline]] friend inline Pack operator*(const Pack& a, const Pack& b) {
        return map([](const auto& x, const auto& y) { return x * y; }, a, b);
    }
    [[gnu::always_inline]] friend inline Pack operator/(const Pack& a, const Pack& b) {
        return map([](const auto& x, const auto& y) { return x / y; }, a, b);
    }

    [[gnu::always_inline]] friend inline Mask operator<(const Pack& a, const Pack& b) {
        return Mask::map([](const auto& x, const auto& y) { return x < y; }, a, b);
    }
    [[gnu::always_inline]] friend inline Mask operator<=(const Pack& a, const Pack& b) {
        return Mask::map([](const auto& x, const auto& y) { return x <= y; }, a, b);
    }
    [[gnu::always_inline]] friend inline Mask operator>(const Pack& a, const Pack& b) { return b < a; }
    [[gnu::always_inline]] friend inline Mask operator>=(const Pack& a, const Pack& b) { return b <= a; }
    [[gnu::always_inline]] friend inline Mask operator==(const Pack& a, const Pack& b) {
        return Mask::map([](const auto& x, const auto& y) { return x == y; }, a, b);
    }
    [[gnu::always_inline]] friend inline Mask operator!=(const Pack& a, const Pack& b) {
        return Mask::map([](const auto& x, const auto& y) { return x != y; }, a, b);
    }

    /// a where the mask holds, b elsewhere.
    [[gnu::always_inline]] friend inline Pack select(const Mask& mask, const Pack& a, const Pack& b) {
        Pack result;
        if constexpr (is_vector) {
            result.lanes = mask.lanes ? a.lanes : b.lanes;
        } else if constexpr (is_several) {
            for (std::size_t i = 0; i < result.lanes.size(); ++i) {
                result.lanes[i] = select(mask.lanes[i], a.lanes[i], b.lanes[i]);
            }
        } else {
            for (std::size_t i = 0; i < std::size_t(N); ++i) {
                result.lanes[i] = mask.lanes[i] ? a.lanes[i] : b.lanes[i];
            }
        }
        return result;
    }

    /// f of the registers, or of each lane.
    template <class F, class... Operands>
    [[gnu::always_inline]] static inline Pack map(const F& f, const Operands&... operands) {
        if constexpr (is_vector) {
            Pack result;
            result.lanes = f(operands.lanes...);
            return result;
        } else if constexpr (is_several) {
            return map_parts([&f](const auto&... parts) { return Pack<T, natural_lanes<T>>::map(f, parts...); },
                             operands...);
        } else {
            return map_parts(f, operands...);
        }
    }

    /// f of each pack that fills a register, or of each lane, where this is not one register.
    template <class F, class... Operands>
    [[gnu::always_inline]] static inline Pack map_parts(const F& f, const Operands&... operands) {
        Pack result;
        for (std::size_t i = 0; i < result.lanes.size(); ++i) {
            result.lanes[i] = f(operands.lanes[i]...);
        }
        return result;
    }

    /// f of each lane, one after the other.
    template <class F, class... Operands>
    static Pack map_lanes(const F& f, const Operands&... operands) {
        return from_lanes([&](int i) { return f(operands[i]...); });
    }
};

template <class T, int N>
struct ScalarTraits<Pack<T, N>> {
    using Real = T;
    static constexpr int num_lanes = N;
};

/// Lane i of x; of a plain number, which has one lane, the number.
template <RealLanes Scalar>
RealOf<Scalar> lane(const Scalar& x, int i) {
    if constexpr (RealScalar<Scalar>) {
        return x;
    } else {
        return x[i];
    }
}

/// N fixed-size matrices side by side, matrix(i) in lane i.
template <int N, class F>
auto packed_matrix(const F& matrix) {
    using Matrix = std::remove_cvref_t<decltype(matrix(0))>;
    using T = typename Matrix::Scalar;
    constexpr int size = Matrix::SizeAtCompileTime;
    std::array<T, std::size_t(size * N)> numbers;
    for (int i = 0; i < N; ++i) {
        const auto& entries = matrix(i);
        for (int k = 0; k < size; ++k) {
            numbers[std::size_t(k * N + i)] = entries.data()[k];
        }
    }
    Eigen::Matrix<Pack<T, N>, Matrix::RowsAtCompileTime, Matrix::ColsAtCompileTime> result;
    for (int k = 0; k < size; ++k) {
        result.data()[k] = Pack<T, N>::load(numbers.data() + k * N);
    }
    return result;
}

/// The matrix in lane i.
template <RealLanes Scalar, int rows, int columns>
Eigen::Matrix<RealOf<Scalar>, rows, columns> lane(const Eigen::Matrix<Scalar, rows, columns>& matrix, int i) {
    Eigen::Matrix<RealOf<Scalar>, rows, columns> result;
    for (int k = 0; k < rows * columns; ++k) {
        result.data()[k] = lane(matrix.data()[k], i);
    }
    return result;
}

}  // namespace softtissue

namespace Eigen {

/// Makes Pack an Eigen scalar; thresholds are those of the real number underneath.
template <class T, int N>
struct NumTraits<softtissue::Pack<T, N>> : NumTraits<T> {
    using Real = softtissue::Pack<T, N>;
    using NonInteger = softtissue::Pack<T, N>;
    using Nested = softtissue::Pack<T, N>;
    using Literal = T;
};

/// Lets plain scalars and matrices mix with packs: 2.0 * F, F * fibre.
template <class T, int N, class Operation>
struct ScalarBinaryOpTraits<softtissue::Pack<T, N>, T, Operation> {
    using ReturnType = softtissue::Pack<T, N>;
};
template <class T, int N, class Operation>
struct ScalarBinaryOpTraits<T, softtissue::Pack<T, N>, Operation> {
    using ReturnType = softtissue::Pack<T, N>;
};

}  // namespace Eigen
