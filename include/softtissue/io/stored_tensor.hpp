// SPDX-License-Identifier: MIT
/// @file
/// One tensor as a .safetensors file holds it: any shape, any of the usual element types, read through typed accessors.
///
/// What        keeps the bytes as they are stored, in C order, and converts on access; rounds to 16 bits on request.
/// Shapes      matrix<S>() of an (r, c) tensor is r x c; values<T>() of any tensor is flat.
/// Valid       an access in the stored type returns the stored bits, NaN included. Conversions round to nearest, ties to even.
/// Refuses     a conversion that loses an integer or turns a finite number into an infinite one, a tensor of another shape
///             than asked for, bytes that are not those of the shape (InvalidInput names file, tensor and element).
/// Tests       tests/unit/io/stored_tensor_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/float16.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/io/npy_header.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace softtissue {

enum class TensorType { f64, f32, f16, bf16, i64, i32, u8 };

/// Bytes per element.
constexpr std::size_t size_of(TensorType type) {
    constexpr std::array<std::size_t, 7> sizes{8, 4, 2, 2, 8, 4, 1};
    return sizes[std::size_t(type)];
}

/// Is it a floating-point type?
constexpr bool is_real(TensorType type) {
    return type <= TensorType::bf16;
}

class StoredTensor {
public:
    /// Stands for "any extent" in require_shape().
    static constexpr Index any = -1;

    /// From `bytes` as they lie in a file; `source` (file and tensor) starts every message about this tensor.
    StoredTensor(std::string source, TensorType type, std::vector<Index> shape, std::vector<unsigned char> bytes)
        : source_(std::move(source)), type_(type), shape_(std::move(shape)), bytes_(std::move(bytes)) {
        for (const Index extent : shape_) {
            require(extent >= 0, source_, ": shape is ", shape_text(shape_), ", expected extents >= 0");
        }
        num_elements_ = count_npy_elements(source_, shape_);
        require(bytes_.size() % size_of(type_) == 0 && bytes_.size() / size_of(type_) == std::size_t(num_elements_),
                source_, ": ", bytes_.size(), " bytes, expected ", num_elements_, " elements of ", size_of(type_),
                " bytes for the shape ", shape_text(shape_));
    }

    /// `values` in C order, stored in their own type.
    template <class T>
    static StoredTensor from_values(std::span<const T> values, std::vector<Index> shape) {
        return from_values(values, std::move(shape), type_of<T>());
    }

    /// `values` in C order, converted to `type`.
    template <class T>
    static StoredTensor from_values(std::span<const T> values, std::vector<Index> shape, TensorType type) {
        std::vector<unsigned char> bytes(values.size() * size_of(type));
        const std::string source = "tensor";
        with_stored_type(type, [&](auto stored) {
            using Stored = decltype(stored);
            for (std::size_t i = 0; i < values.size(); ++i) {
                store(convert<Stored>(values[i], source, i), bytes.data() + i * sizeof(Stored));
            }
        });
        return {source, type, std::move(shape), std::move(bytes)};
    }

    /// An r x c matrix as an (r, c) tensor.
    template <class Derived>
    static StoredTensor from_matrix(const Eigen::MatrixBase<Derived>& matrix) {
        using T = typename Derived::Scalar;
        const MatrixX<T> rows = matrix.transpose();
        return from_values(std::span<const T>(rows.data(), std::size_t(rows.size())), {rows.cols(), rows.rows()});
    }

    /// A vector of n elements as an (n) tensor.
    template <class Derived>
    static StoredTensor from_vector(const Eigen::MatrixBase<Derived>& vector) {
        using T = typename Derived::Scalar;
        const VectorX<T> elements = vector;
        return from_values(std::span<const T>(elements.data(), std::size_t(elements.size())), {elements.size()});
    }

    const std::string& source() const { return source_; }
    TensorType type() const { return type_; }
    const std::vector<Index>& shape() const { return shape_; }
    Index num_elements() const { return num_elements_; }
    std::span<const unsigned char> bytes() const { return bytes_; }

    /// Throws unless the shape is `expected`, where `any` fits every extent.
    void require_shape(const std::vector<Index>& expected) const {
        const bool fits = std::equal(shape_.begin(), shape_.end(), expected.begin(), expected.end(),
                                     [](Index is, Index wanted) { return wanted == any || is == wanted; });
        require(fits, source_, ": shape is ", shape_text(shape_), ", expected ", shape_text(expected));
    }

    /// Writes all elements in C order, converted to T.
    template <class T>
    void copy_into(std::span<T> values) const {
        require(std::ssize(values) == num_elements_, source_, ": has ", num_elements_, " elements, expected ",
                values.size());
        with_stored_type(type_, [&](auto stored) {
            using Stored = decltype(stored);
            for (std::size_t i = 0; i < values.size(); ++i) {
                values[i] = convert<T>(load<Stored>(bytes_.data() + i * sizeof(Stored)), source_, i);
            }
        });
    }

    /// All elements in C order.
    template <class T>
    std::vector<T> values() const {
        std::vector<T> result(static_cast<std::size_t>(num_elements_));
        copy_into(std::span<T>(result));
        return result;
    }

    /// The only element of a tensor of one.
    template <class T>
    T scalar() const {
        require(num_elements_ == 1, source_, ": shape is ", shape_text(shape_), ", expected one number");
        return values<T>().front();
    }

    template <RealScalar S>
    VectorX<S> vector() const {
        require_shape({any});
        VectorX<S> result(num_elements_);
        copy_into(std::span<S>(result.data(), std::size_t(result.size())));
        return result;
    }

    template <RealScalar S>
    MatrixX<S> matrix() const {
        require_shape({any, any});
        MatrixX<S> rows(shape_[1], shape_[0]);
        copy_into(std::span<S>(rows.data(), std::size_t(rows.size())));
        return rows.transpose();
    }

private:
    template <class T>
    static constexpr bool is_float16 = std::is_same_v<T, Half> || std::is_same_v<T, BFloat16>;

    template <class T>
    static constexpr TensorType type_of() {
        static_assert(std::is_same_v<T, double> || std::is_same_v<T, float> || std::is_same_v<T, std::int64_t> ||
                          std::is_same_v<T, std::int32_t> || std::is_same_v<T, std::uint8_t>,
                      "tensors store double, float, int64, int32 and uint8");
        return std::is_same_v<T, double>         ? TensorType::f64
               : std::is_same_v<T, float>        ? TensorType::f32
               : std::is_same_v<T, std::int64_t> ? TensorType::i64
               : std::is_same_v<T, std::int32_t> ? TensorType::i32
                                                 : TensorType::u8;
    }

    /// Calls f with a value of the type that stands for `type` in memory.
    template <class Function>
    static void with_stored_type(TensorType type, const Function& f) {
        switch (type) {
            case TensorType::f64:
                return f(double());
            case TensorType::f32:
                return f(float());
            case TensorType::f16:
                return f(Half());
            case TensorType::bf16:
                return f(BFloat16());
            case TensorType::i64:
                return f(std::int64_t());
            case TensorType::i32:
                return f(std::int32_t());
            case TensorType::u8:
                return f(std::uint8_t());
        }
    }

    static std::string shape_text(const std::vector<Index>& shape) {
        std::string text = "(";
        for (std::size_t d = 0; d < shape.size(); ++d) {
            text += (d > 0 ? ", " : "") + (shape[d] == any ? std::string("any") : std::to_string(shape[d]));
        }
        return text + (shape.size() == 1 ? ",)" : ")");
    }

    /// Files are little-endian.
    template <class T>
    static void store(T value, unsigned char* to) {
        std::memcpy(to, &value, sizeof(T));
        if constexpr (std::endian::native == std::endian::big) {
            std::reverse(to, to + sizeof(T));
        }
    }

    template <class T>
    static T load(const unsigned char* from) {
        std::array<unsigned char, sizeof(T)> bytes;
        std::memcpy(bytes.data(), from, sizeof(T));
        if constexpr (std::endian::native == std::endian::big) {
            std::reverse(bytes.begin(), bytes.end());
        }
        return std::bit_cast<T>(bytes);
    }

    template <class To, class From>
    static To convert(From from, const std::string& source, std::size_t i) {
        if constexpr (std::is_same_v<To, From>) {
            return from;
        } else if constexpr (is_float16<From>) {
            return convert<To>(from.value(), source, i);
        } else if constexpr (is_float16<To>) {
            const auto value = static_cast<double>(from);
            const To to = To::nearest(value);
            require(!std::isfinite(value) || std::isfinite(to.value()), source, ": element ", i, " is ", value,
                    ", too large for its 16 bits");
            return to;
        } else if constexpr (std::is_floating_point_v<To>) {
            const To to = static_cast<To>(from);
            if constexpr (std::is_floating_point_v<From>) {
                require(std::isfinite(to) || !std::isfinite(from), source, ": element ", i, " is ", from,
                        ", too large for its ", 8 * sizeof(To), " bits");
            }
            return to;
        } else {
            bool fits = false;
            if constexpr (std::is_floating_point_v<From>) {
                const From bound = std::ldexp(From(1), std::numeric_limits<To>::digits);  // one past the largest
                fits = from < bound && from >= (std::is_signed_v<To> ? -bound : From(0)) && from == std::trunc(from);
            } else {
                fits = std::in_range<To>(from);
            }
            require(fits, source, ": element ", i, " is ", +from, ", expected a whole number from ",
                    +std::numeric_limits<To>::min(), " to ", +std::numeric_limits<To>::max());
            return static_cast<To>(from);
        }
    }

    std::string source_;
    TensorType type_;
    std::vector<Index> shape_;
    Index num_elements_ = 0;
    std::vector<unsigned char> bytes_;
};

}  // namespace softtissue
