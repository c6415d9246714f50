// SPDX-License-Identifier: MIT
#include <softtissue/mesh/embedding.hpp>

#include "small_meshes.hpp"

#include <softtissue/core/thread_executor.hpp>
#include <softtissue/element/prism6.hpp>
#include <softtissue/element/tet4.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace softtissue;

namespace {

/// A cube of tets and two layers of leaning, uneven prisms on top of it, on one vertex array.
template <class S>
struct Block {
    CellMesh<Tet4, S> tets;
    CellMesh<Prism6, S> prisms;

    Block() {
        constexpr int n = 3;
        RandomGenerator random(3);
        const CellMesh<Tet4, double> cube = softtissue_test::make_cube(n, random);
        const softtissue_test::SquareMesh square = softtissue_test::make_square(n);
        const Index per_level = square.positions.cols();
        Matrix3X<double> positions(3, cube.num_vertices() + 2 * per_level);
        positions.leftCols(cube.num_vertices()) = cube.rest_positions;
        for (Index v = 0; v < 2 * per_level; ++v) {
            const Index below = cube.num_vertices() - per_level + v;
            positions.col(below + per_level) =
                positions.col(below) + Vector3<double>(0.1, 0.05, 0.2) + 0.02 * random_normal<Vector3<double>>(random);
        }
        tets = {cube.rest_positions.cast<S>(), cube.cells};
        prisms.rest_positions = positions.cast<S>();
        prisms.cells.resize(6, 2 * square.triangles.cols());
        for (Index c = 0; c < prisms.num_cells(); ++c) {
            const Eigen::Matrix<std::int32_t, 3, 1> triangle = square.triangles.col(c / 2);
            const auto lower = std::int32_t(cube.num_vertices() + (c % 2 - 1) * per_level);
            prisms.cells.col(c) << triangle.array() + lower, triangle.array() + lower + std::int32_t(per_level);
        }
        prisms.validate();
        tets.validate();
    }

    Index num_cells() const { return prisms.num_cells() + tets.num_cells(); }

    Matrix3X<S> deformed(std::uint64_t seed) const {
        RandomGenerator random(seed);
        Matrix3X<S> x = prisms.rest_positions;
        for (Index v = 0; v < x.cols(); ++v) {
            x.col(v) += S(0.1) * random_normal<Vector3<S>>(random);
        }
        return x;
    }
};

/// Natural coordinates inside the cell, at least 1 % away from its boundary.
template <class S>
Vector3<S> random_inside(RandomGenerator& random, bool is_prism) {
    Vector3<double> xi;
    do {
        xi = Vector3<double>(random.uniform(0.01, 1), random.uniform(0.01, 1), random.uniform(0.01, 1));
    } while (xi(0) + xi(1) + (is_prism ? 0.0 : xi(2)) > 0.99);
    if (is_prism) {
        xi(2) = 0.99 * (2 * xi(2) - 1);
    }
    return xi.cast<S>();
}

/// Points in known cells: where they are at rest, and at the positions x.
template <class S>
struct KnownPoints {
    std::vector<std::int32_t> cells;
    Matrix3X<S> rest;
    Matrix3X<S> current;

    KnownPoints(const Block<S>& block, const Matrix3X<S>& x, Index count) : rest(3, count), current(3, count) {
        RandomGenerator random(8);
        for (Index p = 0; p < count; ++p) {
            const Index c = random.index(block.num_cells());
            cells.push_back(std::int32_t(c));
            const auto put = [&](const auto& mesh, Index cell) {
                using E = typename std::remove_cvref_t<decltype(mesh)>::CellElement;
                const Vector3<S> xi = random_inside<S>(random, std::is_same_v<E, Prism6>);
                rest.col(p) = E::position(mesh.rest_nodes(cell), xi);
                current.col(p) = E::position(mesh.gather(x, mesh.cells.col(cell)), xi);
            };
            if (c < block.prisms.num_cells()) {
                put(block.prisms, c);
            } else {
                put(block.tets, c - block.prisms.num_cells());
            }
        }
    }
};

template <class S>
Matrix3X<S> apply(const Embedding<S>& embedding, const Matrix3X<S>& x) {
    Matrix3X<S> out(3, embedding.num_points());
    embedding.apply_into(x, out);
    return out;
}

template <class S>
S largest(const Matrix3X<S>& difference) {
    return difference.colwise().norm().maxCoeff();
}

/// Points in and around the block, up to 1 m outside.
template <class S>
Matrix3X<S> points_around(Index count) {
    RandomGenerator random(9);
    Matrix3X<S> points(3, count);
    for (Index p = 0; p < count; ++p) {
        points.col(p) << S(random.uniform(-1, 2)), S(random.uniform(-1, 2)), S(random.uniform(-1, 2.4));
    }
    return points;
}

// Rounding of the inverse map in cells of size 1/3: some 30 operations on coordinates up to 1.4, over the cell's size.
template <class S>
constexpr S rounding = S(400) * std::numeric_limits<S>::epsilon();

}  // namespace

TEST_CASE_TEMPLATE("points inside are found in their cell and follow its shape functions", S, float, double) {
    const Block<S> block;
    const Matrix3X<S> x = block.deformed(1);
    const KnownPoints<S> known(block, x, 400);
    const Embedding<S> embedding(known.rest, block.prisms, block.tets);
    CHECK(embedding.num_points() == 400);
    CHECK(embedding.num_vertices() == x.cols());
    CHECK(embedding.cells() == known.cells);
    CHECK(embedding.report().num_outside == 0);
    CHECK(embedding.report().farthest_point == -1);
    CHECK(embedding.distances().maxCoeff() == S(0));
    CHECK(embedding.weights().minCoeff() >= S(0));
    CHECK((embedding.weights().colwise().sum().array() - S(1)).abs().maxCoeff() <= rounding<S>);
    CHECK(largest<S>(apply(embedding, block.prisms.rest_positions) - known.rest) <= rounding<S>);
    CHECK(largest<S>(apply(embedding, x) - known.current) <= rounding<S>);
}

TEST_CASE_TEMPLATE("vertices, edges and faces move with their nodes, whichever cell they fall to", S, float, double) {
    const Block<S> block;
    const Matrix3X<S>& X = block.prisms.rest_positions;
    const Matrix3X<S> x = block.deformed(2);
    std::vector<std::vector<std::int32_t>> groups;
    for (std::int32_t v = 0; v < X.cols(); ++v) {
        groups.push_back({v});
    }
    const auto add_cells = [&](const auto& mesh) {
        using E = typename std::remove_cvref_t<decltype(mesh)>::CellElement;
        for (Index c = 0; c < mesh.num_cells(); ++c) {
            for (const ElementFace& face : E::faces) {
                std::vector<std::int32_t> corners;
                for (int k = 0; k < face.num_nodes; ++k) {
                    corners.push_back(mesh.cells(face.nodes[size_t(k)], c));
                }
                groups.push_back(corners);
                groups.push_back({corners[0], corners[1]});
            }
        }
    };
    add_cells(block.prisms);
    add_cells(block.tets);
    const auto middles = [&](const Matrix3X<S>& positions) {
        Matrix3X<S> points = Matrix3X<S>::Zero(3, Index(groups.size()));
        for (std::size_t g = 0; g < groups.size(); ++g) {
            for (const std::int32_t v : groups[g]) {
                points.col(Index(g)) += positions.col(v) / S(groups[g].size());
            }
        }
        return points;
    };
    const Embedding<S> embedding(middles(X), block.prisms, block.tets);
    CHECK(embedding.report().num_outside == 0);
    CHECK(largest<S>(apply(embedding, x) - middles(x)) <= rounding<S>);
}

TEST_CASE_TEMPLATE("points outside go to the nearest cell and follow affine motions", S, float, double) {
    const Block<S> block;
    const Matrix3X<S> points = points_around<S>(300);
    const Embedding<S> embedding(points, block.prisms, block.tets);
    Index num_outside = 0;
    S largest_distance(0);
    for (Index p = 0; p < points.cols(); ++p) {
        S nearest = std::numeric_limits<S>::infinity();
        for (Index c = 0; c < block.prisms.num_cells(); ++c) {
            nearest = std::min(
                nearest, closest_point_in_cell<Prism6, S>(block.prisms.rest_nodes(c), points.col(p)).squared_distance);
        }
        for (Index c = 0; c < block.tets.num_cells(); ++c) {
            nearest = std::min(
                nearest, closest_point_in_cell<Tet4, S>(block.tets.rest_nodes(c), points.col(p)).squared_distance);
        }
        CHECK(std::abs(embedding.distances()(p) - std::sqrt(nearest)) <= rounding<S>);
        num_outside += nearest > S(0) ? 1 : 0;
        largest_distance = std::max(largest_distance, std::sqrt(nearest));
    }
    CHECK(num_outside > 200);
    CHECK(embedding.report().num_outside == num_outside);
    CHECK(std::abs(embedding.report().largest_distance - largest_distance) <= rounding<S>);
    CHECK(embedding.distances()(embedding.report().farthest_point) == embedding.report().largest_distance);

    RandomGenerator random(4);
    const Matrix3<S> A = random_normal<Matrix3<S>>(random);
    const Vector3<S> t = random_normal<Vector3<S>>(random);
    const Matrix3X<S> moved = (A * block.prisms.rest_positions).colwise() + t;
    const Matrix3X<S> expected = (A * points).colwise() + t;
    const S amplification = embedding.weights().cwiseAbs().colwise().sum().maxCoeff();
    CHECK(amplification < S(40));  // 1.2 m outside cells of 0.15 to 0.3 m
    CHECK(largest<S>(apply(embedding, moved) - expected) <= amplification * rounding<S>);
}

TEST_CASE("the motion is continuous through the boundary and linear beyond it") {
    const Block<double> block;
    const Matrix3X<double> x = block.deformed(3);
    constexpr Index steps = 400;
    const Prism6::Nodes<double> X = block.prisms.rest_nodes(1);  // of the upper layer
    const Vector3<double> middle = (X.col(3) + X.col(4) + X.col(5)) / 3;
    const Vector3<double> normal = (X.col(4) - X.col(3)).cross(X.col(5) - X.col(3)).normalized();
    Matrix3X<double> points(3, steps);
    for (Index k = 0; k < steps; ++k) {
        points.col(k) = middle + normal * (0.1 * double(k - steps / 2) / (steps / 2));
    }
    const Embedding<double> embedding(points, block.prisms);
    CHECK(embedding.report().num_outside == steps / 2 - 1);
    const Matrix3X<double> y = apply(embedding, x);
    const double step = 0.1 / (steps / 2);
    for (Index k = 1; k < steps; ++k) {
        CAPTURE(k);
        // Vertices move by 0.1 over thicknesses of 0.2.
        CHECK((y.col(k) - y.col(k - 1)).norm() <= 3 * step);
    }
    for (Index k = steps / 2 + 1; k + 1 < steps; ++k) {
        CHECK((y.col(k - 1) - 2 * y.col(k) + y.col(k + 1)).norm() <= 1e-13);
    }
}

TEST_CASE("a layer of a millimetre a metre away keeps a micrometre in float") {
    CellMesh<Prism6, float> mesh{Matrix3X<float>(3, 6), Connectivity<6>(6, 1)};
    mesh.rest_positions << 1, 1.02F, 1, 1, 1.02F, 1,  //
        1, 1, 1.02F, 1, 1, 1.02F,                     //
        1, 1, 1, 1.001F, 1.001F, 1.001F;
    mesh.cells << 0, 1, 2, 3, 4, 5;
    Matrix3X<float> points(3, 3);
    points << 1.005F, 1.01F, 1.001F,  //
        1.005F, 1.002F, 1.001F,       //
        1.0003F, 1.0009F, 1.004F;
    const Embedding<float> embedding(points, mesh);
    CHECK(embedding.report().num_outside == 1);
    CHECK(embedding.report().farthest_point == 2);
    CHECK(embedding.report().largest_distance == doctest::Approx(0.003).epsilon(1e-3));
    CHECK(largest<float>(apply(embedding, mesh.rest_positions) - points) <= 1e-6F);
}

TEST_CASE("found in double, applied in float") {
    const Block<double> block;
    const Matrix3X<double> points = points_around<double>(100);
    const Embedding<double> embedding(points, block.prisms, block.tets);
    const Embedding<float> single = embedding.cast<float>();
    const Matrix3X<double> x = block.deformed(4);
    CHECK(single.report().num_outside == embedding.report().num_outside);
    CHECK(single.cells() == embedding.cells());
    CHECK(largest<float>(apply<float>(single, x.cast<float>()) - apply(embedding, x).cast<float>()) <= 1e-4F);
}

TEST_CASE("the same bits for any number of threads, and no allocation in a frame") {
    const Block<float> block;
    const Matrix3X<float> points = points_around<float>(200);
    const Matrix3X<float> x = block.deformed(5);
    const Embedding<float> one(points, block.prisms, block.tets);
    Matrix3X<float> expected(3, 200);
    Eigen::internal::set_is_malloc_allowed(false);
    one.apply_into(x, expected);
    Eigen::internal::set_is_malloc_allowed(true);
    for (const int threads : {2, 7}) {
        const ThreadExecutor executor(threads);
        const Embedding<float> many(points, block.prisms, block.tets, executor);
        CHECK(many.indices() == one.indices());
        CHECK(many.weights() == one.weights());
        Matrix3X<float> out(3, 200);
        many.apply_into(x, out, executor);
        CHECK(out == expected);
    }
}

TEST_CASE_TEMPLATE(
    "every point is the weighted sum of its nodes, in arrays of any stride, next to which nothing changes", S, float,
    double) {
    const Block<S> block;
    Matrix3X<S> points = points_around<S>(60);
    const Index last = block.prisms.num_vertices() - 1;
    for (const Index p : {0, 7, 8, 59}) {
        points.col(p) = block.prisms.rest_positions.col(last);  // what is read there must not reach beyond the array
    }
    const Embedding<S> embedding(points, block.prisms, block.tets);
    CHECK(embedding.indices().col(59).maxCoeff() == last);
    const Matrix3X<S> x = block.deformed(6);
    const Matrix3X<S> y = apply<S>(embedding, x);
    MatrixX<S> wide_x = MatrixX<S>::Constant(4, x.cols(), S(7)), wide_y = MatrixX<S>::Constant(4, 60, S(7));
    wide_x.topRows(3) = x;
    embedding.apply_into(wide_x.topRows(3), wide_y.topRows(3));
    CHECK(wide_y.topRows(3) == y);
    CHECK((wide_y.row(3).array() == S(7)).all());
    MatrixX<S> part = MatrixX<S>::Constant(3, 62, S(7));
    embedding.apply_into(x, part.middleCols(1, 60));
    CHECK(part.middleCols(1, 60) == y);
    CHECK((part.col(61).array() == S(7)).all());
    for (Index p = 0; p < 60; ++p) {
        Vector3<S> sum = Vector3<S>::Zero();
        for (int i = 0; i < 6; ++i) {
            sum += embedding.weights()(i, p) * x.col(embedding.indices()(i, p));
        }
        CHECK((sum - y.col(p)).cwiseAbs().maxCoeff() <= S(8) * std::numeric_limits<S>::epsilon() *
                                                            x.cwiseAbs().maxCoeff() *
                                                            embedding.weights().col(p).cwiseAbs().sum());
    }
}

TEST_CASE("no points are no trouble") {
    const Block<double> block;
    const Embedding<double> embedding(Matrix3X<double>(3, 0), block.tets);
    CHECK(embedding.num_points() == 0);
    CHECK(apply(embedding, block.tets.rest_positions).cols() == 0);
    CHECK(Embedding<double>().num_points() == 0);
}

TEST_CASE("what cannot be embedded is refused") {
    Block<double> block;
    Matrix3X<double> points = points_around<double>(20);
    points(1, 13) = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_WITH_AS(Embedding<double>(points, block.tets), "embedding: point 13 is not finite", InvalidInput);
    points(1, 13) = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH_AS(Embedding<double>(points, block.prisms, block.tets), "embedding: point 13 is not finite",
                         InvalidInput);
    points(1, 13) = 0;
    CellMesh<Tet4, double> empty{block.tets.rest_positions, Connectivity<4>(4, 0)};
    CHECK_THROWS_WITH_AS(Embedding<double>(points, empty), "embedding: the mesh has no cells", InvalidInput);
    CHECK_NOTHROW(Embedding<double>(points, block.prisms, empty));
    CellMesh<Tet4, double> turned = block.tets;
    turned.cells.col(2).head<2>().reverseInPlace();
    CHECK_THROWS_AS(Embedding<double>(points, turned), InvalidInput);
    block.tets.rest_positions(2, 5) += 0.001;
    CHECK_THROWS_WITH_AS(Embedding<double>(points, block.prisms, block.tets),
                         "embedding: vertex 5 of the prisms and of the tets differ by 0.001 m, expected one common "
                         "numbering",
                         InvalidInput);
}
