// SPDX-License-Identifier: MIT
/// @file
/// Small glTF files made by hand for tests, and a rigged bar to read: four rings of four vertices, closed at both ends.
#pragma once

#include "io_test_support.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace io_test {

inline std::string base64_of(const std::string& bytes) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            bits = bits << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k > bytes.size() ? '=' : digits[bits >> (18U - 6U * k) & 63U];
        }
    }
    return text;
}

/// A file as it grows: every add() makes a view and an accessor.
struct GltfFile {
    nlohmann::json json = {{"asset", {{"version", "2.0"}}}};
    std::string bytes;

    template <class T>
    static int component_type() {
        return sizeof(T) == 1 ? 5121 : sizeof(T) == 2 ? 5123 : T(0.5) > T(0) ? 5126 : 5125;
    }

    template <class T>
    int add(const std::vector<T>& values, const std::string& type, bool is_normalized = false) {
        const std::size_t components = type == "MAT4" ? 16 : type == "SCALAR" ? 1 : std::size_t(type.back() - '0');
        json["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}});
        nlohmann::json accessor = {{"bufferView", json["bufferViews"].size() - 1},
                                   {"componentType", component_type<T>()},
                                   {"count", values.size() / components},
                                   {"type", type}};
        if (is_normalized) {
            accessor["normalized"] = true;
        }
        json["accessors"].push_back(accessor);
        bytes += bytes_of(values);
        bytes.resize((bytes.size() + 3) / 4 * 4);
        return int(json["accessors"].size()) - 1;
    }

    static std::string word(std::size_t value) {
        const auto number = std::uint32_t(value);
        std::string text(4, '\0');
        std::memcpy(text.data(), &number, 4);
        return text;
    }

    std::string glb() const {
        nlohmann::json whole = json;
        if (!whole.contains("buffers")) {
            whole["buffers"] = {{{"byteLength", bytes.size()}}};
        }
        std::string text = whole.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::string chunks = word(text.size()) + "JSON" + text;
        if (!bytes.empty()) {
            chunks += word(bytes.size()) + std::string("BIN\0", 4) + bytes;
        }
        return "glTF" + word(2) + word(12 + chunks.size()) + chunks;
    }

    std::string gltf(const std::string& uri) const {
        nlohmann::json whole = json;
        whole["buffers"] = {{{"byteLength", bytes.size()}, {"uri", uri}}};
        return whole.dump();
    }
    std::string embedded() const { return gltf("data:application/octet-stream;base64," + base64_of(bytes)); }

    void write(const std::filesystem::path& path) const { write_bytes(path, glb()); }
};

inline std::vector<float> translation_matrix(float x, float y, float z) {
    return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1};
}

/// A bar along x from 0 to 3 with joints at x = 0 ("root"), 1 ("bend") and 3 ("end", without weights). One morph target
/// "thick", a clip "wave" of 1 s that turns "bend" by a quarter turn about z and moves "root" by 2 along y.
inline GltfFile rigged_bar() {
    GltfFile file;
    std::vector<float> positions, weights, thick;
    std::vector<std::uint8_t> joints;
    for (int ring = 0; ring < 4; ++ring) {
        const float bend = ring < 1 ? 0.0F : ring == 1 ? 0.5F : 1.0F;
        for (const auto& [y, z] : {std::pair{-1, -1}, std::pair{1, -1}, std::pair{1, 1}, std::pair{-1, 1}}) {
            for (const float x : {float(ring), 0.3F * float(y), 0.3F * float(z)}) {
                positions.push_back(x);
            }
            for (const float x : {0.0F, 0.1F * float(y), 0.1F * float(z)}) {
                thick.push_back(x);
            }
            for (const int joint : {1, 0, 0, 0}) {
                joints.push_back(std::uint8_t(joint));
            }
            for (const float weight : {bend, 1.0F - bend, 0.0F, 0.0F}) {
                weights.push_back(weight);
            }
        }
    }
    std::vector<std::uint16_t> corners = {0, 2, 1, 0, 3, 2, 12, 13, 14, 12, 14, 15};
    for (int ring = 0; ring < 3; ++ring) {
        for (int k = 0; k < 4; ++k) {
            const int a = 4 * ring + k, b = 4 * ring + (k + 1) % 4;
            for (const int corner : {a, b, a + 4, b, b + 4, a + 4}) {
                corners.push_back(std::uint16_t(corner));
            }
        }
    }
    std::vector<float> matrices;
    for (const float x : {0.0F, -1.0F, -3.0F}) {
        const std::vector<float> matrix = translation_matrix(x, 0.0F, 0.0F);
        matrices.insert(matrices.end(), matrix.begin(), matrix.end());
    }
    const float half = 0.70710678F;
    nlohmann::json part;
    part["attributes"]["POSITION"] = file.add(positions, "VEC3");
    part["attributes"]["JOINTS_0"] = file.add(joints, "VEC4");
    part["attributes"]["WEIGHTS_0"] = file.add(weights, "VEC4");
    part["indices"] = file.add(corners, "SCALAR");
    part["targets"].push_back({{"POSITION", file.add(thick, "VEC3")}});
    file.json["meshes"] = {{{"name", "bar"}, {"primitives", {part}}, {"extras", {{"targetNames", {"thick"}}}}}};
    file.json["nodes"] = {{{"name", "root"}, {"children", {1}}},
                          {{"name", "bend"}, {"translation", {1, 0, 0}}, {"children", {2}}},
                          {{"name", "end"}, {"translation", {2, 0, 0}}},
                          {{"name", "body"}, {"mesh", 0}, {"skin", 0}}};
    file.json["skins"] = {{{"joints", {0, 1, 2}}, {"inverseBindMatrices", file.add(matrices, "MAT4")}}};
    const int times = file.add(std::vector<float>{0.0F, 1.0F}, "SCALAR");
    const int turns = file.add(std::vector<float>{0, 0, 0, 1, 0, 0, half, half}, "VEC4");
    const int moves = file.add(std::vector<float>{0, 0, 0, 0, 2, 0}, "VEC3");
    file.json["animations"] = {
        {{"name", "wave"},
         {"channels",
          {{{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}},
           {{"sampler", 1}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
         {"samplers", {{{"input", times}, {"output", turns}}, {{"input", times}, {"output", moves}}}}}};
    return file;
}

}  // namespace io_test
