// SPDX-License-Identifier: MIT
#include <softtissue/io/npy_array.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

NpyArray array(const std::string& descr, bool fortran, const std::string& shape, const std::string& data) {
    return {"a.npz: array 'x'", as_bytes(npy_image("{'descr': '" + descr + "', 'fortran_order': " +
                                                       (fortran ? "True" : "False") + ", 'shape': " + shape + "}",
                                                   data))};
}

template <class T>
NpyArray vector_array(const std::vector<T>& values) {
    return NpyArray::from_values(std::span<const T>(values), {Index(values.size())});
}

}  // namespace

TEST_CASE_TEMPLATE("every number type survives", T, float, double, std::int8_t, std::int16_t, std::int32_t,
                   std::int64_t, std::uint8_t, std::uint16_t, std::uint32_t, std::uint64_t) {
    const std::vector<T> values{std::numeric_limits<T>::lowest(), T(0), T(1), std::numeric_limits<T>::max()};
    const NpyArray stored = vector_array(values);
    CHECK(stored.shape() == std::vector<Index>{4});
    CHECK(stored.template as<T>() == values);
    CHECK(stored.template as<double>()[2] == 1.0);
}

TEST_CASE("bytes are numpy's: both byte orders, booleans") {
    CHECK(array("<i2", false, "(2,)", std::string("\x01\x02\xFF\xFF", 4)).as<int>() == std::vector<int>{513, -1});
    CHECK(array(">i2", false, "(2,)", std::string("\x01\x02\xFF\xFE", 4)).as<int>() == std::vector<int>{258, -2});
    CHECK(array(">f8", false, "()", std::string("\x3F\xF8\0\0\0\0\0\0", 8)).scalar<double>() == 1.5);
    CHECK(array("<f4", false, "(1,)", std::string("\0\0\xC0\x3F", 4)).scalar<double>() == 1.5);
    CHECK(array("|b1", false, "(2,)", std::string("\x01\x00", 2)).as<int>() == std::vector<int>{1, 0});
}

TEST_CASE("Fortran order is undone") {
    // Element (i, j, k) of a (2, 3, 4) array holds 100 i + 10 j + k, first index fastest in memory.
    std::string data;
    for (int k = 0; k < 4; ++k) {
        for (int j = 0; j < 3; ++j) {
            for (int i = 0; i < 2; ++i) {
                data += char(100 * i + 10 * j + k);
            }
        }
    }
    const std::vector<int> values = array("|u1", true, "(2, 3, 4)", data).as<int>();
    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 3; ++j) {
            for (int k = 0; k < 4; ++k) {
                CHECK(values[std::size_t((i * 3 + j) * 4 + k)] == 100 * i + 10 * j + k);
            }
        }
    }
    const NpyArray matrix = array("|u1", true, "(2, 3)", "\x01\x02\x03\x04\x05\x06");
    CHECK(matrix.matrix<double>() == (MatrixX<double>(2, 3) << 1, 3, 5, 2, 4, 6).finished());
}

TEST_CASE_TEMPLATE("matrices keep their layout", S, float, double) {
    const MatrixX<S> m = (MatrixX<S>(2, 3) << 1, 2, 3, 4, 5, 6).finished();
    const NpyArray rows = NpyArray::from_matrix(m);
    CHECK(rows.shape() == std::vector<Index>{2, 3});
    CHECK(rows.as<int>() == std::vector<int>{1, 2, 3, 4, 5, 6});
    CHECK(rows.template matrix<S>() == m);
    const Matrix3X<S> points = rows.template columns3<S>();
    CHECK(points == m.transpose());
    CHECK(NpyArray::from_columns(points).template matrix<S>() == m);
    CHECK(vector_array(std::vector<S>{7, 8}).template matrix<S>() == (MatrixX<S>(2, 1) << 7, 8).finished());
    CHECK(vector_array(std::vector<S>{7, 8}).template vector<S>() == (VectorX<S>(2) << 7, 8).finished());

    const std::vector<S> twelve{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
    const NpyArray stack = NpyArray::from_values(std::span<const S>(twelve), {2, 3, 2});
    const std::vector<Eigen::Matrix<S, 3, 2>> matrices = stack.template matrices<S, 3, 2>();
    CHECK(matrices.size() == 2);
    CHECK(matrices[1] == (Eigen::Matrix<S, 3, 2>() << 6, 7, 8, 9, 10, 11).finished());
}

TEST_CASE("empty arrays are arrays") {
    CHECK(NpyArray().num_elements() == 0);
    CHECK(array("<f8", false, "(0, 3)", "").columns3<double>().cols() == 0);
    CHECK(array("<f8", true, "(3, 0)", "").matrix<double>().rows() == 3);
}

TEST_CASE("integers are never bent") {
    const auto refused = [](const auto& values, auto wanted) {
        return refusal([&] { static_cast<void>(vector_array(values).template as<decltype(wanted)>()); });
    };
    CHECK(refused(std::vector<std::uint32_t>{0, 4294967295U}, std::int32_t()) ==
          "array: element 1 is 4294967295, expected a whole number from -2147483648 to 2147483647");
    CHECK(contains(refused(std::vector<double>{1.0, 2.5}, int()), "element 1 is 2.5, expected a whole number"));
    CHECK(contains(refused(std::vector<float>{std::numeric_limits<float>::quiet_NaN()}, int()),
                   "expected a whole number"));
    CHECK(contains(refused(std::vector<double>{-std::numeric_limits<double>::infinity()}, std::int64_t()),
                   "expected a whole number"));
    CHECK(contains(refused(std::vector<double>{9223372036854775808.0}, std::int64_t()), "expected a whole number"));
    CHECK(contains(refused(std::vector<float>{2147483648.0F}, std::int32_t()), "expected a whole number"));
    CHECK(contains(refused(std::vector<int>{-1}, std::uint8_t()),
                   "element 0 is -1, expected a whole number from 0 to 255"));
    CHECK(contains(refused(std::vector<double>{-1.0}, std::uint64_t()), "expected a whole number"));
    CHECK(vector_array(std::vector<double>{-9223372036854775808.0}).as<std::int64_t>()[0] ==
          std::numeric_limits<std::int64_t>::min());
    CHECK(vector_array(std::vector<std::uint32_t>{4294967295U}).as<std::int64_t>()[0] == 4294967295);
}

TEST_CASE("another shape than asked for is refused with both shapes") {
    const NpyArray a = array("|u1", false, "(2, 3)", "abcdef");
    CHECK(refusal([&] { static_cast<void>(a.columns<int, 4>()); }) ==
          "a.npz: array 'x': shape is (2, 3), expected (any, 4)");
    CHECK(contains(refusal([&] { static_cast<void>(a.vector<double>()); }), "shape is (2, 3), expected (any,)"));
    CHECK(contains(refusal([&] { static_cast<void>(a.scalar<double>()); }), "shape is (2, 3), expected one number"));
    CHECK(contains(refusal([&] { static_cast<void>(a.matrices<double, 1, 3>()); }), "expected (any, 1, 3)"));
    CHECK(contains(refusal([&] { static_cast<void>(array("|u1", false, "(1, 1, 1)", "a").matrix<double>()); }),
                   "expected (any, any)"));
    CHECK_NOTHROW(a.require_shape({NpyArray::any, 3}));
}

TEST_CASE("text is read as text, and only as text") {
    const NpyArray names = NpyArray::from_strings({"pelvis", "l", ""}, {3});
    CHECK(names.strings() == std::vector<std::string>{"pelvis", "l", ""});
    CHECK(NpyArray::from_strings({"neutral"}, {}).strings() == std::vector<std::string>{"neutral"});
    CHECK(array(">U2", false, "()", std::string("\0\0\0a\0\0\0b", 8)).strings()[0] == "ab");
    CHECK(array("<U1", false, "()", std::string("\xE4\0\0\0", 4)).strings()[0] == "?");
    CHECK(array("|S3", false, "(2,)", std::string("ab\0xyz", 6)).strings() == std::vector<std::string>{"ab", "xyz"});
    CHECK(contains(refusal([&] { static_cast<void>(names.as<double>()); }), "holds text, expected numbers"));
    CHECK(contains(refusal([&] { static_cast<void>(array("|u1", false, "()", "a").strings()); }), "holds no text"));
}

TEST_CASE("pickled objects are refused with a sentence") {
    const NpyArray pickled = array("|O", false, "()", "\x80\x04K\x01.");
    CHECK(
        refusal([&] { static_cast<void>(pickled.as<double>()); }) ==
        "a.npz: array 'x': it holds pickled Python objects, which are programs rather than data; expected numbers of 1 "
        "to 8 bytes");
    CHECK(contains(refusal([&] { static_cast<void>(array("<f2", false, "()", "ab").as<float>()); }),
                   "its element type is '<f2'"));
}

TEST_CASE("elements that cannot be read take no memory, whatever their shape claims") {
    const NpyArray objects = array("|O", false, "(1099511627776, 3)", "");
    for (const std::string& refused : {refusal([&] { static_cast<void>(objects.as<double>()); }), refusal([&] {
                                           objects.require_shape({NpyArray::any, 3});
                                       }),
                                       refusal([&] { static_cast<void>(objects.matrix<double>()); }),
                                       refusal([&] { static_cast<void>(objects.columns3<float>()); })}) {
        CHECK(contains(refused, "it holds pickled Python objects"));
    }
}
