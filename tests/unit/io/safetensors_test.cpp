// SPDX-License-Identifier: MIT
#include <softtissue/io/safetensors.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

/// A file with this header and these bytes of elements, built without the library.
std::string image(const std::string& header, const std::string& data) {
    std::string file;
    for (int i = 0; i < 8; ++i) {
        file += static_cast<char>(std::uint64_t(header.size()) >> (8 * i) & 0xFF);
    }
    return file + header + data;
}

SafetensorsFile read(const std::string& bytes) {
    const TemporaryFolder folder;
    write_bytes(folder / "a.safetensors", bytes);
    return read_safetensors(folder / "a.safetensors");
}

/// The refusal of a file, which must begin with its name.
std::string refused(const std::string& bytes) {
    const std::string text = refusal([&] { static_cast<void>(read(bytes)); });
    CHECK((text.empty() || contains(text, "a.safetensors: ")));
    return text;
}

/// The refusal of a file of one tensor x whose entry is `entry`.
std::string refused_entry(const std::string& entry, const std::string& data) {
    return refused(image("{\"x\":" + entry + "}", data));
}

const std::string floats = bytes_of(std::vector<float>{1.0F, -2.5F});
const std::string entry = R"({"dtype":"F32","shape":[2],"data_offsets":[0,8]})";

NamedTensors sample_tensors() {
    NamedTensors tensors;
    tensors.emplace_back(
        "z.flags", StoredTensor::from_values(std::span<const std::uint8_t>(std::vector<std::uint8_t>{1, 2, 3}), {3}));
    tensors.emplace_back("b.weight", StoredTensor::from_matrix((MatrixX<float>(2, 3) << 1, 2, 3, 4, 5, 6).finished()));
    tensors.emplace_back("a.bias", StoredTensor::from_vector(VectorX<double>::LinSpaced(4, 0.0, 1.0)));
    tensors.emplace_back(
        "step", StoredTensor::from_values(std::span<const std::int64_t>(std::vector<std::int64_t>{1234567890123}), {}));
    tensors.emplace_back("none", StoredTensor::from_vector(VectorX<float>(0)));
    return tensors;
}

}  // namespace

TEST_CASE("a file is read in the order of its header, whatever the order of the data") {
    const SafetensorsFile file = read(
        image(R"({"b":{"shape":[2],"dtype":"F32","data_offsets":[4,12]},)"
              R"("__metadata__":{"format":"pt","by":"hand"},"a":{"dtype":"I32","shape":[],"data_offsets":[0,4]}}   )",
              bytes_of(std::vector<std::int32_t>{-7}) + floats));
    CHECK(file.tensors().size() == 2);
    CHECK(file.tensors()[0].first == "b");
    CHECK(file.at("b").vector<double>() == Eigen::Vector2d(1.0, -2.5));
    CHECK(file.at("a").scalar<int>() == -7);
    CHECK(file.metadata() == TensorMetadata{{"by", "hand"}, {"format", "pt"}});
    CHECK(file.metadata_at("format") == "pt");
    CHECK(file.contains("a"));
    CHECK(!file.contains("c"));
    CHECK(contains(refusal([&] { static_cast<void>(file.at("c")); }), "a.safetensors: tensor 'c' is missing"));
    CHECK(contains(refusal([&] { static_cast<void>(file.metadata_at("x")); }), "metadata 'x' is missing"));
}

TEST_CASE("every element type is read") {
    const auto first = [](const std::string& type, const std::string& bytes) {
        return read(image("{\"x\":{\"dtype\":\"" + type + "\",\"shape\":[1],\"data_offsets\":[0," +
                              std::to_string(bytes.size()) + "]}}",
                          bytes))
            .at("x")
            .scalar<double>();
    };
    CHECK(first("F64", bytes_of(std::vector<double>{0.1})) == 0.1);
    CHECK(first("F32", bytes_of(std::vector<float>{0.5F})) == 0.5);
    CHECK(first("F16", std::string("\x00\xC0", 2)) == -2.0);
    CHECK(first("BF16", std::string("\xC0\x3F", 2)) == 1.5);
    CHECK(first("I64", bytes_of(std::vector<std::int64_t>{-5})) == -5.0);
    CHECK(first("I32", bytes_of(std::vector<std::int32_t>{6})) == 6.0);
    CHECK(first("U8", "\xFF") == 255.0);
}

TEST_CASE("a file without tensors is read") {
    CHECK(read(image("{}", "")).tensors().empty());
    CHECK(read(image(R"({"__metadata__":{}})", "")).metadata().empty());
}

TEST_CASE("what is written is read again, in the same order and to the bit") {
    const TemporaryFolder folder;
    const NamedTensors tensors = sample_tensors();
    const TensorMetadata metadata{{"kind", "test"}, {"quoted \"name\"", "line\nbreak, \xC3\xA4"}};
    write_safetensors(folder / "a.safetensors", tensors, metadata);
    CHECK(folder.num_files() == 1);
    const SafetensorsFile file = read_safetensors(folder / "a.safetensors");
    CHECK(file.metadata() == metadata);
    REQUIRE(file.tensors().size() == tensors.size());
    for (std::size_t i = 0; i < tensors.size(); ++i) {
        CHECK(file.tensors()[i].first == tensors[i].first);
        const StoredTensor& written = tensors[i].second;
        const StoredTensor& again = file.tensors()[i].second;
        CHECK(again.type() == written.type());
        CHECK(again.shape() == written.shape());
        CHECK(std::equal(again.bytes().begin(), again.bytes().end(), written.bytes().begin(), written.bytes().end()));
    }
    write_safetensors(folder / "b.safetensors", tensors, metadata);
    CHECK(read_bytes(folder / "a.safetensors") == read_bytes(folder / "b.safetensors"));
}

TEST_CASE("elements are aligned to their size") {
    const TemporaryFolder folder;
    write_safetensors(folder / "a.safetensors", sample_tensors());
    const std::string bytes = read_bytes(folder / "a.safetensors");
    const std::size_t header = static_cast<unsigned char>(bytes[0]) + 256U * static_cast<unsigned char>(bytes[1]);
    CHECK(header % 8 == 0);
    CHECK(bytes.substr(8 + header, 8) == bytes_of(std::vector<double>{0.0}));  // a.bias, the first of the widest
    CHECK(bytes.substr(bytes.size() - 3) == "\x01\x02\x03");                   // z.flags, the narrowest
}

TEST_CASE("names that cannot be written are refused, and nothing remains") {
    const TemporaryFolder folder;
    const StoredTensor x = StoredTensor::from_vector(VectorX<float>::Zero(1));
    const auto refused_writing = [&](const NamedTensors& tensors, const TensorMetadata& metadata = {}) {
        return refusal([&] { write_safetensors(folder / "a.safetensors", tensors, metadata); });
    };
    CHECK(contains(refused_writing({{"x", x}, {"x", x}}), "tensor 'x' cannot be written, expected each name once"));
    CHECK(contains(refused_writing({{"__metadata__", x}}), "tensor '__metadata__' cannot be written"));
    CHECK(contains(refused_writing({{"\xFF", x}}), "must be UTF-8"));
    CHECK(contains(refused_writing({}, {{"k", "\xFF"}}), "must be UTF-8"));
    CHECK(folder.num_files() == 0);
    CHECK(contains(refusal([&] { write_safetensors(folder / "none/a.safetensors", {}); }), "cannot write"));
}

TEST_CASE("what is no such file is refused by name") {
    const TemporaryFolder folder;
    CHECK(contains(refusal([&] { static_cast<void>(read_safetensors(folder / "none.safetensors")); }),
                   "none.safetensors: is no file"));
    CHECK(contains(refusal([&] { static_cast<void>(read_safetensors(folder.path())); }), "is no file"));
    CHECK(contains(refused(""), "0 bytes, no .safetensors file"));
    CHECK(contains(refused("PK\x03\x04 and more text"), "more than a file of 18 bytes can hold"));
    CHECK(contains(refused(std::string(8, '\0')), "header is no JSON"));
}

TEST_CASE("a file cut off anywhere is refused") {
    const TemporaryFolder folder;
    write_safetensors(folder / "whole.safetensors", sample_tensors(), {{"kind", "test"}});
    const std::string whole = read_bytes(folder / "whole.safetensors");
    for (std::size_t size = 0; size < whole.size(); ++size) {
        CAPTURE(size);
        CHECK(!refused(whole.substr(0, size)).empty());
    }
    CHECK(contains(refused(whole + '\0'), "1 bytes after the last tensor, expected none"));
}

TEST_CASE("a damaged byte never does more than change what is read, or it is refused") {
    const std::string whole = image("{\"x\":" + entry + "}", floats);
    for (std::size_t place = 0; place < whole.size(); ++place) {
        for (const int flip : {0x01, 0x10, 0x80, 0xFF}) {
            std::string bytes = whole;
            bytes[place] = static_cast<char>(bytes[place] ^ flip);
            static_cast<void>(
                refused(bytes));  // any outcome but a crash, a foreign exception or a message without the file
        }
    }
}

TEST_CASE("lengths that the file does not have are refused before memory is taken") {
    std::string bytes = image("{\"x\":" + entry + "}", floats);
    bytes.replace(0, 8, std::string("\xFF\xFF\xFF\xFF\xFF\xFF\xFF\x7F", 8));
    CHECK(contains(refused(bytes), "claims a header of 9223372036854775807 bytes"));
    bytes.replace(0, 8, std::string(8, '\xFF'));
    CHECK(contains(refused(bytes), "claims a header of 18446744073709551615 bytes"));
    CHECK(contains(refused_entry(R"({"dtype":"F32","shape":[1000000000000],"data_offsets":[0,4000000000000]})", floats),
                   "tensor 'x': lies at 0 to 4000000000000, expected a range among the 8 bytes that the file holds"));
    CHECK(contains(refused_entry(R"({"dtype":"F32","shape":[4294967296,4294967296,4],"data_offsets":[0,8]})", floats),
                   "tensor 'x': shape is too large"));
    CHECK(contains(refused_entry(R"({"dtype":"F32","shape":[4611686018427387906],"data_offsets":[0,8]})", floats),
                   "tensor 'x': occupies 8 bytes, expected those of 4611686018427387906 elements of 4 bytes"));
}

TEST_CASE("malformed headers are refused") {
    CHECK(contains(refused(image("{\"x\":", "")), "header is no JSON"));
    CHECK(contains(refused(image("[]", "")), "header is no JSON object"));
    CHECK(contains(refused(image("{} {}", "")), "header is no JSON"));
    CHECK(contains(refused(image(std::string("{\"\xFF\":1}"), "")), "header is no JSON"));
    CHECK(contains(refused(image("{\"x\":" + std::string(100000, '['), "")), "nested too deeply"));
    CHECK(contains(refused(image("{\"x\":" + entry + ",\"x\":" + entry + "}", floats)),
                   "'x' appears twice in the header"));
    CHECK(contains(refused_entry(R"({"dtype":"F32","dtype":"I32","shape":[2],"data_offsets":[0,8]})", floats),
                   "'dtype' appears twice"));
    CHECK(contains(refused(image(R"({"__metadata__":{"a":"1","a":"2"}})", "")), "'a' appears twice"));
    CHECK(contains(refused(image(R"({"__metadata__":{"a":1}})", "")), "metadata 'a' is 1, expected text"));
    CHECK(contains(refused(image(R"({"__metadata__":[]})", "")), "__metadata__ is no JSON object"));
    CHECK(contains(refused_entry("3", ""), "tensor 'x': its entry is malformed"));
    CHECK(contains(refused_entry(R"({"dtype":"F32","shape":[2]})", floats), "expected dtype, shape and data_offsets"));
    CHECK(contains(refused_entry(R"({"dtype":"F32","shape":[2],"data_offsets":[0,8],"more":1})", floats), "malformed"));
}

TEST_CASE("entries that make no sense are refused") {
    CHECK(contains(refused_entry(R"({"dtype":"F8","shape":[2],"data_offsets":[0,8]})", floats),
                   "tensor 'x': element type is \"F8\", expected F64, F32, F16, BF16, I64, I32 or U8"));
    CHECK(contains(refused_entry(R"({"dtype":32,"shape":[2],"data_offsets":[0,8]})", floats), "element type is 32"));
    for (const char* shape : {"[-2]", "[2.0]", "[\"2\"]", "[1e400]", "[18446744073709551615]", "[null]", "[true]"}) {
        CAPTURE(shape);
        CHECK(contains(
            refused_entry(std::string(R"({"dtype":"F32","shape":)") + shape + R"(,"data_offsets":[0,8]})", floats),
            "a.safetensors: "));
    }
    CHECK(contains(refused_entry(R"({"dtype":"F32","shape":2,"data_offsets":[0,8]})", floats),
                   "shape is 2, expected a list"));
    CHECK(contains(refused_entry(R"({"dtype":"F32","shape":{},"data_offsets":[0,8]})", floats), "expected a list"));
    CHECK(contains(refused_entry(R"({"dtype":"F32","shape":{"a":2},"data_offsets":[0,8]})", floats),
                   "tensor 'x': shape"));
    CHECK(contains(refused_entry(R"({"dtype":"F32","shape":[2],"data_offsets":[8]})", floats), "1 data_offsets"));
    CHECK(contains(refused_entry(R"({"dtype":"F32","shape":[2],"data_offsets":[8,0]})", floats), "lies at 8 to 0"));
    CHECK(contains(refused_entry(R"({"dtype":"F32","shape":[2],"data_offsets":[0,16]})", floats), "lies at 0 to 16"));
    CHECK(contains(refused_entry(R"({"dtype":"F32","shape":[3],"data_offsets":[0,8]})", floats),
                   "occupies 8 bytes, expected those of 3 elements of 4 bytes"));
    CHECK(contains(refused_entry(R"({"dtype":"F32","shape":[1],"data_offsets":[0,5]})", floats), "occupies 5 bytes"));
}

TEST_CASE("elements that overlap, leave gaps or are left over are refused") {
    const auto two = [](const std::string& a, const std::string& b, const std::string& data) {
        return refused(image(R"({"a":{"dtype":"F32","shape":[1],"data_offsets":)" + a +
                                 R"(},"b":{"dtype":"F32","shape":[1],"data_offsets":)" + b + "}}",
                             data));
    };
    CHECK(two("[0,4]", "[4,8]", floats).empty());
    CHECK(two("[4,8]", "[0,4]", floats).empty());
    CHECK(contains(two("[0,4]", "[0,4]", floats), "tensor 'b' begins at 0, expected 4 (it overlaps another)"));
    CHECK(contains(two("[0,4]", "[2,6]", floats), "tensor 'b' begins at 2, expected 4 (it overlaps another)"));
    CHECK(contains(two("[0,4]", "[8,12]", floats + "1234"), "tensor 'b' begins at 8, expected 4 (a gap)"));
    CHECK(contains(two("[0,4]", "[4,8]", floats + "1234"), "4 bytes after the last tensor"));
}

TEST_CASE("weights exported from PyTorch are read and written again") {
    for (const char* name : {"o5_mlp_f32", "o5_mlp_f64", "o5_train_final"}) {
        const std::filesystem::path path =
            std::filesystem::path(SOFTTISSUE_SHARED_DIR) / "reference" / (std::string(name) + ".safetensors");
        if (!std::filesystem::exists(path)) {
            MESSAGE("skipped: " << path.string() << " is not there");
            continue;
        }
        const SafetensorsFile file = read_safetensors(path);
        CHECK(file.metadata_at("format") == "pt");
        CHECK(file.tensors().front().first == "net.0.weight");
        CHECK(file.at("net.0.weight").shape() == std::vector<Index>{64, 30});
        CHECK(file.at("net.0.weight").matrix<double>().allFinite());
        CHECK(file.at("net.0.weight").type() == (contains(name, "f32") ? TensorType::f32 : TensorType::f64));
        const TemporaryFolder folder;
        write_safetensors(folder / "again.safetensors", file.tensors(), file.metadata());
        CHECK(read_bytes(folder / "again.safetensors") == read_bytes(path));
    }
}
