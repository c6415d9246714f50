// SPDX-License-Identifier: MIT
#include <softtissue/energy/rest_packs.hpp>

#include <support/solid_block.hpp>

#include <doctest/doctest.h>

#include <utility>

using namespace softtissue;
using namespace softtissue_test;

TEST_CASE_TEMPLATE("cells come back from their lanes, the last one repeated", Types, std::pair<Tet4, double>,
                   std::pair<Prism6, float>) {
    using E = typename Types::first_type;
    using S = typename Types::second_type;
    using Rest = RestPacks<E, S>;
    auto mesh = solid_block<E, S>({.n = 2, .noise = 0.1}).mesh;
    const Index count = mesh.num_cells() - 1;  // 15 prisms, 47 tets: no multiple of any width but 1
    mesh.cells.conservativeResize(Eigen::NoChange, count);
    const auto plain = RestOperators<E, S>::at(mesh, mesh.rest_positions);
    Rest rest(plain);
    CHECK(rest.num_cells() == count);
    CHECK(rest.num_packs() == (count + Rest::width - 1) / Rest::width);
    CHECK(rest.cell(0, 0) == 0);
    CHECK(rest.cell(rest.num_packs() - 1, Rest::width - 1) == count - 1);

    const auto lanes_hold_their_cells = [&] {
        bool all_same = true;
        for (Index pack = 0; pack < rest.num_packs(); ++pack) {
            const NodePositions<E, typename Rest::Lanes> gradients = rest.packed_gradients(pack);
            const auto references = rest.packed_reference_gradient(pack);
            for (int i = 0; i < Rest::width; ++i) {
                const Index c = rest.cell(pack, i);
                all_same = all_same && rest.packed_volume(pack)[i] == rest.volume(c) &&
                           lane(gradients, i) == rest.gradients(c) && lane(references, i) == rest.reference_gradient(c);
            }
        }
        return all_same;
    };
    bool all_same = true;
    for (Index c = 0; c < count; ++c) {
        all_same = all_same && rest.volume(c) == plain.volumes(c) && rest.gradients(c) == plain.cell_gradients(c) &&
                   rest.reference_gradient(c) == Matrix3<S>::Identity();
    }
    CHECK(all_same);
    CHECK(lanes_hold_their_cells());

    const Matrix3<S> F0 = Matrix3<S>::Constant(S(3));
    rest.set_reference_gradient(count - 1, F0);
    rest.set_cell(count - 1, S(2) * plain.cell_gradients(count - 1), S(7));
    rest.set_cell(3, -plain.cell_gradients(3), S(5));
    const bool only_the_last_changed =
        rest.reference_gradient(count - 1) == F0 && rest.reference_gradient(0) == Matrix3<S>::Identity();
    CHECK(only_the_last_changed);
    CHECK(rest.volume(3) == S(5));
    CHECK(rest.volume(count - 1) == S(7));
    CHECK(lanes_hold_their_cells());
}
