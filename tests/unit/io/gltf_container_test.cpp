// SPDX-License-Identifier: MIT
#include <softtissue/io/gltf_container.hpp>

#include "gltf_test_file.hpp"

#include <doctest/doctest.h>

#include <string>

using namespace softtissue;
using namespace io_test;

namespace {

GltfFile two_buffers() {
    GltfFile file;
    file.bytes = std::string(
        "ab\0\xFF"
        "efgh",
        8);
    return file;
}

std::string refused(const TemporaryFolder& folder, const std::string& bytes, bool reads_buffer = false) {
    write_bytes(folder / "a.gltf", bytes);
    return refusal([&] {
        GltfContainer container(folder / "a.gltf");
        if (reads_buffer) {
            container.buffer(0);
        }
    });
}

}  // namespace

TEST_CASE("the buffer comes from the binary chunk, a data address or a file") {
    const TemporaryFolder folder;
    const GltfFile file = two_buffers();
    write_bytes(folder / "a.glb", file.glb());
    write_bytes(folder / "b.gltf", file.embedded());
    write_bytes(folder / "c.gltf", file.gltf("my%20data.bin"));
    write_bytes(folder / "my data.bin", file.bytes + "more");
    for (const char* name : {"a.glb", "b.gltf", "c.gltf"}) {
        CAPTURE(name);
        GltfContainer container(folder / name);
        CHECK(container.buffer(0).substr(0, 8) == file.bytes);
        CHECK(&container.buffer(0) == &container.buffer(0));
        CHECK(container.count("buffers") == 1);
        CHECK(container.count("meshes") == 0);
        CHECK(container.element("buffers", 0).at("byteLength").integer(0, 100) == 8);
        CHECK(container.loaded_bytes() >= 8);
    }
}

TEST_CASE("base64 of every length") {
    std::string bytes;
    for (int n = 0; n < 12; ++n) {
        std::string decoded;
        CHECK(detail::decode_base64(base64_of(bytes), decoded));
        CHECK(decoded == bytes);
        bytes += char(17 * n + 200);
    }
    std::string decoded;
    CHECK_FALSE(detail::decode_base64("ab c", decoded));
    CHECK_FALSE(detail::decode_base64("abcde", decoded));  // six bits too many
}

TEST_CASE("what is no glTF file is refused") {
    const TemporaryFolder folder;
    CHECK(contains(refusal([&] { GltfContainer(folder / "none.glb"); }), "none.glb is no file"));
    CHECK(contains(refusal([&] { GltfContainer container(folder.path()); }), "is no file"));
    CHECK(contains(refused(folder, ""), "a.gltf: is no glTF file (neither .glb nor a JSON object)"));
    CHECK(contains(refused(folder, "[1, 2"), "is no glTF file"));
    CHECK(contains(refused(folder, "[1, 2]"), "is no glTF file"));
    CHECK(contains(refused(folder, "{}"), "a.gltf: asset is missing"));
    CHECK(contains(refused(folder, R"({"asset": {"version": "1.0"}})"), "asset.version = 1.0, expected 2.x"));
    CHECK(contains(
        refused(folder, R"({"asset": {"version": "2.0"}, "extensionsRequired": ["KHR_draco_mesh_compression"]})"),
        "a.gltf: extensionsRequired[0] = KHR_draco_mesh_compression, an extension that is not read"));
    CHECK(refused(folder, R"({"asset": {"version": "2.1"}, "extensionsRequired": ["KHR_mesh_quantization"]})") == "");
    CHECK(contains(refused(folder, std::string(100000, '[')), "is no glTF file"));
}

TEST_CASE("a .glb whose sizes lie is refused, whereever it is cut off") {
    const TemporaryFolder folder;
    const std::string whole = two_buffers().glb();
    CHECK(refused(folder, whole, true) == "");
    for (std::size_t size = 4; size < whole.size(); size += 3) {
        CAPTURE(size);
        CHECK(contains(refused(folder, whole.substr(0, size), true), "a.gltf: "));
    }
    const auto with_word = [&](std::size_t place, std::size_t value) {
        std::string bytes = whole;
        bytes.replace(place, 4, GltfFile::word(value));
        return bytes;
    };
    const std::size_t text_size = two_buffers().glb().find("BIN") - 24;
    CHECK(contains(refused(folder, with_word(4, 1)), "is no .glb of version 2"));
    CHECK(contains(refused(folder, with_word(8, whole.size() + 1)), "its header says"));
    CHECK(contains(refused(folder, with_word(8, 5)), "its header says 5"));
    CHECK(contains(refused(folder, with_word(12, 0xFFFFFFFF)), "first chunk (JSON) has 4294967295 bytes"));
    CHECK(contains(refused(folder, with_word(16, 7)), "first chunk (JSON)"));
    CHECK(contains(refused(folder, with_word(20 + text_size, 0xFFFFFFFF)), "binary chunk has 4294967295 bytes"));
}

TEST_CASE("buffers that are not what they say are refused") {
    const TemporaryFolder folder;
    const auto with_buffer = [&](const std::string& buffer) {
        return refused(folder, R"({"asset": {"version": "2.0"}, "buffers": [)" + buffer + "]}", true);
    };
    CHECK(contains(with_buffer("{}"), "a.gltf: buffers[0].byteLength is missing"));
    CHECK(contains(with_buffer(R"({"byteLength": -4})"), "buffers[0].byteLength = -4, expected an integer from 1"));
    CHECK(contains(with_buffer(R"({"byteLength": 4})"), "buffers[0]: has no uri and the file no binary chunk"));
    CHECK(contains(with_buffer(R"({"byteLength": 4, "uri": "data:;base64,QUJD"})"),
                   "buffers[0].byteLength = 4, but there are 3 bytes"));
    CHECK(contains(with_buffer(R"({"byteLength": 4, "uri": "data:;base64,?"})"),
                   "buffers[0].uri: expected data in base64"));
    CHECK(contains(with_buffer(R"({"byteLength": 4, "uri": "data:text,QUJD"})"), "expected data in base64"));
    CHECK(contains(with_buffer(R"({"byteLength": 4, "uri": "http://x/y.bin"})"), "buffers[0].uri = http://x/y.bin"));
    CHECK(contains(with_buffer(R"({"byteLength": 4, "uri": "/etc/hostname"})"), "relative to this one"));
    CHECK(contains(with_buffer(R"({"byteLength": 4, "uri": "%2Fetc%2Fhostname"})"), "relative to this one"));
    CHECK(contains(with_buffer(R"({"byteLength": 4, "uri": "none.bin"})"), "none.bin is no file"));
    const std::string long_name(300, 'n');
    CHECK(contains(with_buffer("{\"byteLength\": 4, \"uri\": \"" + long_name + "\"}"), "is no file"));
    CHECK(contains(with_buffer(R"({"byteLength": 4, "uri": 7})"), "buffers[0].uri = 7, expected a text"));
    write_bytes(folder / "short.bin", "abc");
    CHECK(
        contains(with_buffer(R"({"byteLength": 9007199254740993, "uri": "short.bin"})"), "expected an integer from 1"));
    CHECK(contains(with_buffer(R"({"byteLength": 4000000000, "uri": "short.bin"})"), "but there are 3 bytes"));
}
