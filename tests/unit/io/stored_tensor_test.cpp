// SPDX-License-Identifier: MIT
#include <softtissue/io/stored_tensor.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

template <class T>
StoredTensor tensor_of(const std::vector<T>& values, TensorType type) {
    return StoredTensor::from_values(std::span<const T>(values), {Index(values.size())}, type);
}

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("elements are little-endian and in C order") {
    const MatrixX<float> m = (MatrixX<float>(2, 3) << 1, 2, 3, 4, 5, 6).finished();
    const StoredTensor tensor = StoredTensor::from_matrix(m);
    CHECK(tensor.type() == TensorType::f32);
    CHECK(tensor.shape() == std::vector<Index>{2, 3});
    CHECK(tensor.values<float>() == std::vector<float>{1, 2, 3, 4, 5, 6});
    CHECK(tensor.bytes().size() == 24);
    CHECK(tensor.bytes()[6] == 0x00);
    CHECK(tensor.bytes()[7] == 0x40);  // 2 = 0x40000000
    CHECK(tensor.matrix<double>() == m.cast<double>());
}

TEST_CASE_TEMPLATE("what is stored in its own type comes back to the bit, NaN included", T, double, float) {
    const std::vector<T> values{T(1) / T(3), T(-0.0), std::numeric_limits<T>::denorm_min(), T(infinity),
                                T(not_a_number)};
    const StoredTensor tensor = StoredTensor::from_values(std::span<const T>(values), {5});
    CHECK(tensor.num_elements() == 5);
    CHECK(bytes_of(tensor.values<T>()) == bytes_of(values));
    const VectorX<T> vector = tensor.vector<T>();
    CHECK(bytes_of(std::vector<T>(vector.begin(), vector.end())) == bytes_of(values));
}

TEST_CASE_TEMPLATE("integers keep every bit", T, std::int64_t, std::int32_t, std::uint8_t) {
    const std::vector<T> values{std::numeric_limits<T>::min(), T(7), std::numeric_limits<T>::max()};
    const StoredTensor tensor = StoredTensor::from_values(std::span<const T>(values), {3});
    CHECK(tensor.values<T>() == values);
}

TEST_CASE("16 bits hold what they can, read in any type") {
    const std::vector<double> values{1.0, -2.5, 1.0 / 3.0, 65504.0};
    CHECK(tensor_of(values, TensorType::f16).values<double>() ==
          std::vector<double>{1.0, -2.5, 0.333251953125, 65504.0});
    CHECK(tensor_of(values, TensorType::bf16).values<float>() ==
          std::vector<float>{1.0F, -2.5F, 0.333984375F, 65536.0F});
    CHECK(tensor_of(values, TensorType::f16).bytes().size() == 8);
    CHECK(std::isnan(tensor_of(std::vector<double>{not_a_number}, TensorType::f16).scalar<float>()));
    CHECK(tensor_of(std::vector<double>{-infinity}, TensorType::bf16).scalar<double>() == -infinity);
}

TEST_CASE("what a type cannot hold is refused with its element") {
    const auto refused = [](const std::vector<double>& values, TensorType type) {
        return refusal([&] { static_cast<void>(tensor_of(values, type)); });
    };
    CHECK(refused({0, 1e39}, TensorType::f32) == "tensor: element 1 is 1e+39, too large for its 32 bits");
    CHECK(refused({7e4}, TensorType::f16) == "tensor: element 0 is 70000, too large for its 16 bits");
    CHECK(contains(refused({2.5}, TensorType::i32), "element 0 is 2.5, expected a whole number from -2147483648"));
    CHECK(contains(refused({256}, TensorType::u8), "element 0 is 256, expected a whole number from 0 to 255"));
    CHECK(contains(refused({not_a_number}, TensorType::i64), "expected a whole number"));
    CHECK(contains(refused({0x1p63}, TensorType::i64), "expected a whole number"));
    const StoredTensor large("f: tensor 'x'", TensorType::f64, {1}, as_bytes(bytes_of(std::vector<double>{1e300})));
    CHECK(refusal([&] { static_cast<void>(large.vector<float>()); }) ==
          "f: tensor 'x': element 0 is 1e+300, too large for its 32 bits");
}

TEST_CASE("other shapes than asked for are refused") {
    const StoredTensor tensor("f: tensor 'x'", TensorType::u8, {2, 3}, std::vector<unsigned char>(6));
    CHECK(refusal([&] { static_cast<void>(tensor.vector<float>()); }) ==
          "f: tensor 'x': shape is (2, 3), expected (any,)");
    CHECK(refusal([&] { tensor.require_shape({2, 4}); }) == "f: tensor 'x': shape is (2, 3), expected (2, 4)");
    CHECK_NOTHROW(tensor.require_shape({StoredTensor::any, 3}));
    CHECK(contains(refusal([&] { static_cast<void>(tensor.scalar<float>()); }), "expected one number"));
    std::vector<float> five(5);
    CHECK(contains(refusal([&] { tensor.copy_into(std::span<float>(five)); }), "has 6 elements, expected 5"));
}

TEST_CASE("bytes that are not those of the shape are refused") {
    const auto refused = [](std::vector<Index> shape, std::size_t bytes) {
        return refusal([&] { StoredTensor("x", TensorType::f32, shape, std::vector<unsigned char>(bytes)); });
    };
    CHECK(refused({2}, 8).empty());
    CHECK(refused({}, 4).empty());
    CHECK(refused({0, 5}, 0).empty());
    CHECK(contains(refused({2}, 12), "x: 12 bytes, expected 2 elements of 4 bytes for the shape (2,)"));
    CHECK(contains(refused({2}, 9), "x: 9 bytes, expected"));
    CHECK(contains(refused({-1}, 4), "expected extents >= 0"));
    CHECK(contains(refused({Index(1) << 40, Index(1) << 40}, 4), "shape is too large"));
}
