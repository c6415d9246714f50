// SPDX-License-Identifier: MIT
#include <softtissue/io/npy_header.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

NpyHeader parse(const std::string& image) {
    return parse_npy_header("a.npz: array 'x'", as_bytes(image));
}

std::string refused(const std::string& image) {
    return refusal([&] { static_cast<void>(parse(image)); });
}

std::string dictionary(const std::string& descr, const std::string& shape) {
    return "{'descr': '" + descr + "', 'fortran_order': False, 'shape': " + shape + ", }";
}

}  // namespace

TEST_CASE("the dictionary numpy writes is read") {
    const NpyHeader header = parse(npy_image(dictionary("<f8", "(2, 3)"), std::string(48, '\0')));
    CHECK(header.type == NpyType{'f', 8, false});
    CHECK(!header.fortran_order);
    CHECK(header.shape == std::vector<Index>{2, 3});
    CHECK(header.unsupported.empty());
    CHECK(parse(npy_image(dictionary(">i4", "(1,)"), "abcd")).type == NpyType{'i', 4, true});
    CHECK(parse(npy_image(dictionary("|b1", "()"), "a")).shape.empty());
    CHECK(parse(npy_image(dictionary("<U7", "()"), std::string(28, '\0'))).type == NpyType{'U', 28, false});
    CHECK(parse(npy_image(dictionary("|u1", "(2L, 0L)"), "")).shape == std::vector<Index>{2, 0});
    const std::string other_order = "{\"shape\":(4,),\"fortran_order\":True,\"descr\":\"|S2\"}";
    CHECK(parse(npy_image(other_order, "abababab")).fortran_order);
}

TEST_CASE("versions 2 and 3 have a length of four bytes") {
    for (const char version : {'\x02', '\x03'}) {
        std::string image = npy_image(dictionary("<i2", "(2,)"), "abcd");
        image[6] = version;
        image.insert(10, 2, '\0');
        CHECK(parse(image).data_offset == image.size() - 4);
    }
    std::string image = npy_image(dictionary("<i2", "(2,)"), "abcd");
    image[6] = '\x04';
    CHECK(contains(refused(image), "a.npz: array 'x': npy format version 4, expected 1, 2 or 3"));
}

TEST_CASE("what is written is read again, data aligned") {
    for (const std::vector<Index>& shape : {std::vector<Index>{}, {5}, {2, 3}, {1, 0, 4, 2}}) {
        const NpyHeader header{{'f', 4, false}, true, shape, 0, {}};
        std::string image = make_npy_header(header);
        CHECK(image.size() % 64 == 0);
        image.append(4 * std::size_t(count_npy_elements("x", shape)), '\0');
        const NpyHeader read = parse(image);
        CHECK(read.type == header.type);
        CHECK(read.shape == shape);
        CHECK(read.fortran_order);
        CHECK(read.data_offset % 64 == 0);
    }
}

TEST_CASE("element types without plain values are described, not refused") {
    CHECK(contains(parse(npy_image(dictionary("|O", "(3,)"), "pickle")).unsupported, "pickled Python objects"));
    const std::string records = "{'descr': [('a', '<f4'), ('b', '<i4', (2,))], 'fortran_order': False, 'shape': (1,)}";
    CHECK(contains(parse(npy_image(records, std::string(12, '\0'))).unsupported, "records"));
    for (const char* type : {"<f2", "<c8", "<M8[ns]", "|V4", "<i3", "<f16", "x", "", "<U0", "<U99999999999999999999"}) {
        CAPTURE(type);
        CHECK(contains(parse(npy_image(dictionary(type, "()"), "ab")).unsupported, type));
    }
}

TEST_CASE("a header cut off anywhere is refused by name") {
    const std::string image = npy_image(dictionary("<f8", "(2, 3)"), std::string(48, '\0'));
    for (std::size_t size = 0; size < image.size(); ++size) {
        CAPTURE(size);
        CHECK(refused(image.substr(0, size)).starts_with("a.npz: array 'x'"));
    }
    CHECK(contains(refused("PK........"), "not a .npy array"));
}

TEST_CASE("malformed dictionaries are refused") {
    const std::string data(48, '\0');
    for (const char* text :
         {"", "{", "{}", "'descr'", "{'descr': '<f8', 'fortran_order': False}", "{'descr': '<f8', 'shape': (6,)}",
          "{'descr': '<f8', 'fortran_order': Maybe, 'shape': (6,)}",
          "{'descr': '<f8', 'fortran_order': False, 'shape': 6}",
          "{'descr': '<f8', 'fortran_order': False, 'shape': (-6,)}",
          "{'descr': '<f8', 'fortran_order': False, 'shape': (6",
          "{'descr': '<f8', 'fortran_order': False, 'shape': (6,)} x",
          "{'descr': '<f8, 'fortran_order': False, 'shape': (6,)}",
          "{'descr': '<f8', 'descr': '<f8', 'fortran_order': False, 'shape': (6,)}",
          "{'descr': '<f8', 'fortran_order': False, 'shape': (6,), 'more': 1}", "{'descr': [[[", "{'descr': 8}",
          "{'descr': '<f8' 'fortran_order': False, 'shape': (6,)}"}) {
        CAPTURE(text);
        CHECK(refused(npy_image(text, data)).starts_with("a.npz: array 'x'"));
    }
}

TEST_CASE("the shape must be that of the data, however large it claims to be") {
    CHECK(contains(refused(npy_image(dictionary("<f8", "(7,)"), std::string(48, '\0'))),
                   "has 48 bytes of data, expected 7 elements of 8 bytes"));
    CHECK(contains(refused(npy_image(dictionary("<f8", "(5,)"), std::string(48, '\0'))), "has 48 bytes of data"));
    CHECK(contains(refused(npy_image(dictionary("<f8", "(4294967296, 4294967296)"), "")), "shape is too large"));
    CHECK(contains(refused(npy_image(dictionary("<f8", "(99999999999999999999,)"), "")), "shape is too large"));
    // 2^61 elements of 8 bytes are 2^64 bytes, which wraps to 0.
    CHECK(contains(refused(npy_image(dictionary("<f8", "(2305843009213693952,)"), "")), "has 0 bytes of data"));
    std::string ones;
    for (int dimension = 0; dimension < 65; ++dimension) {
        ones += "1,";
    }
    CHECK(contains(refused(npy_image(dictionary("<f8", "(" + ones + ")"), std::string(8, '\0'))), "has 65 dimensions"));
}
