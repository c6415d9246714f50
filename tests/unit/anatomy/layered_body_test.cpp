// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/layered_body.hpp>

#include <support/capsule_body.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

using namespace softtissue;

namespace {

/// The cylindrical part of a capsule, and the tube of half its radius in it.
template <class S>
struct NestedTubes {
    CapsuleBody<S> capsule;
    SimulatedRegion<S> region =
        make_simulated_region(capsule.positions, TriangleMesh(capsule.faces, capsule.positions.cols()), capsule.weights,
                              RegionOptions{JointGroups{{0}, {2}}, 0.5, {}});
    Matrix3X<S> outer = region.gather(capsule.positions);
    Matrix3X<S> inner = outer;
    Matrix3X<S> inverse_sines = inverse_corner_sines(outer, region.triangles);
    double height = double(outer.row(1).maxCoeff() - outer.row(1).minCoeff());

    NestedTubes() {
        inner.row(0) *= S(0.5);
        inner.row(2) *= S(0.5);
    }

    /// Area of the regular polygon of 16 corners.
    static double area(double radius) { return 8 * radius * radius * std::sin(std::numbers::pi / 8); }
};

}  // namespace

TEST_CASE_TEMPLATE("the volume of an open tube with its openings closed", S, float, double) {
    const NestedTubes<S> tubes;
    const auto volume = [&](const Matrix3X<S>& positions) {
        return double(capped_volume(positions, tubes.region.triangles, tubes.region.loops));
    };
    const double epsilon = 256 * double(std::numeric_limits<S>::epsilon());
    CHECK(volume(tubes.outer) == doctest::Approx(tubes.area(0.1) * tubes.height).epsilon(epsilon));
    CHECK(volume(tubes.inner) == doctest::Approx(tubes.area(0.05) * tubes.height).epsilon(epsilon));
}

TEST_CASE_TEMPLATE("a layer is measured", S, float, double) {
    const NestedTubes<S> tubes;
    const LayerReport<S> layer = measure_layer(tubes.region.triangles, tubes.inner, tubes.outer, tubes.inverse_sines);
    const double epsilon = 256 * double(std::numeric_limits<S>::epsilon());
    CHECK(layer.inverted_cells == 0);
    CHECK(layer.crossings == 0);
    CHECK(layer.thinnest == doctest::Approx(0.05).epsilon(epsilon));
    CHECK(layer.thickest == doctest::Approx(0.05).epsilon(epsilon));
    const double expected = (tubes.area(0.1) - tubes.area(0.05)) * tubes.height;
    CHECK(layer.volume == doctest::Approx(expected).epsilon(epsilon));
    CHECK(layer.smallest_relative_coefficient > S(0.5));
    CHECK(layer.smallest_scaled_jacobian > S(0.3));
    const LayerReport<S> reversed =
        measure_layer(tubes.region.triangles, tubes.outer, tubes.inner, tubes.inverse_sines);
    CHECK(reversed.inverted_cells == tubes.region.num_triangles());
    CHECK(reversed.smallest_scaled_jacobian < S(0));
    CHECK(reversed.smallest_relative_coefficient < S(0));
}

TEST_CASE("the weights of a column are those of its vertices") {
    LayeredBody<double> body;
    body.layers.num_columns = 2;
    MatrixX<double> dense(6, 3);
    dense.topRows(3).rowwise() = Eigen::RowVector3d(0.25, 0.75, 0);
    dense.bottomRows(3).rowwise() = Eigen::RowVector3d(0, 0, 1);
    body.weights = SkinningWeights<double>(dense);
    const MatrixX<double> columns = body.column_weights().dense();
    REQUIRE(columns.rows() == 2);
    CHECK(columns.row(0) == dense.row(0));
    CHECK(columns.row(1) == dense.row(5));
}

TEST_CASE("options out of range are refused") {
    LayeredBodyOptions<double> options;
    const auto message = [&] {
        try {
            options.validate(10);
        } catch (const InvalidInput& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    CHECK(message() == "accepted");
    SUBCASE("length") {
        options.cut_fat = 0;
        CHECK(message() == "layered body: cut_fat = 0, expected > 0");
    }
    SUBCASE("not a number") {
        options.decay_distance = std::numeric_limits<double>::quiet_NaN();
        CHECK(message() == "layered body: decay_distance = nan, expected > 0");
    }
    SUBCASE("threshold") {
        options.cleanup.threshold = -1;
        CHECK(message() == "layered body: cleanup.threshold = -1, expected > 0");
    }
    SUBCASE("fraction") {
        options.cleanup.largest_fat_fraction = 1;
        CHECK(message() == "layered body: cleanup.largest_fat_fraction = 1, expected a value between 0 and 1");
    }
    SUBCASE("rounds") {
        options.weight_rounds = -1;
        CHECK(message() == "layered body: rounds of smoothing 10 and -1, expected >= 0");
    }
    SUBCASE("not finite") {
        options.cut_fat = std::numeric_limits<double>::infinity();
        CHECK(message() == "layered body: cut_fat = inf, expected > 0");
    }
    SUBCASE("share") {
        options.accepted_share = std::numeric_limits<double>::quiet_NaN();
        CHECK(message() == "layered body: accepted_share = nan, expected 0 to 1");
    }
    SUBCASE("size of a map") {
        options.fat_thickness.setConstant(3, 0.01);
        CHECK(message() ==
              "layered body: 3 values of fat_thickness, expected one for each of the 10 vertices of the body, or none");
    }
    SUBCASE("value of a map") {
        options.bone_depth.setConstant(10, 0.01);
        options.bone_depth(4) = -0.5;
        CHECK(message() == "layered body: bone_depth of body vertex 4 = -0.5, expected a finite value > 0");
    }
}
