// SPDX-License-Identifier: MIT
/// @file
/// Triangle surfaces in Wavefront OBJ files.
///
/// What        positions and faces, read and written; polygons are split into fans of triangles from their first corner,
///             which is right for convex ones. Texture coordinates, normals, groups, materials, lines are skipped.
/// Shapes      positions 3 x n, triangles 3 x m.
/// Refuses     a number that cannot be read or is not finite, a face with fewer than three corners or with a vertex that
///             does not exist, a file without faces (InvalidInput names file, line and text).
/// Departs     no loader library behind it: those at hand read "v abc 1 2" as 0 1 2, and everything as float32.
/// Tests       tests/unit/io/obj_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/io/atomic_file.hpp>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace softtissue {

/// Positions and triangles of an OBJ file.
template <RealScalar S>
struct ObjMesh {
    Matrix3X<S> positions;
    Triangles triangles;
};

namespace detail {

/// Collects the vertices and faces of an OBJ file line by line.
class ObjParser {
public:
    explicit ObjParser(std::string file) : file_(std::move(file)) {}

    void parse_line(std::string_view line) {
        ++line_number_;
        line_ = line.substr(0, line.find('#'));
        rest_ = line_;
        const std::string_view keyword = next_word();
        if (keyword == "v") {
            for (int d = 0; d < 3; ++d) {
                coordinates_.push_back(parse_coordinate(next_word()));
            }
        } else if (keyword == "f") {
            parse_face();
        }
    }

    template <RealScalar S>
    ObjMesh<S> mesh() const {
        require(!corners_.empty(), file_, ": no faces");
        using Coordinates = Eigen::Map<const Matrix3X<double>>;
        using Corners = Eigen::Map<const Triangles>;
        ObjMesh<S> mesh{Coordinates(coordinates_.data(), 3, num_vertices()).template cast<S>(),
                        Corners(corners_.data(), 3, Index(corners_.size()) / 3)};
        for (Index v = 0; v < num_vertices(); ++v) {
            require(mesh.positions.col(v).allFinite(), file_, ": vertex ", v + 1, " is too large for ", 8 * sizeof(S),
                    " bits");
        }
        return mesh;
    }

private:
    Index num_vertices() const { return Index(coordinates_.size()) / 3; }

    std::string_view next_word() {
        constexpr std::string_view space = " \t\r";
        const std::size_t first = std::min(rest_.find_first_not_of(space), rest_.size());
        const std::size_t last = std::min(rest_.find_first_of(space, first), rest_.size());
        const std::string_view word = rest_.substr(first, last - first);
        rest_.remove_prefix(last);
        return word;
    }

    [[noreturn]] void refuse(const char* expectation) const {
        throw_invalid_input(file_, ": line ", line_number_, " is '", line_, "', expected ", expectation);
    }

    double parse_coordinate(std::string_view word) const {
        double value = 0.0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) {
            refuse("three finite coordinates");
        }
        return value;
    }

    /// The vertex of a corner "v", "v/vt", "v//vn" or "v/vt/vn"; counted from 1, or backwards from -1.
    std::int32_t parse_corner(std::string_view word) const {
        const std::string_view vertex = word.substr(0, word.find('/'));
        Index value = 0;
        const auto [end, error] = std::from_chars(vertex.data(), vertex.data() + vertex.size(), value);
        const Index index = value > 0 ? value - 1 : num_vertices() + value;
        if (error != std::errc() || end != vertex.data() + vertex.size() || value == 0 || index < 0 ||
            index >= num_vertices()) {
            refuse("a face of vertices that precede it");
        }
        return static_cast<std::int32_t>(index);
    }

    void parse_face() {
        std::vector<std::int32_t> polygon;
        for (std::string_view word = next_word(); !word.empty(); word = next_word()) {
            polygon.push_back(parse_corner(word));
        }
        if (polygon.size() < 3) {
            refuse("a face of at least three vertices");
        }
        for (std::size_t k = 2; k < polygon.size(); ++k) {
            corners_.insert(corners_.end(), {polygon[0], polygon[k - 1], polygon[k]});
        }
    }

    std::string file_;
    Index line_number_ = 0;
    std::string_view line_;
    std::string_view rest_;
    std::vector<double> coordinates_;
    std::vector<std::int32_t> corners_;
};

}  // namespace detail

/// The surface in `path`.
template <RealScalar S>
ObjMesh<S> read_obj(const std::filesystem::path& path) {
    std::ifstream stream(path);
    require(stream.is_open() && !std::filesystem::is_directory(path), path.string(),
            ": cannot be opened: ", std::strerror(errno));
    detail::ObjParser parser(path.string());
    std::string line;
    while (std::getline(stream, line)) {
        parser.parse_line(line);
    }
    require(stream.eof(), path.string(), ": cannot be read to its end");
    return parser.mesh<S>();
}

/// Writes positions (3 x n, shortest text that gives the same numbers again) and triangles.
template <class Derived>
void write_obj(const std::filesystem::path& path, const Eigen::MatrixBase<Derived>& positions,
               const Triangles& triangles) {
    AtomicFile file(path);
    std::string text;
    const auto append_number = [&](auto value) {
        char digits[32];
        const std::to_chars_result result = std::to_chars(digits, digits + sizeof(digits), value);
        text += ' ';
        text.append(digits, result.ptr);
    };
    for (Index v = 0; v < positions.cols(); ++v) {
        text += 'v';
        for (Index d = 0; d < 3; ++d) {
            append_number(typename Derived::Scalar(positions(d, v)));
        }
        text += '\n';
    }
    for (Index t = 0; t < triangles.cols(); ++t) {
        text += 'f';
        for (Index k = 0; k < 3; ++k) {
            append_number(triangles(k, t) + 1);
        }
        text += '\n';
    }
    file.write(text);
    file.commit();
}

}  // namespace softtissue
