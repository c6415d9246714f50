// SPDX-License-Identifier: MIT
/// @file
/// Files of named tensors with text about them (.safetensors), as PyTorch users exchange weights.
///
/// What        reads every tensor and the metadata of a file, in the order of its header; writes a file at once.
/// Layout      8 bytes: length of the header, little-endian; the header, JSON padded with spaces; the elements. Each tensor
///             has "dtype", "shape" and "data_offsets" (begin and end among the elements); "__metadata__" maps text to text.
/// Refuses     a file that is missing, cut off, longer than its tensors, a header that is longer than the file, no JSON or
///             of another form, names or keys that appear twice, an unknown element type, offsets that are out of range,
///             overlap, leave gaps or do not fit the shape (InvalidInput names file and tensor). Nothing is allocated that
///             the file cannot hold.
/// Example     const SafetensorsFile file = read_safetensors("model.safetensors");
///             const MatrixX<float> W = file.at("net.0.weight").matrix<float>();
///             write_safetensors("out.safetensors", {{"W", StoredTensor::from_matrix(W)}}, {{"format", "pt"}});
/// Source      Hugging Face, "Safetensors", section Format
/// Needs       nlohmann-json
/// Tests       tests/unit/io/safetensors_test.cpp
#pragma once

#if !defined(__cpp_exceptions) && !defined(_CPPUNWIND)
#error "softtissue: io/safetensors.hpp needs exceptions; without them, leave it out"
#endif

#if !__has_include(<nlohmann/json.hpp>)
#error "softtissue: io/safetensors.hpp needs nlohmann-json (Debian: nlohmann-json3-dev)"
#endif

#include <softtissue/core/error.hpp>
#include <softtissue/io/atomic_file.hpp>
#include <softtissue/io/stored_tensor.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace softtissue {

/// Tensors with their names, in the order of the file.
using NamedTensors = std::vector<std::pair<std::string, StoredTensor>>;

/// What a file says about itself.
using TensorMetadata = std::map<std::string, std::string>;

/// The content of one .safetensors file.
class SafetensorsFile {
public:
    SafetensorsFile(std::string path, NamedTensors tensors, TensorMetadata metadata)
        : path_(std::move(path)), tensors_(std::move(tensors)), metadata_(std::move(metadata)) {
        for (std::size_t i = 0; i < tensors_.size(); ++i) {
            place_.emplace(tensors_[i].first, i);
        }
    }

    const std::string& path() const { return path_; }
    const NamedTensors& tensors() const { return tensors_; }
    const TensorMetadata& metadata() const { return metadata_; }
    bool contains(const std::string& name) const { return place_.count(name) > 0; }

    const StoredTensor& at(const std::string& name) const {
        const auto found = place_.find(name);
        require(found != place_.end(), path_, ": tensor '", name, "' is missing");
        return tensors_[found->second].second;
    }

    const std::string& metadata_at(const std::string& key) const {
        const auto found = metadata_.find(key);
        require(found != metadata_.end(), path_, ": metadata '", key, "' is missing");
        return found->second;
    }

private:
    std::string path_;
    NamedTensors tensors_;
    TensorMetadata metadata_;
    std::map<std::string, std::size_t> place_;
};

namespace detail {

using Json = nlohmann::ordered_json;

inline constexpr std::array<std::string_view, 7> tensor_type_names{"F64", "F32", "F16", "BF16", "I64", "I32", "U8"};
inline constexpr std::size_t safetensors_preamble = 8;

/// Where a tensor lies among the elements.
struct TensorPlace {
    std::string name;
    TensorType type = TensorType::f64;
    std::vector<Index> shape;
    std::uint64_t begin = 0;
    std::uint64_t end = 0;
};

/// The header as JSON; the parser itself would let the second of two equal keys win.
inline Json parse_tensor_header(const std::string& file, const std::string& text) {
    std::vector<std::set<std::string>> keys;  // of the objects around the current place
    const Json::parser_callback_t refuse_twins = [&](int depth, Json::parse_event_t event, Json& value) {
        require(depth <= 3, file, ": header is nested too deeply");
        if (event == Json::parse_event_t::object_start) {
            keys.emplace_back();
        } else if (event == Json::parse_event_t::object_end) {
            keys.pop_back();
        } else if (event == Json::parse_event_t::key) {
            const bool is_new = keys.back().insert(value.get<std::string>()).second;
            require(is_new, file, ": '", value.get<std::string>(), "' appears twice in the header");
        }
        return true;
    };
    try {
        Json header = Json::parse(text, refuse_twins);
        require(header.is_object(), file, ": header is no JSON object");
        return header;
    } catch (const Json::exception& error) {
        throw_invalid_input(file, ": header is no JSON: ", error.what());
    }
}

/// A list of whole numbers that fit an Index.
inline std::vector<Index> whole_numbers(const std::string& source, const Json& entry, const char* key) {
    const Json& list = entry.at(key);
    require(list.is_array(), source, ": ", key, " is ", list.dump(), ", expected a list");
    std::vector<Index> numbers;
    for (const Json& number : list) {
        const bool fits = number.is_number_unsigned() &&
                          number.get<std::uint64_t>() <= std::uint64_t(std::numeric_limits<Index>::max());
        require(fits, source, ": ", key, " holds ", number.dump(), ", expected whole numbers >= 0");
        numbers.push_back(number.get<Index>());
    }
    return numbers;
}

inline TensorPlace tensor_place(const std::string& source, const std::string& name, const Json& entry,
                                std::uint64_t data_size) {
    const bool complete = entry.is_object() && entry.size() == 3 && entry.contains("dtype") &&
                          entry.contains("shape") && entry.contains("data_offsets");
    require(complete, source, ": its entry is malformed, expected dtype, shape and data_offsets");
    const Json& type = entry.at("dtype");
    const auto* const known = std::find(tensor_type_names.begin(), tensor_type_names.end(),
                                        type.is_string() ? type.get<std::string>() : std::string());
    require(known != tensor_type_names.end(), source, ": element type is ", type.dump(),
            ", expected F64, F32, F16, BF16, I64, I32 or U8");
    const std::vector<Index> offsets = whole_numbers(source, entry, "data_offsets");
    require(offsets.size() == 2, source, ": ", offsets.size(), " data_offsets, expected begin and end");
    TensorPlace place{name, TensorType(known - tensor_type_names.begin()), whole_numbers(source, entry, "shape"),
                      std::uint64_t(offsets[0]), std::uint64_t(offsets[1])};
    require(place.begin <= place.end && place.end <= data_size, source, ": lies at ", place.begin, " to ", place.end,
            ", expected a range among the ", data_size, " bytes that the file holds");
    const std::uint64_t elements = std::uint64_t(count_npy_elements(source, place.shape));
    const std::uint64_t bytes = place.end - place.begin;
    require(bytes % size_of(place.type) == 0 && bytes / size_of(place.type) == elements, source, ": occupies ", bytes,
            " bytes, expected those of ", elements, " elements of ", size_of(place.type), " bytes");
    return place;
}

inline TensorMetadata tensor_metadata(const std::string& file, const Json& entry) {
    require(entry.is_object(), file, ": __metadata__ is no JSON object");
    TensorMetadata metadata;
    for (const auto& item : entry.items()) {
        require(item.value().is_string(), file, ": metadata '", item.key(), "' is ", item.value().dump(),
                ", expected text");
        metadata.emplace(item.key(), item.value().get<std::string>());
    }
    return metadata;
}

/// Every byte must belong to exactly one tensor.
inline void require_partition(const std::string& file, std::vector<TensorPlace> places, std::uint64_t data_size) {
    std::sort(places.begin(), places.end(), [](const TensorPlace& a, const TensorPlace& b) {
        return std::pair(a.begin, a.end) < std::pair(b.begin, b.end);
    });
    std::uint64_t end = 0;
    for (const TensorPlace& place : places) {
        require(place.begin == end, file, ": tensor '", place.name, "' begins at ", place.begin, ", expected ", end,
                place.begin < end ? " (it overlaps another)" : " (a gap)");
        end = place.end;
    }
    require(end == data_size, file, ": ", data_size - end, " bytes after the last tensor, expected none");
}

}  // namespace detail

/// The tensors and metadata of `path`, checked completely.
inline SafetensorsFile read_safetensors(const std::filesystem::path& path) {
    const std::string file = path.string();
    require(std::filesystem::is_regular_file(path), file, ": is no file, expected a .safetensors file");
    std::ifstream stream(path, std::ios::binary);
    require(stream.is_open(), file, ": cannot be opened");
    const std::uint64_t file_size = std::filesystem::file_size(path);
    const auto read = [&](void* to, std::uint64_t size) {
        stream.read(static_cast<char*>(to), static_cast<std::streamsize>(size));
        require(stream.good(), file, ": cannot be read to its end");
    };
    require(file_size >= detail::safetensors_preamble, file, ": ", file_size, " bytes, no .safetensors file");
    std::array<unsigned char, detail::safetensors_preamble> preamble{};
    read(preamble.data(), preamble.size());
    std::uint64_t header_size = 0;
    for (std::size_t i = preamble.size(); i-- > 0;) {
        header_size = header_size << 8 | preamble[i];
    }
    require(header_size <= file_size - preamble.size(), file, ": claims a header of ", header_size,
            " bytes, more than a file of ", file_size, " bytes can hold (cut off, or no .safetensors file)");
    std::string text(header_size, '\0');
    read(text.data(), text.size());

    const std::uint64_t data_size = file_size - preamble.size() - header_size;
    TensorMetadata metadata;
    std::vector<detail::TensorPlace> places;
    const detail::Json header = detail::parse_tensor_header(file, text);
    for (const auto& item : header.items()) {
        if (item.key() == "__metadata__") {
            metadata = detail::tensor_metadata(file, item.value());
        } else {
            const std::string source = file + ": tensor '" + item.key() + "'";
            places.push_back(detail::tensor_place(source, item.key(), item.value(), data_size));
        }
    }
    detail::require_partition(file, places, data_size);
    NamedTensors tensors;
    for (detail::TensorPlace& place : places) {
        std::vector<unsigned char> bytes(place.end - place.begin);
        stream.seekg(static_cast<std::streamoff>(preamble.size() + header_size + place.begin));
        read(bytes.data(), bytes.size());
        tensors.emplace_back(place.name, StoredTensor(file + ": tensor '" + place.name + "'", place.type,
                                                      std::move(place.shape), std::move(bytes)));
    }
    return {file, std::move(tensors), std::move(metadata)};
}

/// Writes `tensors` to `path`: complete, or not at all. The same input gives the same bytes. Wider elements lie first, so
/// that every tensor is aligned for programs that map the file into memory; the header keeps the order given.
inline void write_safetensors(const std::filesystem::path& path, const NamedTensors& tensors,
                              const TensorMetadata& metadata = {}) {
    const std::string file = path.string();
    std::vector<std::size_t> order(tensors.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return size_of(tensors[a].second.type()) > size_of(tensors[b].second.type());
    });
    std::vector<std::uint64_t> begin(tensors.size());
    std::uint64_t end = 0;
    for (const std::size_t i : order) {
        begin[i] = end;
        end += tensors[i].second.bytes().size();
    }
    detail::Json header = detail::Json::object();
    if (!metadata.empty()) {
        header["__metadata__"] = metadata;
    }
    for (std::size_t i = 0; i < tensors.size(); ++i) {
        const auto& [name, tensor] = tensors[i];
        require(name != "__metadata__" && !header.contains(name), file, ": tensor '", name,
                "' cannot be written, expected each name once and not __metadata__");
        header[name] = {{"dtype", detail::tensor_type_names[std::size_t(tensor.type())]},
                        {"shape", tensor.shape()},
                        {"data_offsets", {begin[i], begin[i] + tensor.bytes().size()}}};
    }
    std::string text;
    try {
        text = header.dump();
    } catch (const detail::Json::exception& error) {
        throw_invalid_input(file, ": names and metadata must be UTF-8: ", error.what());
    }
    constexpr std::size_t alignment = 8;
    text.append((alignment - text.size() % alignment) % alignment, ' ');
    AtomicFile output(path);
    for (std::size_t i = 0; i < detail::safetensors_preamble; ++i) {
        const auto byte = static_cast<char>(std::uint64_t(text.size()) >> (8 * i) & 0xFF);
        output.write(&byte, 1);
    }
    output.write(text);
    for (const std::size_t i : order) {
        output.write(tensors[i].second.bytes().data(), tensors[i].second.bytes().size());
    }
    output.commit();
}

}  // namespace softtissue
