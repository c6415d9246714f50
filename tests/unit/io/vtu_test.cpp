// SPDX-License-Identifier: MIT
#include <softtissue/io/vtu.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

/// What follows `key="` up to the quote, after position `from`.
std::string attribute(const std::string& xml, std::size_t from, const std::string& key) {
    const std::size_t first = xml.find(key + "=\"", from) + key.size() + 2;
    return xml.substr(first, xml.find('"', first) - first);
}

/// The values of the array called `name`, found through its offset.
template <class T>
std::vector<T> values(const std::string& file, const std::string& name) {
    const std::size_t element = file.find("Name=\"" + name + "\"");
    REQUIRE(element != std::string::npos);
    const std::size_t data = file.find("<AppendedData encoding=\"raw\">\n_") + 31;
    const std::size_t block = data + std::stoul(attribute(file, element, "offset"));
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, file.data() + block, sizeof(bytes));
    std::vector<T> result(bytes / sizeof(T));
    REQUIRE(block + sizeof(bytes) + bytes <= file.size());
    std::memcpy(result.data(), file.data() + block + sizeof(bytes), bytes);
    return result;
}

/// Opens and closes the tags of `xml` one after the other; the names of those left open, innermost last.
std::vector<std::string> open_tags(const std::string& xml) {
    std::vector<std::string> open;
    for (std::size_t at = xml.find('<'); at != std::string::npos; at = xml.find('<', at + 1)) {
        const std::string tag = xml.substr(at + 1, xml.find('>', at) - at - 1);
        if (tag[0] == '/') {
            REQUIRE(!open.empty());
            CHECK(open.back() == tag.substr(1));
            open.pop_back();
        } else if (tag[0] != '?' && tag.back() != '/') {
            open.push_back(tag.substr(0, tag.find(' ')));
        }
    }
    return open;
}

template <class Scalar>
Matrix3X<Scalar> prism_positions() {
    return (Matrix3X<Scalar>(3, 6) << 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 1, 1).finished();
}

const Connectivity<6> one_prism = (Connectivity<6>(6, 1) << 0, 1, 2, 3, 4, 5).finished();

}  // namespace

TEST_CASE_TEMPLATE("tets, positions and arrays come back", S, float, double) {
    const TemporaryFolder folder;
    const Matrix3X<S> x = prism_positions<S>();
    const Connectivity<4> tets = (Connectivity<4>(4, 2) << 0, 1, 1, 2, 2, 4, 3, 5).finished();
    VtuFields fields;
    fields.vertex_arrays = {{"displacement", MatrixX<float>::Constant(3, 6, 0.5F)},
                            {"height <m>", MatrixX<float>::Ones(1, 6)}};
    fields.cell_arrays = {{"J", (MatrixX<float>(1, 2) << 1.0F, std::numeric_limits<float>::quiet_NaN()).finished()}};
    write_vtu(folder / "a.vtu", x, tets, fields);
    CHECK(folder.num_files() == 1);
    const std::string file = read_bytes(folder / "a.vtu");

    const std::size_t data = file.find("<AppendedData");
    CHECK(open_tags(file.substr(0, data)) == std::vector<std::string>{"VTKFile"});
    CHECK(file.ends_with("\n</AppendedData>\n</VTKFile>\n"));
    CHECK(attribute(file, 0, "NumberOfPoints") == "6");
    CHECK(attribute(file, 0, "NumberOfCells") == "2");

    const std::vector<float> points = values<float>(file, "Points");
    CHECK(Matrix3X<float>(Eigen::Map<const Matrix3X<float>>(points.data(), 3, 6)) == x.template cast<float>());
    CHECK(values<std::int32_t>(file, "connectivity") == std::vector<std::int32_t>{0, 1, 2, 3, 1, 2, 4, 5});
    CHECK(values<std::int64_t>(file, "offsets") == std::vector<std::int64_t>{4, 8});
    CHECK(values<std::uint8_t>(file, "types") == std::vector<std::uint8_t>{10, 10});
    CHECK(values<float>(file, "displacement") == std::vector<float>(18, 0.5F));
    CHECK(values<float>(file, "height &lt;m&gt;") == std::vector<float>(6, 1.0F));
    CHECK(values<float>(file, "J")[0] == 1.0F);
    CHECK(attribute(file, file.find("Name=\"displacement\""), "NumberOfComponents") == "3");
    CHECK(file.find("displacement") < file.find("</PointData>"));
    CHECK(file.find("Name=\"J\"") > file.find("<CellData>"));
}

TEST_CASE("prisms are turned into VTK's wedges, whose first triangle faces away from the second") {
    const TemporaryFolder folder;
    const Matrix3X<double> x = prism_positions<double>();
    write_vtu(folder / "a.vtu", x, one_prism);
    const std::string file = read_bytes(folder / "a.vtu");
    CHECK(values<std::uint8_t>(file, "types") == std::vector<std::uint8_t>{13});
    const std::vector<std::int32_t> wedge = values<std::int32_t>(file, "connectivity");
    REQUIRE(wedge.size() == 6);
    const auto node = [&](std::size_t i) -> Vector3<double> { return x.col(wedge[i]); };
    const Vector3<double> normal = (node(1) - node(0)).cross(node(2) - node(0));
    CHECK(normal.dot(node(3) - node(0)) < 0.0);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(wedge[i + 3] == wedge[i] + 3);  // the edges between the triangles are kept
    }
}

TEST_CASE("triangles are written as triangles") {
    const TemporaryFolder folder;
    write_vtu(folder / "a.vtu", prism_positions<double>(), Triangles(Eigen::Vector3i(0, 1, 2)));
    CHECK(values<std::uint8_t>(read_bytes(folder / "a.vtu"), "types") == std::vector<std::uint8_t>{5});
}

TEST_CASE("what does not fit is refused, and no file appears") {
    const TemporaryFolder folder;
    const auto refused = [&](const Connectivity<6>& cells, const VtuFields& fields) {
        return refusal([&] { write_vtu(folder / "a.vtu", prism_positions<double>(), cells, fields); });
    };
    CHECK(contains(refused(one_prism, {{{"u", MatrixX<float>::Zero(3, 5)}}, {}}),
                   "a.vtu: PointData array 'u' is 3 x 5, expected 6 columns"));
    CHECK(contains(refused(one_prism, {{}, {{"J", MatrixX<float>::Zero(1, 6)}}}),
                   "CellData array 'J' is 1 x 6, expected 1 columns"));
    Connectivity<6> outside = one_prism;
    outside(3, 0) = 6;
    CHECK(contains(refused(outside, {}), "a.vtu: cell 0 has vertices from 0 to 6, expected 0 to 5"));
    CHECK(folder.num_files() == 0);
}
