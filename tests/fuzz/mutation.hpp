// SPDX-License-Identifier: MIT
/// @file
/// Changes to files that consist of parts: one part is changed, then lengths and checksums are made right again, and often the
/// amount of data too, so that what the reader checks first does not hide the rest.
#pragma once

#include "container.hpp"

#include <softtissue/core/random.hpp>
#include <softtissue/io/npy_header.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace softtissue_fuzz {

/// Gives the tensors of a .safetensors header places that follow each other, and as many elements as they need.
void fit_tensors(std::string& header, std::string& elements, std::size_t most_data);

namespace detail {

constexpr std::size_t most_data = 4096;  // that an array is given to fit its shape

inline void change(std::string& text, std::size_t room) {
    const std::size_t size = text.size();
    text.resize(size + std::clamp<std::size_t>(room, 1, 64));
    text.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(text.data()), size, text.size()));
}

inline void change_array(std::string& npy, std::size_t room, softtissue::RandomGenerator& random) {
    if (npy.size() < 10 || npy[6] != 1 || number_at(npy, 8, 2) > npy.size() - 10) {
        change(npy, room);
        return;
    }
    const std::size_t length = number_at(npy, 8, 2);
    std::string dictionary = npy.substr(10, length);
    std::string data = npy.substr(10 + length);
    change(random.index(3) == 0 ? data : dictionary, room);
    if (random.index(4) != 0) {
        try {
            softtissue::NpyHeader header;
            const std::string source = "changed";
            softtissue::detail::NpyDictionary(source, dictionary).parse_into(header);
            const auto count = static_cast<std::size_t>(softtissue::count_npy_elements(source, header.shape));
            if (count <= most_data && count * header.type.size <= most_data) {
                data.resize(count * header.type.size);
            }
        } catch (const softtissue::InvalidInput&) {
            data += dictionary;  // stays malformed, with more data than before
        }
    }
    npy = npy.substr(0, 8) + little_endian(dictionary.size(), 2) + dictionary + data;
}

}  // namespace detail

inline std::string mutated(Container container, std::string file, std::size_t max_size, unsigned int seed) {
    softtissue::RandomGenerator random(seed);
    std::optional<std::vector<Part>> parts = split(container, file);
    const std::size_t room = max_size > file.size() ? max_size - file.size() : 0;
    if (parts && random.index(12) != 0) {
        const auto chosen = static_cast<std::size_t>(random.index(softtissue::Index(parts->size())));
        const auto other = static_cast<std::size_t>(random.index(softtissue::Index(parts->size())));
        Part& part = (*parts)[chosen];
        if (container != Container::npz) {
            detail::change(part.bytes, room);
            if (container == Container::safetensors && random.index(4) != 0) {
                fit_tensors((*parts)[0].bytes, (*parts)[1].bytes, detail::most_data);
            }
        } else if (const softtissue::Index kind = random.index(20); kind == 0 && parts->size() > 1) {
            parts->erase(parts->begin() + static_cast<std::ptrdiff_t>(chosen));
        } else if (kind == 1) {
            part.bytes = (*parts)[other].bytes;
        } else if (kind == 2) {
            detail::change(part.name, room);
        } else {
            detail::change_array(part.bytes, room, random);
        }
        std::string joined = join(container, *parts);
        if (joined.size() <= max_size) {
            return joined;
        }
    }
    const std::size_t size = file.size();
    file.resize(std::max(max_size, size));
    file.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(file.data()), size, max_size));
    return file;
}

}  // namespace softtissue_fuzz
