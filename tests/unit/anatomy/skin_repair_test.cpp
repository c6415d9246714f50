// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/skin_repair.hpp>

#include <softtissue/anatomy/simulated_region.hpp>

#include <support/capsule_body.hpp>

#include <doctest/doctest.h>

using namespace softtissue;

namespace {

/// The middle half of a capsule, an open tube.
template <class S>
struct RepairTube {
    CapsuleBody<S> capsule;
    SimulatedRegion<S> region =
        make_simulated_region(capsule.positions, TriangleMesh(capsule.faces, capsule.positions.cols()), capsule.weights,
                              RegionOptions{JointGroups{{0}, {2}}, 0.5, {}});
    TriangleMesh mesh{region.triangles, region.num_vertices()};
    Matrix3X<S> skin = region.gather(capsule.positions);

    std::int32_t vertex(std::int32_t ring_from_middle, std::int32_t sector) const {
        return region
            .region_vertices[size_t(CapsuleBody<S>::vertex(CapsuleBody<S>::num_rings / 2 + ring_from_middle, sector))];
    }

    /// What holds after every successful repair.
    void check(const RepairedSkin<S>& repaired, Index most_moved) const {
        const SkinRepairOptions<S> options;
        CHECK(repaired.cosines.minCoeff() >= options.wanted_cosine);
        CHECK(repaired.crossings.empty());
        CHECK(inverse_corner_sines(repaired.positions, region.triangles).maxCoeff() * options.wanted_sine <= S(1));
        const Matrix3X<S> normals = triangle_normals(repaired.positions, region.triangles);
        Index moved = 0;
        for (Index v = 0; v < skin.cols(); ++v) {
            moved += repaired.positions.col(v) == skin.col(v) ? 0 : 1;
            const Matrix3X<S> incident = incident_columns<S>(mesh, normals, v);
            CHECK(smallest_cosine<S>(incident, repaired.directions.col(v)) == repaired.cosines(v));
            if (region.is_rim(v)) {
                CHECK(repaired.positions.col(v) == skin.col(v));
            }
        }
        CHECK(moved > 0);
        CHECK(moved <= most_moved);
    }
};

}  // namespace

TEST_CASE_TEMPLATE("a good skin stays as it is", S, float, double) {
    const RepairTube<S> tube;
    const RepairedSkin<S> repaired = repair_skin(tube.mesh, tube.skin);
    CHECK(repaired.rounds == 0);
    CHECK(repaired.positions == tube.skin);
    CHECK(repaired.crossings.empty());
    CHECK(repaired.cosines.minCoeff() > S(0.9));
}

TEST_CASE_TEMPLATE("a vertex folded over its neighbours moves back", S, float, double) {
    RepairTube<S> tube;
    tube.skin.col(tube.vertex(0, 0)) = tube.skin.col(tube.vertex(2, 0));
    tube.skin(0, tube.vertex(0, 0)) += S(0.001);
    tube.check(repair_skin(tube.mesh, tube.skin), 30);
}

TEST_CASE_TEMPLATE("a spike through the opposite wall is drawn back", S, float, double) {
    RepairTube<S> tube;
    tube.skin(0, tube.vertex(0, 0)) = S(-0.15);
    CHECK(!crossing_triangles<S>(tube.skin, tube.region.triangles).empty());
    tube.check(repair_skin(tube.mesh, tube.skin), 60);
}

TEST_CASE_TEMPLATE("walls that cross where every vertex has its cone come apart", S, float, double) {
    RepairTube<S> tube;
    // Two opposite dents with gentle slopes that meet beyond the axis.
    for (Index v = 0; v < tube.skin.cols(); ++v) {
        const S y = (tube.skin(1, v) - S(0.5)) / S(0.14);
        const S z = tube.skin(2, v) / S(0.1);
        const S shape = std::max(S(1) - y * y, S(0)) * std::max(S(1) - z * z, S(0));
        tube.skin(0, v) -= (tube.skin(0, v) > S(0) ? S(1) : S(-1)) * S(0.104) * shape;
    }
    const size_t before = crossing_triangles<S>(tube.skin, tube.region.triangles).size();
    CHECK(before > 0);
    const RepairedSkin<S> repaired = repair_skin(tube.mesh, tube.skin);
    CHECK(repaired.crossings.empty());
    CHECK(repaired.cosines.minCoeff() >= S(0.4));
}

TEST_CASE_TEMPLATE("a needle is opened", S, float, double) {
    RepairTube<S> tube;
    const Vector3<S> to = tube.skin.col(tube.vertex(0, 1));
    tube.skin.col(tube.vertex(0, 0)) += S(0.97) * (to - tube.skin.col(tube.vertex(0, 0)));
    tube.check(repair_skin(tube.mesh, tube.skin), 12);
}

TEST_CASE("the rounds end even where nothing helps, and the result says so") {
    RepairTube<double> tube;
    tube.skin.col(tube.vertex(0, 0)) = tube.skin.col(tube.vertex(2, 0));
    SkinRepairOptions<double> options;
    options.max_rounds = 1;
    const RepairedSkin<double> repaired = repair_skin(tube.mesh, tube.skin, options);
    CHECK(repaired.rounds == 1);
    CHECK(repaired.cosines.minCoeff() < options.wanted_cosine);
}
