// SPDX-License-Identifier: MIT
#include <softtissue/io/gltf_document.hpp>

#include "gltf_test_file.hpp"

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

GltfValues read(GltfDocument& document, int accessor, const char* type) {
    const nlohmann::json reference = accessor;
    return document.read(JsonElement("user", reference), type);
}

std::string refused(const TemporaryFolder& folder, const GltfFile& file, const char* type = "SCALAR") {
    file.write(folder / "a.glb");
    GltfDocument document(folder / "a.glb");
    return refusal([&] { read(document, 0, type); });
}

/// The same with one member of accessors[0] or bufferViews[0] changed.
std::string refused_with(const TemporaryFolder& folder, GltfFile file, const char* kind, const char* member,
                         const nlohmann::json& value) {
    file.json[kind][0][member] = value;
    return refused(folder, file);
}

}  // namespace

TEST_CASE("numbers of every type, packed, strided and normalised") {
    const TemporaryFolder folder;
    GltfFile file;
    const int floats = file.add(std::vector<float>{1, 2, 3, 4, 5, 6}, "VEC3");
    const int bytes = file.add(std::vector<std::uint8_t>{0, 51, 255}, "SCALAR", true);
    const int shorts = file.add(std::vector<std::uint16_t>{0, 13107, 65535}, "SCALAR", true);
    const int words = file.add(std::vector<std::uint32_t>{4000000000U, 7U}, "SCALAR");
    const int plain = file.add(std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6, 7, 8}, "VEC4");
    const int signs = file.add(std::vector<std::uint8_t>{0x80, 0x81, 0x7F}, "SCALAR", true);
    file.json["accessors"][std::size_t(signs)]["componentType"] = 5120;
    file.write(folder / "a.glb");
    GltfDocument document(folder / "a.glb");
    CHECK(read(document, floats, "VEC3").values == (MatrixX<double>(3, 2) << 1, 4, 2, 5, 3, 6).finished());
    CHECK(read(document, bytes, "SCALAR").values == (MatrixX<double>(1, 3) << 0, 0.2, 1).finished());
    CHECK(read(document, shorts, "SCALAR").values == (MatrixX<double>(1, 3) << 0, 0.2, 1).finished());
    CHECK(read(document, words, "SCALAR").values == (MatrixX<double>(1, 2) << 4e9, 7).finished());
    CHECK(read(document, plain, "VEC4").values(2, 1) == 7.0);
    CHECK(read(document, signs, "SCALAR").values == (MatrixX<double>(1, 3) << -1, -1, 1).finished());
    CHECK(read(document, plain, "VEC4").component_type == 5121);

    file.json["bufferViews"][std::size_t(floats)]["byteStride"] = 12;
    file.json["accessors"][std::size_t(floats)]["type"] = "SCALAR";
    file.json["accessors"][std::size_t(floats)]["byteOffset"] = 4;
    file.write(folder / "b.glb");
    GltfDocument strided(folder / "b.glb");
    CHECK(read(strided, floats, "SCALAR").values == (MatrixX<double>(1, 2) << 2, 5).finished());
}

TEST_CASE("sparse accessors change some elements, of a view or of zeros") {
    const TemporaryFolder folder;
    GltfFile file;
    const int base = file.add(std::vector<float>{1, 2, 3, 4}, "SCALAR");
    const int indices = file.add(std::vector<std::uint8_t>{1, 3}, "SCALAR");
    const int values = file.add(std::vector<float>{20, 40}, "SCALAR");
    nlohmann::json sparse = {{"count", 2},
                             {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                             {"values", {{"bufferView", values}}}};
    file.json["accessors"].push_back(
        {{"bufferView", base}, {"componentType", 5126}, {"count", 4}, {"type", "SCALAR"}, {"sparse", sparse}});
    file.json["accessors"].push_back({{"componentType", 5126}, {"count", 5}, {"type", "SCALAR"}, {"sparse", sparse}});
    file.write(folder / "a.glb");
    GltfDocument document(folder / "a.glb");
    CHECK(read(document, 3, "SCALAR").values == (MatrixX<double>(1, 4) << 1, 20, 3, 40).finished());
    CHECK(read(document, 4, "SCALAR").values == (MatrixX<double>(1, 5) << 0, 20, 0, 40, 0).finished());

    const auto refused_sparse = [&](const nlohmann::json& patch) {
        GltfFile changed = file;
        nlohmann::json accessor = file.json["accessors"][4];
        accessor.merge_patch(patch);
        changed.json["accessors"][0] = accessor;
        return refused(folder, changed);
    };
    CHECK(refused_sparse(nlohmann::json::object()) == "");
    CHECK(contains(refused_sparse({{"count", 3}}), "accessors[0].sparse.indices: index 1 = 3, expected 2 to 2"));
    CHECK(contains(refused_sparse({{"sparse", {{"count", 6}}}}), "sparse.count = 6, expected an integer from 1 to 5"));
    CHECK(contains(refused_sparse({{"sparse", {{"indices", {{"byteOffset", 1}}}}}}), "reach out of"));
    CHECK(
        contains(refused_sparse({{"sparse", {{"indices", {{"bufferView", 9}}}}}}), "expected an integer from 0 to 2"));
    CHECK(contains(refused_sparse({{"sparse", {{"indices", {{"componentType", 5126}}}}}}),
                   "expected an unsigned integer"));
    CHECK(contains(refused_sparse({{"sparse", {{"values", {{"byteOffset", 8}}}}}}), "reach out of"));
    GltfFile unordered = file;
    unordered.json["accessors"][0] = file.json["accessors"][4];
    unordered.bytes[16] = 3;
    CHECK(contains(refused(folder, unordered), "sparse.indices: index 1 = 3, expected 4 to 4"));
}

TEST_CASE("accessors that reach out of their view or buffer are refused") {
    const TemporaryFolder folder;
    GltfFile file;
    file.add(std::vector<float>{1, 2, 3, 4}, "SCALAR");
    file.add(std::vector<float>{5}, "SCALAR");
    CHECK(refused(folder, file) == "");
    CHECK(contains(refused(folder, file, "VEC3"), "accessors[0].type = SCALAR, expected VEC3"));
    const auto accessor = [&](const char* member, const nlohmann::json& value) {
        return refused_with(folder, file, "accessors", member, value);
    };
    const auto view = [&](const char* member, const nlohmann::json& value) {
        return refused_with(folder, file, "bufferViews", member, value);
    };
    CHECK(contains(accessor("count", 5),
                   "a.glb: accessors[0]: 5 elements of 4 bytes, 4 apart from byte 0, reach out of"));
    CHECK(contains(accessor("count", 4503599627370495), "reach out of"));
    CHECK(contains(accessor("count", 1e300), "count = 1e+300, expected an integer"));
    CHECK(contains(accessor("count", 0), "count = 0, expected an integer from 1"));
    CHECK(contains(accessor("count", -1), "accessors[0].count = -1, expected an integer from 1"));
    CHECK(contains(accessor("count", 1.5), "count = 1.5"));
    CHECK(contains(accessor("byteOffset", -4), "accessors[0].byteOffset = -4, expected an integer from 0"));
    CHECK(contains(accessor("byteOffset", 4), "reach out of"));
    CHECK(contains(accessor("byteOffset", 4503599627370495), "reach out of"));
    CHECK(contains(accessor("componentType", 5124), "componentType = 5124"));
    CHECK(contains(accessor("componentType", 1), "componentType = 1, expected an integer from 5120 to 5126"));
    CHECK(contains(accessor("bufferView", 2), "accessors[0].bufferView = 2, expected an integer from 0 to 1"));
    CHECK(contains(accessor("normalized", 1), "accessors[0].normalized = 1, expected true or false"));
    CHECK(contains(view("byteOffset", -1), "bufferViews[0].byteOffset = -1"));
    CHECK(contains(view("byteOffset", 8), "bufferViews[0] ends at byte 24 of a buffer of 20"));
    CHECK(contains(view("byteLength", 21), "bufferViews[0] ends at byte 21"));
    CHECK(contains(view("byteLength", 4503599627370496), "ends at byte"));
    CHECK(contains(view("byteLength", 12), "bufferViews[0] of 12 bytes"));
    CHECK(contains(view("byteStride", 2), "bufferViews[0].byteStride = 2, expected an integer from 4 to 252"));
    CHECK(contains(view("byteStride", 8), "reach out of"));
    CHECK(contains(view("buffer", 1), "bufferViews[0].buffer = 1, expected an integer from 0 to 0"));
    GltfFile broken = file;
    const float not_a_number = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(broken.bytes.data() + 8, &not_a_number, 4);
    CHECK(contains(refused(folder, broken), "accessors[0]: component 0 of element 2 = nan, expected a finite number"));
    GltfDocument document(folder / "a.glb");
    CHECK(contains(refusal([&] { read(document, 2, "SCALAR"); }), "user = 2, expected an integer from 0 to 1"));
}

TEST_CASE("a small file cannot make a program allocate much") {
    const TemporaryFolder folder;
    GltfFile file;
    file.add(std::vector<float>(64, 1.0F), "SCALAR");
    file.json["accessors"].push_back({{"componentType", 5126}, {"count", 1000000000}, {"type", "VEC4"}});
    file.write(folder / "a.glb");
    GltfDocument document(folder / "a.glb");
    CHECK(contains(refusal([&] { read(document, 1, "VEC4"); }),
                   "accessors[1]: 4 x 1000000000 numbers would make more than 64 bytes for every byte of the file"));
    // Nor by many accessors of the same bytes.
    int times = 0;
    CHECK(contains(refusal([&] {
                       for (; times < 1000000; ++times) {
                           read(document, 0, "SCALAR");
                       }
                   }),
                   "accessors[0]: 1 x 64 numbers"));
    CHECK(times * 64 * 8 <= (1 << 20) + 64 * 2000);
}
