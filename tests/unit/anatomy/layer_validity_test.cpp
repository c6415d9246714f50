// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/layer_validity.hpp>

#include <softtissue/element/prism6.hpp>
#include <softtissue/mesh/cell_mesh.hpp>
#include <softtissue/mesh/prism_layers.hpp>
#include <softtissue/mesh/split_prisms.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

template <class S>
struct OneTriangle {
    Matrix3X<S> skin{3, 3};
    Matrix3X<S> directions{3, 3};
    VectorX<S> thickness{3};
    Vector3<std::int32_t> triangle{0, 1, 2};

    /// Skin in the plane z = 0 facing up, directions down and tilted.
    OneTriangle(RandomGenerator& random, double tilt) {
        skin << 0, 1, S(0.3), 0, 0, 1, 0, 0, 0;
        for (Index i = 0; i < 3; ++i) {
            directions.col(i) =
                Vector3<S>(S(random.uniform(-tilt, tilt)), S(random.uniform(-tilt, tilt)), S(-1)).normalized();
            thickness(i) = S(random.uniform(0.1, 2));
        }
        // Any numbering and any start must do, with the same orientation.
        const int start = int(random.index(3));
        const bool swap = random.uniform() < 0.5;
        if (swap) {
            skin.col(1).swap(skin.col(2));
            triangle << 0, 2, 1;
        }
        const Vector3<std::int32_t> original = triangle;
        for (int k = 0; k < 3; ++k) {
            triangle(k) = original((k + start) % 3);
        }
    }

    S relative(Index num_layers) const {
        const LayerColumns<S> columns{skin, directions, num_layers};
        return relative_jacobian<S>(columns, triangle, thickness);
    }

    CellMesh<Prism6, S> mesh(Index num_layers) const {
        const PrismLayers layers{3, num_layers};
        const LayerColumns<S> columns{skin, directions, num_layers};
        CellMesh<Prism6, S> result;
        result.cells = layers.prisms(triangle);
        result.rest_positions.resize(3, layers.num_vertices());
        for (Index i = 0; i < 3; ++i) {
            for (Index level = 0; level <= num_layers; ++level) {
                result.rest_positions.col(layers.vertex(i, level)) =
                    columns.position(std::int32_t(i), thickness(i), S(1) - S(level) / S(num_layers));
            }
        }
        return result;
    }
};

}  // namespace

TEST_CASE_TEMPLATE("positive proves the prisms and the tets of their split valid", S, float, double) {
    RandomGenerator random(21);
    int positive = 0;
    int negative = 0;
    for (int sample = 0; sample < 400; ++sample) {
        const OneTriangle<S> cell(random, 0.8);
        for (const Index num_layers : {1, 2, 3}) {
            const CellMesh<Prism6, S> prisms = cell.mesh(num_layers);
            const CellMesh<Tet4, S> tets = split_prisms(prisms);
            if (cell.relative(num_layers) > S(1e-4)) {
                ++positive;
                CHECK(prisms.count_inverted(prisms.rest_positions) == 0);
                CHECK(tets.count_inverted(tets.rest_positions) == 0);
            } else if (cell.relative(num_layers) < S(-1e-4)) {
                ++negative;
                // With one layer the measure is also necessary for what the bound and the tets can prove.
                if (num_layers == 1) {
                    CHECK(prisms.count_inverted(prisms.rest_positions) + tets.count_inverted(tets.rest_positions) > 0);
                }
            }
        }
    }
    CHECK(positive > 100);
    CHECK(negative > 100);
}

TEST_CASE_TEMPLATE("tends to one with the thickness, whatever its scale and tilt", S, float, double) {
    RandomGenerator random(4);
    for (int sample = 0; sample < 50; ++sample) {
        OneTriangle<S> cell(random, 3.0);
        cell.thickness *= S(1e-3);
        // Corrections are of the order of thickness times tilt over the triangle's size: 2e-3 x 4.4 / 0.9.
        CHECK(std::abs(cell.relative(2) - S(1)) < S(0.05));
    }
}

TEST_CASE("-1 where a direction leaves the skin on the outside") {
    RandomGenerator random(8);
    OneTriangle<double> cell(random, 0.1);
    cell.directions.col(1) << 0, 0, 1;
    CHECK(cell.relative(2) == -1.0);
}
