// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/thickness_guard.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace softtissue;

namespace {

/// A strip of quads, two triangles each, folded like a valley: two slopes that meet at x = 0, skin facing up.
template <class S>
struct Valley {
    static constexpr std::int32_t along = 21;  // vertices in x, from -1 to 1
    static constexpr std::int32_t across = 5;  // in y
    Matrix3X<S> skin{3, along* across};
    Matrix3X<S> directions{3, along* across};
    Triangles triangles{3, 2 * (along - 1) * (across - 1)};

    /// Directions point down and, on the slopes, `squeeze` towards x = 0.
    Valley(double slope, double squeeze) {
        Index t = 0;
        for (std::int32_t i = 0; i < along; ++i) {
            for (std::int32_t j = 0; j < across; ++j) {
                const std::int32_t v = i * across + j;
                const double x = -1 + 0.1 * i;
                skin.col(v) << S(x), S(0.1 * j), S(slope * std::abs(x));
                directions.col(v) = Vector3<S>(S(-squeeze * x), S(0), S(-1)).normalized();
                if (i + 1 < along && j + 1 < across) {
                    triangles.col(t++) << v, v + across, v + across + 1;
                    triangles.col(t++) << v, v + across + 1, v + 1;
                }
            }
        }
    }
};

}  // namespace

TEST_CASE_TEMPLATE("a thickness that is valid stays, one that is not is reduced where needed only", S, float, double) {
    const Valley<S> valley(0.5, 1.0);
    const TriangleMesh mesh(valley.triangles, valley.skin.cols());
    const LayerColumns<S> columns{valley.skin, valley.directions, 2};
    const ThicknessGuard<S> guard(mesh, columns, S(0.2));

    const VectorX<S> thin = VectorX<S>::Constant(mesh.num_vertices(), S(0.1));
    const GuardedThickness<S> kept = guard.reduce(thin);
    CHECK(kept.thickness == thin);
    CHECK(kept.rounds == 0);
    CHECK(kept.crossings_left == 0);

    // The columns meet about 1 below the skin: 2 is too much, except that nothing forbids it at the flat ends in y.
    const VectorX<S> thick = VectorX<S>::Constant(mesh.num_vertices(), S(2));
    const GuardedThickness<S> reduced = guard.reduce(thick);
    CHECK(reduced.rounds > 0);
    CHECK(reduced.thickness.maxCoeff() < S(2));
    CHECK(reduced.thickness.minCoeff() > S(0.4));
    for (Index t = 0; t < mesh.num_triangles(); ++t) {
        CHECK(guard.is_valid(t, reduced.thickness));
        CHECK(relative_jacobian<S>(columns, mesh.triangles().col(t), reduced.thickness) >= S(0.2));
    }
}

TEST_CASE("around a reduced column the thickness rises by the slope limit at most") {
    Valley<double> valley(0.0, 0.0);
    // One column leans over its neighbours.
    const std::int32_t leaning = 10 * valley.across + 2;
    valley.directions.col(leaning) = Vector3<double>(0.9, 0, -0.5).normalized();
    const TriangleMesh mesh(valley.triangles, valley.skin.cols());
    const LayerColumns<double> columns{valley.skin, valley.directions, 2};
    const ThicknessGuard<double> guard(mesh, columns, 0.2);
    const auto result = guard.reduce(VectorX<double>::Constant(mesh.num_vertices(), 0.4));
    CHECK(result.thickness(leaning) < 0.3);
    for (const TriangleMesh::Edge& edge : mesh.edges()) {
        const auto [v, w] = edge.vertices;
        const double length = (valley.skin.col(v) - valley.skin.col(w)).norm();
        CHECK(std::abs(result.thickness(v) - result.thickness(w)) <=
              ThicknessGuard<double>::max_slope * length * (1 + 1e-12));
    }
    CHECK(result.thickness(0) == 0.4);
}

TEST_CASE("an inner surface is kept from crossing another part of the skin") {
    // A second sheet 0.305 below, tilted, the first, facing up too: the layer of the upper one must end above it.
    const Valley<double> upper(0.0, 0.0);
    const Index n = upper.skin.cols();
    Matrix3X<double> skin(3, 2 * n);
    skin << upper.skin, upper.skin;
    skin.rightCols(n).row(2).array() -= 0.305;
    skin.rightCols(n).row(0) *= 0.53;  // no edge of one sheet inside an edge of the other
    skin.rightCols(n).row(1) = skin.rightCols(n).row(1).array() * 0.7 + 0.033;
    skin.rightCols(n).row(2) += 0.02 * skin.rightCols(n).row(0);
    Matrix3X<double> directions(3, 2 * n);
    directions << upper.directions, upper.directions;
    Triangles triangles(3, 2 * upper.triangles.cols());
    triangles << upper.triangles, (upper.triangles.array() + std::int32_t(n)).matrix();
    const TriangleMesh mesh(triangles, 2 * n);
    const LayerColumns<double> columns{skin, directions, 1};
    const ThicknessGuard<double> guard(mesh, columns, 0.2);
    VectorX<double> wanted = VectorX<double>::Constant(2 * n, 0.05);
    wanted.head(n).setConstant(0.3);
    const auto result = guard.reduce(wanted);
    CHECK(result.crossings_left == 0);
    CHECK(result.thickness.head(n).minCoeff() < 0.3);
    CHECK(result.thickness.tail(n) == wanted.tail(n));
}
