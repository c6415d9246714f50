// SPDX-License-Identifier: MIT
/// @file
/// Cell meshes with arrays on vertices and cells, for ParaView (.vtu).
///
/// What        one time step of a mesh of triangles (3 nodes), tets (4) or prisms (6), binary.
/// Order       VTK's wedge has the normal of nodes 0, 1, 2 pointing away from nodes 3, 4, 5, Prism6 towards them; prisms
///             are written as nodes 0, 2, 1, 3, 5, 4. Triangles and tets agree.
/// Shapes      positions 3 x n; an array has one column per vertex or cell: 1 row scalars, 3 rows vectors, 9 rows tensors.
/// Valid       numbers are stored in float32; values that are not finite are written as they are.
/// Refuses     an array of another number of columns, a cell with a vertex out of range (InvalidInput names file and array).
/// Source      Kitware, "VTK File Formats", XML formats; "vtkWedge"
/// Tests       tests/unit/io/vtu_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/io/atomic_file.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace softtissue {

/// Named values, one column per vertex or cell.
struct VtuArray {
    std::string name;
    MatrixX<float> values;
};

/// What to show on a mesh.
struct VtuFields {
    std::vector<VtuArray> vertex_arrays;
    std::vector<VtuArray> cell_arrays;
};

namespace detail {

/// `text` with the characters that XML reserves replaced.
inline std::string xml_escaped(const std::string& text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
            case '&':
                result += "&amp;";
                break;
            case '<':
                result += "&lt;";
                break;
            case '>':
                result += "&gt;";
                break;
            case '"':
                result += "&quot;";
                break;
            default:
                result += c;
        }
    }
    return result;
}

/// The two halves of a .vtu file: its XML text, and the binary blocks that the text refers to by offset.
class VtuContent {
public:
    std::string xml;
    std::string blocks;

    void append_array(const char* type, const std::string& name, Index components, const void* data,
                      std::size_t bytes) {
        xml += std::string("<DataArray type=\"") + type + "\" Name=\"" + xml_escaped(name) +
               "\" NumberOfComponents=\"" + std::to_string(components) + "\" format=\"appended\" offset=\"" +
               std::to_string(blocks.size()) + "\"/>\n";
        const std::uint64_t size = bytes;
        blocks.append(reinterpret_cast<const char*>(&size), sizeof(size));
        blocks.append(static_cast<const char*>(data), bytes);
    }

    template <class T, int rows>
    void append_matrix(const char* type, const std::string& name,
                       const Eigen::Matrix<T, rows, Eigen::Dynamic>& values) {
        append_array(type, name, values.rows(), values.data(), std::size_t(values.size()) * sizeof(T));
    }

    void append_fields(const std::string& file, const char* section, const std::vector<VtuArray>& arrays, Index count) {
        xml += std::string("<") + section + ">\n";
        for (const VtuArray& array : arrays) {
            require(array.values.cols() == count && array.values.rows() > 0, file, ": ", section, " array '",
                    array.name, "' is ", array.values.rows(), " x ", array.values.cols(), ", expected ", count,
                    " columns");
            append_matrix<float, Eigen::Dynamic>("Float32", array.name, array.values);
        }
        xml += std::string("</") + section + ">\n";
    }
};

}  // namespace detail

/// Writes one time step: `cells` (num_nodes x cells) at `positions` (3 x n) with `fields`.
template <class Derived, int num_nodes>
void write_vtu(const std::filesystem::path& path, const Eigen::MatrixBase<Derived>& positions,
               const Connectivity<num_nodes>& cells, const VtuFields& fields = {}) {
    static_assert(num_nodes == 3 || num_nodes == 4 || num_nodes == 6, "vtu: cells are triangles, tets or prisms");
    constexpr std::uint8_t vtk_type = num_nodes == 3 ? 5 : num_nodes == 4 ? 10 : 13;
    const std::string file = path.string();
    const Index n = positions.cols();
    const Index m = cells.cols();
    for (Index c = 0; c < m; ++c) {
        require(cells.col(c).minCoeff() >= 0 && cells.col(c).maxCoeff() < n, file, ": cell ", c, " has vertices from ",
                cells.col(c).minCoeff(), " to ", cells.col(c).maxCoeff(), ", expected 0 to ", n - 1);
    }
    Connectivity<num_nodes> nodes = cells;
    if constexpr (num_nodes == 6) {
        nodes.row(1).swap(nodes.row(2));
        nodes.row(4).swap(nodes.row(5));
    }
    Eigen::Matrix<std::int64_t, 1, Eigen::Dynamic> ends(m);
    for (Index c = 0; c < m; ++c) {
        ends(c) = num_nodes * (c + 1);
    }
    const std::vector<std::uint8_t> types(std::size_t(m), vtk_type);
    const Matrix3X<float> points = positions.template cast<float>();

    detail::VtuContent content;
    constexpr bool is_little = std::endian::native == std::endian::little;
    content.xml =
        std::string("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"") +
        (is_little ? "LittleEndian" : "BigEndian") +
        "\" header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\"" + std::to_string(n) +
        "\" NumberOfCells=\"" + std::to_string(m) + "\">\n";
    content.append_fields(file, "PointData", fields.vertex_arrays, n);
    content.append_fields(file, "CellData", fields.cell_arrays, m);
    content.xml += "<Points>\n";
    content.append_matrix("Float32", "Points", points);
    content.xml += "</Points>\n<Cells>\n";
    content.append_array("Int32", "connectivity", 1, nodes.data(), std::size_t(nodes.size()) * sizeof(std::int32_t));
    content.append_matrix("Int64", "offsets", ends);
    content.append_array("UInt8", "types", 1, types.data(), types.size());
    content.xml += "</Cells>\n</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";

    AtomicFile output(path);
    output.write(content.xml);
    output.write(content.blocks);
    output.write("\n</AppendedData>\n</VTKFile>\n");
    output.commit();
}

}  // namespace softtissue
