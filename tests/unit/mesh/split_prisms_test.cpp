// SPDX-License-Identifier: MIT
#include <softtissue/mesh/split_prisms.hpp>

#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <vector>

using namespace softtissue;

namespace {

/// Prisms between the octahedron |x| + |y| + |z| = 1 and its double, in one layer or two: without free sides.
CellMesh<Prism6, double> octahedron_layer(int num_layers, RandomGenerator& random) {
    Matrix3X<double> corners(3, 6);
    corners << 1, -1, 0, 0, 0, 0,  //
        0, 0, 1, -1, 0, 0,         //
        0, 0, 0, 0, 1, -1;
    Triangles triangles(3, 8);
    triangles << 0, 2, 1, 3, 2, 1, 3, 0,  //
        2, 1, 3, 0, 0, 2, 1, 3,           //
        4, 4, 4, 4, 5, 5, 5, 5;
    std::vector<std::int32_t> name(size_t(6 * (num_layers + 1)));  // vertices in random order
    std::iota(name.begin(), name.end(), 0);
    for (size_t i = name.size(); i-- > 1;) {
        std::swap(name[i], name[size_t(random.index(Index(i) + 1))]);
    }
    CellMesh<Prism6, double> mesh{Matrix3X<double>(3, Index(name.size())), Connectivity<6>(6, 8 * num_layers)};
    for (int level = 0; level <= num_layers; ++level) {
        for (int v = 0; v < 6; ++v) {
            mesh.rest_positions.col(name[size_t(6 * level + v)]) =
                (1 + 0.5 * level) * corners.col(v) + 0.05 * random_normal<Vector3<double>>(random);
        }
    }
    for (int level = 0; level < num_layers; ++level) {
        for (int t = 0; t < 8; ++t) {
            for (int k = 0; k < 3; ++k) {
                mesh.cells(k, 8 * level + t) = name[size_t(6 * level + triangles(k, t))];
                mesh.cells(k + 3, 8 * level + t) = name[size_t(6 * level + 6 + triangles(k, t))];
            }
        }
    }
    return mesh;
}

template <class ElementType>
double total_volume(const CellMesh<ElementType, double>& mesh) {
    double sum = 0;
    for (Index c = 0; c < mesh.num_cells(); ++c) {
        sum += ElementType::rest_volume(mesh.rest_nodes(c));
    }
    return sum;
}

/// How often each triangle occurs, by its sorted vertices.
std::map<std::array<std::int32_t, 3>, int> count_faces(const CellMesh<Tet4, double>& mesh) {
    std::map<std::array<std::int32_t, 3>, int> count;
    for (Index c = 0; c < mesh.num_cells(); ++c) {
        for (const ElementFace& face : Tet4::faces) {
            std::array<std::int32_t, 3> key{};
            for (size_t k = 0; k < 3; ++k) {
                key[k] = mesh.cells(face.nodes[k], c);
            }
            std::sort(key.begin(), key.end());
            ++count[key];
        }
    }
    return count;
}

}  // namespace

TEST_CASE("every numbering of a prism gives three positive tets that fill it") {
    Eigen::Matrix<double, 3, 6> X;
    X << 0, 1, 0, 0, 1, 0,  //
        0, 0, 1, 0, 0, 1,   //
        0, 0, 0, 1, 1, 1;
    std::array<int, 6> numbering{0, 1, 2, 3, 4, 5};
    do {
        CellMesh<Prism6, double> prism{Matrix3X<double>(3, 6), Connectivity<6>(6, 1)};
        for (int i = 0; i < 6; ++i) {
            prism.cells(i, 0) = numbering[size_t(i)];
            prism.rest_positions.col(numbering[size_t(i)]) = X.col(i);
        }
        const CellMesh<Tet4, double> tets = split_prisms(prism);
        REQUIRE(tets.num_cells() == 3);
        CHECK_NOTHROW(tets.validate());
        CHECK(total_volume(tets) == 0.5);
    } while (std::next_permutation(numbering.begin(), numbering.end()));
}

TEST_CASE("the diagonal of every side starts at its smallest vertex") {
    Eigen::Matrix<std::int32_t, 6, 1> prism;
    prism << 7, 3, 9, 8, 12, 5;
    const Eigen::Matrix<std::int32_t, 4, 3> tets = split_prism(prism);
    const auto has_edge = [&](std::int32_t a, std::int32_t b) {
        return ((tets.array() == a).colwise().any() && (tets.array() == b).colwise().any()).any();
    };
    CHECK(has_edge(3, 8));  // of 7 3 12 8
    CHECK_FALSE(has_edge(7, 12));
    CHECK(has_edge(3, 5));  // of 3 9 5 12
    CHECK_FALSE(has_edge(9, 12));
    CHECK(has_edge(9, 8) != has_edge(7, 5));
    CHECK(has_edge(7, 5));  // of 9 7 8 5
}

TEST_CASE("tets of neighbouring prisms share faces; a mesh without free sides keeps its volume") {
    RandomGenerator random(1);
    for (int sample = 0; sample < 50; ++sample) {
        const int num_layers = 1 + sample % 2;
        const CellMesh<Prism6, double> prisms = octahedron_layer(num_layers, random);
        REQUIRE_NOTHROW(prisms.validate());
        const CellMesh<Tet4, double> tets = split_prisms(prisms);
        REQUIRE_NOTHROW(tets.validate());
        CHECK(tets.rest_positions == prisms.rest_positions);
        REQUIRE(tets.num_cells() == tets_per_prism * prisms.num_cells());

        int boundary = 0;
        for (const auto& [face, count] : count_faces(tets)) {
            CHECK(count <= 2);
            boundary += count == 1 ? 1 : 0;
        }
        CHECK(boundary == 2 * 8);  // the inner and the outer octahedron
        CHECK(total_volume(tets) == doctest::Approx(total_volume(prisms)).epsilon(1e-14));
    }
}

TEST_CASE("the tets of prism c are 3c, 3c + 1 and 3c + 2") {
    RandomGenerator random(2);
    const CellMesh<Prism6, double> prisms = octahedron_layer(2, random);
    const CellMesh<Tet4, double> tets = split_prisms(prisms);
    for (Index t = 0; t < tets.num_cells(); ++t) {
        for (int k = 0; k < 4; ++k) {
            CHECK((prisms.cells.col(t / tets_per_prism).array() == tets.cells(k, t)).any());
        }
    }
}
