// SPDX-License-Identifier: MIT
/// @file
/// One numpy array in memory: any shape, any plain element type, read through typed accessors.
///
/// What        holds the image of a .npy file (nothing is copied on reading); converts on access, in C order.
/// Shapes      columns<S, k>() of an (n, k) array is k x n, so an (n, 3) array becomes positions 3 x n;
///             matrix<S>() of an (r, c) array is r x c, of an (n) array n x 1.
/// Refuses     a conversion that loses an integer (2.5 or 4294967295 as int32), an array of another shape than asked
///             for, an element type that holds no numbers (InvalidInput names file, array, element and expectation).
/// Tests       tests/unit/io/npy_array_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/io/npy_header.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace softtissue {

class NpyArray {
public:
    /// Stands for "any extent" in require_shape().
    static constexpr Index any = -1;

    NpyArray() : NpyArray(from_values(std::span<const double>(), {0})) {}

    /// From the bytes of a .npy file; `source` (file and array) starts every message about this array.
    NpyArray(std::string source, std::vector<unsigned char> file)
        : source_(std::move(source)), file_(std::move(file)), header_(parse_npy_header(source_, file_)) {}

    /// `values` in C order.
    template <class T>
        requires std::is_arithmetic_v<T>
    static NpyArray from_values(std::span<const T> values, std::vector<Index> shape) {
        constexpr char kind = std::is_same_v<T, bool>       ? 'b'
                              : std::is_floating_point_v<T> ? 'f'
                              : std::is_signed_v<T>         ? 'i'
                                                            : 'u';
        return from_elements({kind, sizeof(T), false}, std::move(shape), values.data(), values.size());
    }

    template <class T>
    static NpyArray from_scalar(T value) {
        return from_values(std::span<const T>(&value, 1), {});
    }

    /// A k x n matrix as an (n, k) array: positions 3 x n as (n, 3).
    template <class Derived>
    static NpyArray from_columns(const Eigen::MatrixBase<Derived>& columns) {
        using T = typename Derived::Scalar;
        const Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic> stored = columns;
        return from_values(std::span<const T>(stored.data(), std::size_t(stored.size())),
                           {stored.cols(), stored.rows()});
    }

    /// An r x c matrix as an (r, c) array.
    template <class Derived>
    static NpyArray from_matrix(const Eigen::MatrixBase<Derived>& matrix) {
        return from_columns(matrix.transpose());
    }

    /// ASCII texts as an array of unicode strings.
    static NpyArray from_strings(const std::vector<std::string>& texts, std::vector<Index> shape) {
        std::size_t width = 1;
        for (const std::string& text : texts) {
            width = std::max(width, text.size());
        }
        std::vector<char32_t> characters(width * texts.size(), U'\0');
        for (std::size_t i = 0; i < texts.size(); ++i) {
            std::copy(texts[i].begin(), texts[i].end(), characters.begin() + std::ptrdiff_t(i * width));
        }
        return from_elements({'U', 4 * width, false}, std::move(shape), characters.data(), texts.size());
    }

    const std::string& source() const { return source_; }
    const std::vector<Index>& shape() const { return header_.shape; }
    NpyType type() const { return header_.type; }
    Index num_elements() const { return count_npy_elements(source_, header_.shape); }
    std::span<const unsigned char> file_bytes() const { return file_; }

    /// Throws unless the shape is `expected`, where `any` fits every extent, and there is an element for each place in it.
    void require_shape(const std::vector<Index>& expected) const {
        require_plain();
        bool fits = expected.size() == shape().size();
        for (std::size_t d = 0; fits && d < expected.size(); ++d) {
            fits = expected[d] == any || expected[d] == shape()[d];
        }
        require(fits, source_, ": shape is ", shape_text(shape()), ", expected ", shape_text(expected));
    }

    /// Calls f(i, value) for each element i in C order, converted to T.
    template <class T, class Function>
    void for_each(const Function& f) const {
        require_plain();
        switch (header_.type.kind) {
            case 'f':
                return header_.type.size == 4 ? for_each_of<float, T>(f) : for_each_of<double, T>(f);
            case 'i':
                return for_each_integer<T, std::int8_t, std::int16_t, std::int32_t, std::int64_t>(f);
            case 'u':
                return for_each_integer<T, std::uint8_t, std::uint16_t, std::uint32_t, std::uint64_t>(f);
            case 'b':
                return for_each_of<std::uint8_t, T>(f);
            default:
                throw_invalid_input(source_, ": holds text, expected numbers");
        }
    }

    /// All elements in C order.
    template <class T>
    std::vector<T> as() const {
        require_plain();
        std::vector<T> values(size());
        for_each<T>([&](Index i, T value) { values[std::size_t(i)] = value; });
        return values;
    }

    /// The only element of an array of one.
    template <class T>
    T scalar() const {
        require(num_elements() == 1, source_, ": shape is ", shape_text(shape()), ", expected one number");
        return as<T>().front();
    }

    template <class S>
    VectorX<S> vector() const {
        require_shape({any});
        VectorX<S> result(shape()[0]);
        for_each<S>([&](Index i, S value) { result(i) = value; });
        return result;
    }

    template <class S>
    MatrixX<S> matrix() const {
        require_shape(shape().size() == 1 ? std::vector<Index>{any} : std::vector<Index>{any, any});
        const Index columns = shape().size() == 1 ? 1 : shape()[1];
        MatrixX<S> result(shape()[0], columns);
        for_each<S>([&](Index i, S value) { result(i / columns, i % columns) = value; });
        return result;
    }

    /// An (n, k) array as k x n.
    template <class S, int k>
    Eigen::Matrix<S, k, Eigen::Dynamic> columns() const {
        require_shape({any, k});
        Eigen::Matrix<S, k, Eigen::Dynamic> result(k, shape()[0]);
        for_each<S>([&](Index i, S value) { result.data()[i] = value; });
        return result;
    }

    /// An (n, 3) array of positions as 3 x n.
    template <class S>
    Matrix3X<S> columns3() const {
        return columns<S, 3>();
    }

    /// An (n, rows, cols) array as n matrices.
    template <class S, int rows, int cols>
    std::vector<Eigen::Matrix<S, rows, cols>> matrices() const {
        require_shape({any, rows, cols});
        std::vector<Eigen::Matrix<S, rows, cols>> result(size() / std::size_t(rows * cols));
        for_each<S>(
            [&](Index i, S value) { result[std::size_t(i / (rows * cols))](i / cols % rows, i % cols) = value; });
        return result;
    }

    /// Text elements in C order; characters beyond ASCII become '?'.
    std::vector<std::string> strings() const {
        const NpyType type = header_.type;
        require(header_.unsupported.empty() && (type.kind == 'U' || type.kind == 'S'), source_, ": holds no text");
        const std::size_t width = type.kind == 'U' ? 4 : 1;
        std::vector<std::string> texts(size());
        for (std::size_t i = 0; i < texts.size(); ++i) {
            const unsigned char* const first = element(memory_index(Index(i)));
            for (std::size_t c = 0; c < type.size; c += width) {
                const std::uint32_t code = width == 1 ? first[c] : load<std::uint32_t>(first + c);
                if (code != 0) {
                    texts[i] += code < 128 ? static_cast<char>(code) : '?';
                }
            }
        }
        return texts;
    }

private:
    static NpyArray from_elements(NpyType type, std::vector<Index> shape, const void* data, std::size_t count) {
        const NpyHeader header{type, false, std::move(shape), 0, {}};
        const std::string text = make_npy_header(header);
        std::vector<unsigned char> file(text.size() + count * type.size);
        std::copy(text.begin(), text.end(), file.begin());
        if (count > 0) {
            std::memcpy(file.data() + text.size(), data, count * type.size);
        }
        return {"array", std::move(file)};
    }

    /// Before anything is allocated: the shape of elements that cannot be read is only a claim.
    void require_plain() const {
        require(header_.unsupported.empty(), source_, ": ", header_.unsupported, "; expected numbers of 1 to 8 bytes");
    }

    std::size_t size() const { return static_cast<std::size_t>(num_elements()); }

    static std::string shape_text(const std::vector<Index>& shape) {
        std::string text = "(";
        for (std::size_t d = 0; d < shape.size(); ++d) {
            text += (d > 0 ? ", " : "") + (shape[d] == any ? std::string("any") : std::to_string(shape[d]));
        }
        return text + (shape.size() == 1 ? ",)" : ")");
    }

    const unsigned char* element(Index memory_index) const {
        return file_.data() + header_.data_offset + std::size_t(memory_index) * header_.type.size;
    }

    /// Where the element with C-order index i lies.
    Index memory_index(Index i) const {
        if (!header_.fortran_order) {
            return i;
        }
        Index stride = 1;
        for (std::size_t d = 0; d + 1 < shape().size(); ++d) {
            stride *= shape()[d];
        }
        Index place = 0;
        for (std::size_t d = shape().size(); d-- > 0;) {
            place += i % shape()[d] * stride;
            i /= shape()[d];
            stride = d > 0 ? stride / shape()[d - 1] : stride;
        }
        return place;
    }

    template <class Stored>
    Stored load(const unsigned char* from) const {
        std::array<unsigned char, sizeof(Stored)> bytes;
        std::memcpy(bytes.data(), from, sizeof(Stored));
        if (header_.type.swapped) {
            std::reverse(bytes.begin(), bytes.end());
        }
        return std::bit_cast<Stored>(bytes);
    }

    template <class T, class I1, class I2, class I4, class I8, class Function>
    void for_each_integer(const Function& f) const {
        switch (header_.type.size) {
            case 1:
                return for_each_of<I1, T>(f);
            case 2:
                return for_each_of<I2, T>(f);
            case 4:
                return for_each_of<I4, T>(f);
            default:
                return for_each_of<I8, T>(f);
        }
    }

    template <class Stored, class T, class Function>
    void for_each_of(const Function& f) const {
        const Index count = num_elements();
        for (Index i = 0; i < count; ++i) {
            f(i, convert<T>(load<Stored>(element(memory_index(i))), i));
        }
    }

    template <class T, class Stored>
    T convert(Stored value, Index i) const {
        if constexpr (std::is_integral_v<T>) {
            bool fits = false;
            if constexpr (std::is_floating_point_v<Stored>) {
                const Stored bound = std::ldexp(Stored(1), std::numeric_limits<T>::digits);  // one past the largest T
                const bool in_range = value < bound && value >= (std::is_signed_v<T> ? -bound : Stored(0));
                fits = in_range && value == std::trunc(value);
            } else {
                fits = std::in_range<T>(value);
            }
            require(fits, source_, ": element ", i, " is ", +value, ", expected a whole number from ",
                    +std::numeric_limits<T>::min(), " to ", +std::numeric_limits<T>::max());
        }
        return static_cast<T>(value);
    }

    std::string source_;
    std::vector<unsigned char> file_;
    NpyHeader header_;
};

}  // namespace softtissue
