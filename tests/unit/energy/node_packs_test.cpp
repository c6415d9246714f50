// SPDX-License-Identifier: MIT
#include <softtissue/energy/node_packs.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

TEST_CASE_TEMPLATE("each lane holds the nodes of its cell, those beyond the last cell repeat it", S, float, double) {
    constexpr int width = natural_lanes<S>;
    const Index num_vertices = 50;
    Matrix3X<S> x(3, num_vertices);
    for (Index k = 0; k < x.size(); ++k) {
        x.data()[k] = S(k);
    }
    for (const Index count : {1, 7, 16, 21}) {
        Connectivity<4> cells(4, count);
        for (Index k = 0; k < cells.size(); ++k) {
            cells.data()[k] = std::int32_t(k * 17 % num_vertices);
        }
        const NodePacks<4, width> nodes(cells);
        CHECK(nodes.num_cells() == count);
        REQUIRE(nodes.num_packs() == (count + width - 1) / width);
        for (Index p = 0; p < nodes.num_packs(); ++p) {
            const Eigen::Matrix<Pack<S, width>, 3, 4> gathered = nodes.gather(x, p);
            for (int i = 0; i < width; ++i) {
                const Index c = nodes.cell(p, i);
                CHECK(c == std::min(width * p + i, count - 1));
                for (int a = 0; a < 4; ++a) {
                    CHECK(lane<Pack<S, width>, 3, 4>(gathered, i).col(a) == x.col(cells(a, c)));
                }
            }
        }
    }
}

TEST_CASE("no cells, no packs") {
    CHECK(NodePacks<6, 8>(Connectivity<6>(6, 0)).num_packs() == 0);
}
