// SPDX-License-Identifier: MIT
#include <softtissue/io/npz.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

NpyArrays sample_arrays() {
    std::vector<double> ramp(500);
    for (std::size_t i = 0; i < ramp.size(); ++i) {
        ramp[i] = double(i % 7);
    }
    NpyArrays arrays;
    arrays["ramp"] = NpyArray::from_values(std::span<const double>(ramp), {100, 5});
    arrays["count"] = NpyArray::from_scalar(std::int32_t(42));
    arrays["name"] = NpyArray::from_strings({"neutral"}, {});
    return arrays;
}

std::uint32_t crc32(const std::string& bytes) {
    std::uint32_t crc = 0xFFFFFFFFU;
    for (const char c : bytes) {
        crc ^= static_cast<unsigned char>(c);
        for (int k = 0; k < 8; ++k) {
            crc = crc % 2 == 1 ? (crc >> 1) ^ 0xEDB88320U : crc >> 1;
        }
    }
    return ~crc;
}

std::string little_endian(std::uint64_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) {
        text += static_cast<char>(value >> (8 * i) & 0xFF);
    }
    return text;
}

/// A stored archive as numpy writes it: sizes of a local header in its zip64 extension, 0xFFFFFFFF in the header itself.
std::string numpy_zip(const std::vector<std::pair<std::string, std::string>>& members) {
    std::string file;
    std::string directory;
    for (const auto& [name, content] : members) {
        const std::string common = std::string("\x2D\0\0\0\0\0\0\0\x21\0", 10) + little_endian(crc32(content), 4);
        const std::size_t offset = file.size();
        file += "PK\x03\x04" + common + little_endian(0xFFFFFFFFU, 4) + little_endian(0xFFFFFFFFU, 4) +
                little_endian(name.size(), 2) + little_endian(20, 2) + name + std::string("\x01\0\x10\0", 4) +
                little_endian(content.size(), 8) + little_endian(content.size(), 8) + content;
        directory += "PK\x01\x02" + std::string("\x2D\x03", 2) + common + little_endian(content.size(), 4) +
                     little_endian(content.size(), 4) + little_endian(name.size(), 2) + std::string(12, '\0') +
                     little_endian(offset, 4) + name;
    }
    return file + directory + std::string("PK\x05\x06\0\0\0\0", 8) + little_endian(members.size(), 2) +
           little_endian(members.size(), 2) + little_endian(directory.size(), 4) + little_endian(file.size(), 4) +
           std::string(2, '\0');
}

const std::string scalar_image =
    npy_image("{'descr': '<f4', 'fortran_order': False, 'shape': ()}", std::string("\0\0\xC0\x3F", 4));

std::string refused(const std::filesystem::path& path) {
    return refusal([&] { static_cast<void>(read_npz(path)); });
}

}  // namespace

TEST_CASE("what is written is read again, stored and deflated") {
    const TemporaryFolder folder;
    const NpyArrays arrays = sample_arrays();
    std::array<std::uintmax_t, 2> sizes{};
    for (const NpzCompression compression : {NpzCompression::stored, NpzCompression::deflated}) {
        write_npz(folder / "a.npz", arrays, compression);
        CHECK(folder.num_files() == 1);
        sizes[std::size_t(compression)] = std::filesystem::file_size(folder / "a.npz");
        const NpzFile file = read_npz(folder / "a.npz");
        CHECK(file.arrays().size() == 3);
        CHECK(file.at("count").scalar<int>() == 42);
        CHECK(file.at("name").strings()[0] == "neutral");
        CHECK(file.at("ramp").shape() == std::vector<Index>{100, 5});
        CHECK(file.at("ramp").as<double>() == arrays.at("ramp").as<double>());
    }
    CHECK(sizes[0] > 4000);
    CHECK(sizes[1] < 1500);
}

TEST_CASE("the same arrays give the same bytes") {
    const TemporaryFolder folder;
    write_npz(folder / "a.npz", sample_arrays());
    write_npz(folder / "b.npz", sample_arrays());
    CHECK(read_bytes(folder / "a.npz") == read_bytes(folder / "b.npz"));
}

TEST_CASE("numpy's archives with zip64 local headers are read, members that are no arrays skipped") {
    const TemporaryFolder folder;
    write_bytes(folder / "a.npz",
                numpy_zip({{"x.npy", scalar_image}, {"readme.txt", "hello"}, {"y.npy", scalar_image}}));
    const NpzFile file = read_npz(folder / "a.npz");
    CHECK(file.arrays().size() == 2);
    CHECK(file.at("y").scalar<double>() == 1.5);
}

TEST_CASE("a missing array is named, with those that are there") {
    const TemporaryFolder folder;
    write_npz(folder / "a.npz", sample_arrays());
    const NpzFile file = read_npz(folder / "a.npz");
    CHECK(file.contains("ramp"));
    CHECK(!file.contains("x"));
    CHECK(refusal([&] { static_cast<void>(file.at("x")); }) ==
          (folder / "a.npz").string() + ": array 'x' is missing; the file has count, name, ramp");
    CHECK(contains(refusal([&] { static_cast<void>(file.at("count").columns3<double>()); }),
                   "a.npz: array 'count': shape"));
}

TEST_CASE("a file that is no archive is refused by name") {
    const TemporaryFolder folder;
    CHECK(contains(refused(folder / "none.npz"), "none.npz: cannot be opened as an npz (zip) file: No such file"));
    CHECK(contains(refused(folder.path()), "is a folder, expected an npz file"));
    write_bytes(folder / "text.npz", "hello");
    CHECK(contains(refused(folder / "text.npz"), "text.npz: cannot be opened as an npz (zip) file: Not a zip archive"));
    write_bytes(folder / "empty.npz", "");
    CHECK(contains(refused(folder / "empty.npz"), "empty.npz: "));
    write_bytes(folder / "x.npy", scalar_image);
    CHECK(contains(refused(folder / "x.npy"), "Not a zip archive"));
}

TEST_CASE("a file cut off anywhere is refused by name") {
    const TemporaryFolder folder;
    write_npz(folder / "a.npz", sample_arrays(), NpzCompression::deflated);
    const std::string whole = read_bytes(folder / "a.npz");
    for (std::size_t size = 0; size < whole.size(); size += 13) {
        CAPTURE(size);
        write_bytes(folder / "cut.npz", whole.substr(0, size));
        CHECK(contains(refused(folder / "cut.npz"), "cut.npz"));
    }
}

TEST_CASE("a damaged byte among the data is noticed and its array named") {
    const TemporaryFolder folder;
    for (const NpzCompression compression : {NpzCompression::stored, NpzCompression::deflated}) {
        write_npz(folder / "a.npz", {{"x", sample_arrays().at("ramp")}}, compression);
        std::string bytes = read_bytes(folder / "a.npz");
        bytes[bytes.size() / 2 - 20] = static_cast<char>(bytes[bytes.size() / 2 - 20] ^ 0x10);
        write_bytes(folder / "a.npz", bytes);
        CHECK(contains(refused(folder / "a.npz"), "a.npz: array 'x': is damaged"));
    }
}

TEST_CASE("no damaged byte anywhere changes an array unnoticed") {
    const TemporaryFolder folder;
    const NpyArrays arrays{{"x", NpyArray::from_scalar(1.5)}, {"y", NpyArray::from_strings({"ab"}, {})}};
    for (const NpzCompression compression : {NpzCompression::stored, NpzCompression::deflated}) {
        write_npz(folder / "a.npz", arrays, compression);
        const std::string whole = read_bytes(folder / "a.npz");
        int noticed = 0;
        for (std::size_t place = 0; place < whole.size(); ++place) {
            CAPTURE(place);
            std::string bytes = whole;
            bytes[place] = static_cast<char>(bytes[place] ^ 0xFF);
            write_bytes(folder / "b.npz", bytes);
            const std::string text = refusal([&] {
                const NpzFile file = read_npz(folder / "b.npz");
                for (const auto& [name, array] : file.arrays()) {
                    if (arrays.count(name) > 0) {  // the damage may be in a name
                        const std::span<const unsigned char> read = array.file_bytes();
                        const std::span<const unsigned char> written = arrays.at(name).file_bytes();
                        CHECK(std::equal(read.begin(), read.end(), written.begin(), written.end()));
                    }
                }
            });
            CHECK((text.empty() || contains(text, "b.npz")));
            noticed += text.empty() ? 0 : 1;
        }
        // All but dates, versions, attributes and the like.
        CHECK(noticed > int(whole.size()) / 2);
    }
}

TEST_CASE("claims that no file of this size can hold are refused before memory is taken") {
    const TemporaryFolder folder;
    for (const NpzCompression compression : {NpzCompression::stored, NpzCompression::deflated}) {
        write_npz(folder / "a.npz", {{"x", sample_arrays().at("ramp")}}, compression);
        std::string bytes = read_bytes(folder / "a.npz");
        const std::size_t entry = bytes.find("PK\x01\x02");
        for (const std::size_t field : {std::size_t(20), std::size_t(24)}) {  // compressed, uncompressed size
            std::string damaged = bytes;
            damaged.replace(entry + field, 4, little_endian(0x7FFFFFF0, 4));
            write_bytes(folder / "b.npz", damaged);
            CHECK(contains(refused(folder / "b.npz"), "b.npz"));
        }
    }
    std::string bomb = numpy_zip({{"x.npy", scalar_image}});
    bomb.replace(bomb.find("PK\x01\x02") + 24, 4, little_endian(0x7FFFFFF0, 4));
    write_bytes(folder / "b.npz", bomb);
    CHECK(contains(refused(folder / "b.npz"), "array 'x': claims 2147483632 bytes, more than a file of this size"));

    write_npz(folder / "a.npz", {{"x", sample_arrays().at("ramp")}});  // and now three members made of the same bytes
    const std::string bytes = read_bytes(folder / "a.npz");
    const std::size_t first = bytes.find("PK\x01\x02"), end = bytes.find("PK\x05\x06");
    std::string shared = bytes.substr(0, first);
    for (const char* name : {"x", "y", "z"}) {
        std::string entry = bytes.substr(first, end - first);
        shared += entry.replace(entry.rfind("x.npy"), 1, name);
    }
    const std::string count = little_endian(3, 2), size = little_endian(shared.size() - first, 4);
    shared += bytes.substr(end).replace(8, 8, count + count + size);
    write_bytes(folder / "b.npz", shared);
    CHECK(contains(refused(folder / "b.npz"), "array 'y': claims"));
}

TEST_CASE("members that are no arrays in spite of their name, or appear twice, are refused") {
    const TemporaryFolder folder;
    write_bytes(folder / "a.npz", numpy_zip({{"x.npy", "hello"}}));
    CHECK(contains(refused(folder / "a.npz"), "a.npz: array 'x': not a .npy array"));
    write_bytes(folder / "a.npz", numpy_zip({{"x.npy", scalar_image}, {"x.npy", scalar_image}}));
    CHECK(contains(refused(folder / "a.npz"), "a.npz: array 'x': appears twice"));
}

TEST_CASE("a pickled array is refused when it is used, the others are not") {
    const TemporaryFolder folder;
    const std::string pickled = npy_image("{'descr': '|O', 'fortran_order': False, 'shape': ()}", "\x80\x04K\x01.");
    write_bytes(folder / "a.npz", numpy_zip({{"x.npy", pickled}, {"y.npy", scalar_image}}));
    const NpzFile file = read_npz(folder / "a.npz");
    CHECK(file.at("y").scalar<double>() == 1.5);
    CHECK(contains(refusal([&] { static_cast<void>(file.at("x").as<double>()); }),
                   "a.npz: array 'x': it holds pickled Python objects"));
}

TEST_CASE("a file that cannot be written leaves nothing behind") {
    const TemporaryFolder folder;
    CHECK(contains(refusal([&] { write_npz(folder / "none/a.npz", sample_arrays()); }), "none/a.npz: cannot write"));
    write_bytes(folder / "a.npz", "old");
    CHECK(contains(refusal([&] { write_npz(folder / "a.npz", {}); }), "a.npz: no arrays to write"));
    CHECK(read_bytes(folder / "a.npz") == "old");
    CHECK(folder.num_files() == 1);
}
