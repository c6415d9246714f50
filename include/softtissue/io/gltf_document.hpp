// SPDX-License-Identifier: MIT
/// @file
/// A glTF 2.0 file (.glb, .gltf): checked access to its elements and to the numbers of its accessors.
///
/// What        every accessor as a matrix with one column per element: strided views, normalised integers, sparse accessors.
/// Memory      decoded numbers of at most max_expansion bytes per byte of the file and its buffers (plus 1 MiB): what a file can
///             make a program allocate is bounded by its size.
/// Refuses     what GltfContainer refuses, a view or an accessor that reaches out of what it lies in, sparse indices out of order
///             or range, numbers that are not finite (InvalidInput names file, element, value, expectation).
/// Source      Khronos Group, "glTF 2.0 Specification", sec. 3.6.2 (accessors)
/// Departs     the JSON is read by nlohmann-json and checked here: no other reader's checks are relied on.
/// Needs       nlohmann-json
/// Tests       tests/unit/io/gltf_document_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/io/gltf_container.hpp>
#include <softtissue/io/json_element.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>

namespace softtissue {

/// The numbers of an accessor, components x count; normalised integers are divided by their largest value.
struct GltfValues {
    MatrixX<double> values;
    int component_type = 0;  ///< as in the file: 5120 (int8) to 5126 (float)
    bool is_normalized = false;
};

class GltfDocument : public GltfContainer {
public:
    static constexpr Index max_expansion = 64;

    explicit GltfDocument(const std::filesystem::path& path) : GltfContainer(path) {}

    /// The numbers of the accessor that `reference` means, which must be of `type` ("VEC3").
    GltfValues read(const JsonElement& reference, std::string_view type) {
        const JsonElement accessor = element("accessors", index(reference, "accessors"));
        const Index rows = components_of(accessor, type);
        const Index count = accessor.at("count").integer(1, max_integer);
        GltfValues result;
        result.component_type = component_type(accessor);
        result.is_normalized = accessor.has("normalized") && accessor.at("normalized").flag();
        const bool has_view = accessor.has("bufferView");
        const Bytes bytes = has_view ? strided(accessor, rows, count, result.component_type) : Bytes{};
        const bool is_sparse = accessor.has("sparse");
        claim(accessor, rows, count);
        result.values.setZero(rows, count);
        if (has_view) {
            for (Index i = 0; i < count; ++i) {
                decode(accessor, bytes, i, i, result);
            }
        }
        if (is_sparse) {
            read_sparse(accessor, rows, count, result);
        }
        return result;
    }

    /// Counts `rows` x `count` numbers against what the file may make a program allocate.
    void claim(const JsonElement& reason, Index rows, Index count) {
        const Index left = max_expansion * loaded_bytes() + (Index(1) << 20) - decoded_bytes_;
        require(count <= left / (8 * rows), reason.name(), ": ", rows, " x ", count, " numbers would make more than ",
                max_expansion, " bytes for every byte of the file");
        decoded_bytes_ += 8 * rows * count;
    }

private:
    /// Elements that have been checked to lie inside their buffer.
    struct Bytes {
        const char* first = nullptr;
        Index stride = 0;
    };

    static Index components_of(const JsonElement& accessor, std::string_view type) {
        const std::string stated = accessor.at("type").text();
        require(stated == type, accessor.name(), ".type = ", stated, ", expected ", type);
        return type == "MAT4" ? 16 : type == "SCALAR" ? 1 : type.back() - '0';
    }

    static int component_type(const JsonElement& accessor) {
        const Index type = accessor.at("componentType").integer(5120, 5126);
        require(type != 5124, accessor.name(), ".componentType = 5124, expected 5120 to 5123, 5125 or 5126");
        return static_cast<int>(type);
    }

    static Index component_size(int type) { return type <= 5121 ? 1 : type <= 5123 ? 2 : 4; }

    /// Where `count` elements of `rows` components lie; `place` has bufferView and byteOffset.
    Bytes strided(const JsonElement& place, Index rows, Index count, int type) {
        const JsonElement view = element("bufferViews", index(place.at("bufferView"), "bufferViews"));
        const std::string& bytes = buffer(index(view.at("buffer"), "buffers"));
        const Index available = static_cast<Index>(bytes.size());
        const Index view_offset = view.has("byteOffset") ? view.at("byteOffset").integer(0, max_integer) : 0;
        const Index view_size = view.at("byteLength").integer(1, max_integer);
        require(view_offset <= available && view_size <= available - view_offset, view.name(), " ends at byte ",
                view_offset + view_size, " of a buffer of ", available);
        const Index size = rows * component_size(type);
        const Index stride = view.has("byteStride") ? view.at("byteStride").integer(4, 252) : size;
        const Index offset = place.has("byteOffset") ? place.at("byteOffset").integer(0, max_integer) : 0;
        require(stride >= size, view.name(), ".byteStride = ", stride, ", expected at least ", size);
        require(offset <= view_size && size <= view_size - offset && count - 1 <= (view_size - offset - size) / stride,
                place.name(), ": ", count, " elements of ", size, " bytes, ", stride, " apart from byte ", offset,
                ", reach out of ", view.name(), " of ", view_size, " bytes");
        return {bytes.data() + view_offset + offset, stride};
    }

    template <class T>
    static double stored(const char* place, bool is_normalized) {
        T value;
        std::memcpy(&value, place, sizeof(T));
        if constexpr (std::numeric_limits<T>::is_integer) {
            if (is_normalized) {
                return std::max(double(value) / double(std::numeric_limits<T>::max()), -1.0);
            }
        }
        return double(value);
    }

    static double component(const char* place, int type, bool is_normalized) {
        switch (type) {
            case 5120:
                return stored<std::int8_t>(place, is_normalized);
            case 5121:
                return stored<std::uint8_t>(place, is_normalized);
            case 5122:
                return stored<std::int16_t>(place, is_normalized);
            case 5123:
                return stored<std::uint16_t>(place, is_normalized);
            case 5125:
                return stored<std::uint32_t>(place, is_normalized);
            default:
                return stored<float>(place, is_normalized);
        }
    }

    /// Element `from` of `bytes` becomes column `to`.
    static void decode(const JsonElement& accessor, const Bytes& bytes, Index from, Index to, GltfValues& result) {
        for (Index r = 0; r < result.values.rows(); ++r) {
            const char* place = bytes.first + from * bytes.stride + r * component_size(result.component_type);
            const double value = component(place, result.component_type, result.is_normalized);
            require(std::isfinite(value), accessor.name(), ": component ", r, " of element ", to, " = ", value,
                    ", expected a finite number");
            result.values(r, to) = value;
        }
    }

    void read_sparse(const JsonElement& accessor, Index rows, Index count, GltfValues& result) {
        const JsonElement sparse = accessor.at("sparse");
        const Index changes = sparse.at("count").integer(1, count);
        const JsonElement places = sparse.at("indices");
        const int type = component_type(places);
        require(type == 5121 || type == 5123 || type == 5125, places.name(), ".componentType = ", type,
                ", expected an unsigned integer");
        const Bytes indices = strided(places, 1, changes, type);
        const Bytes values = strided(sparse.at("values"), rows, changes, result.component_type);
        Index last = -1;
        for (Index i = 0; i < changes; ++i) {
            const Index to = static_cast<Index>(component(indices.first + i * indices.stride, type, false));
            require(to > last && to < count, places.name(), ": index ", i, " = ", to, ", expected ", last + 1, " to ",
                    count - 1);
            decode(accessor, values, i, to, result);
            last = to;
        }
    }

    Index decoded_bytes_ = 0;
};

}  // namespace softtissue
