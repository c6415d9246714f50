// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/make_soft_layer.hpp>

#include <softtissue/io/smpl_file.hpp>
#include <softtissue/mesh/split_prisms.hpp>
#include <softtissue/model/procedural_human.hpp>
#include <softtissue/testing/random_states.hpp>

#include <support/capsule_body.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>

using namespace softtissue;

namespace {

template <class S>
SoftLayerOptions<S> capsule_options() {
    SoftLayerOptions<S> options;
    options.region.extremities = JointGroups{{0}, {2}};
    return options;
}

template <class S>
SoftLayer<S> make(const CapsuleBody<S>& body, const SoftLayerOptions<S>& options = capsule_options<S>()) {
    return make_soft_layer(body.positions, body.faces, body.weights, body.tree, body.joints, options);
}

template <class S>
void check_valid(const SoftLayer<S>& layer) {
    layer.mesh.validate();
    const CellMesh<Tet4, S> tets = split_prisms(layer.mesh);
    CHECK(tets.count_inverted(tets.rest_positions) == 0);
    // The margin is kept up to the rounding of the measure.
    CHECK(layer.report.smallest_relative_jacobian >= layer.options.validity_margin);
}

/// A body of the shared data, or nothing where it is absent.
template <class S>
bool read_body(const char* name, SmplBody<S>& body) {
    const std::filesystem::path path = std::filesystem::path(SOFTTISSUE_SHARED_DIR) / "data" / "body" / name;
    if (!std::filesystem::exists(path)) {
        MESSAGE("skipped: no file ", path.string());
        return false;
    }
    body = read_smpl_body<S>(path);
    return true;
}

}  // namespace

TEST_CASE_TEMPLATE("the layer of a capsule is as designed", S, float, double) {
    const CapsuleBody<S> body;
    const SoftLayer<S> layer = make(body);
    check_valid(layer);
    const S tolerance = S(32) * std::numeric_limits<S>::epsilon();
    CHECK(layer.report.vertices_reduced == 0);
    CHECK(layer.report.vertices_redirected == 0);
    CHECK(layer.report.vertices_without_cone == 0);
    CHECK(layer.report.crossings_left == 0);
    CHECK(layer.mesh.num_cells() == 2 * layer.region.num_triangles());
    CHECK(layer.report.thickness_min == layer.options.minimum_thickness);
    CHECK(layer.report.thickness_max == layer.options.full_thickness);
    for (Index i = 0; i < layer.num_columns(); ++i) {
        const Vector3<S> t = body.positions.col(layer.body_vertex(layer.skin_vertex(i)));
        CHECK(layer.mesh.rest_positions.col(layer.skin_vertex(i)) == t);  // the skin is the input, bit by bit
        const Vector3<S> b = layer.mesh.rest_positions.col(layer.layers.vertex(i, 0));
        CHECK((b - layer.inner_positions().col(i)).norm() <= tolerance);
        CHECK((b - (t + layer.thickness(i) * layer.directions.col(i))).norm() <= tolerance);
        const Vector3<S> middle = layer.mesh.rest_positions.col(layer.layers.vertex(i, 1));
        CHECK((middle - (b + t) / S(2)).norm() <= tolerance);
        // Sideways towards the axis.
        CHECK(layer.directions.col(i).dot(Vector3<S>(t(0), S(0), t(2))) < S(-0.099));
        if (layer.region.is_rim(i)) {
            CHECK(layer.thickness(i) == layer.options.minimum_thickness);
        }
        if (layer.region.cut_distance(i) >= layer.options.decay_distance) {
            CHECK(layer.thickness(i) == layer.options.full_thickness);
        }
    }
}

TEST_CASE("prescribed are the inner surface and the rim") {
    const SoftLayer<double> layer = make(CapsuleBody<double>());
    CHECK(std::is_sorted(layer.prescribed_vertices.begin(), layer.prescribed_vertices.end()));
    size_t count = 0;
    for (Index v = 0; v < layer.mesh.num_vertices(); ++v) {
        const bool expected = layer.layers.level(v) == 0 || layer.region.is_rim(layer.layers.column(v));
        count += expected ? 1 : 0;
        CHECK(std::binary_search(layer.prescribed_vertices.begin(), layer.prescribed_vertices.end(), v) == expected);
    }
    CHECK(layer.prescribed_vertices.size() == count);
}

TEST_CASE_TEMPLATE("a thickness given by the user is built, bounded, or refused", S, float, double) {
    CapsuleBody<S> body;
    const SoftLayer<S> layer = make(body);
    VectorX<S> wanted = VectorX<S>::Constant(layer.num_columns(), S(0.01));
    const SoftLayer<S> thinner = with_thickness(layer, wanted, ThicknessPolicy::refuse);
    CHECK(thinner.report.thickness_max == S(0.01));
    CHECK(thinner.region.body_vertices == layer.region.body_vertices);
    CHECK(thinner.directions == layer.directions);
    check_valid(thinner);

    wanted(7) = S(0.5);
    const SoftLayer<S> bounded = with_thickness(layer, wanted);
    CHECK(bounded.report.vertices_clamped == 1);
    check_valid(bounded);
    const auto message = [&](const VectorX<S>& h) {
        try {
            static_cast<void>(with_thickness(layer, h, ThicknessPolicy::refuse));
        } catch (const InvalidInput& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    const std::string vertex = std::to_string(layer.region.body_vertices[7]);
    CHECK(message(wanted).find("soft layer: thickness of body vertex " + vertex + " = 0.5, expected 0.003") == 0);
    wanted(7) = std::numeric_limits<S>::quiet_NaN();
    CHECK(message(wanted) == "soft layer: thickness of body vertex " + vertex + " is not finite");
    CHECK(message(VectorX<S>(3)) == "soft layer: 3 values of thickness, expected one for each of the " +
                                        std::to_string(layer.num_columns()) + " vertices of the region");
}

TEST_CASE("a thickness that would invert cells is reduced, or refused with the triangle's name") {
    CapsuleBody<double> body;
    // One vertex drawn in half way to the axis: around it the layer has little room.
    const std::int32_t dent = body.vertex(body.num_rings / 2, 0);
    body.positions(0, dent) = 0.045;
    const SoftLayer<double> layer = make(body);
    check_valid(layer);
    const VectorX<double> wanted = VectorX<double>::Constant(layer.num_columns(), 0.06);
    const SoftLayer<double> reduced = with_thickness(layer, wanted);
    check_valid(reduced);
    CHECK(reduced.report.vertices_reduced > 0);
    CHECK(reduced.report.thickness_max > 0.05);
    SoftLayer<double> unbounded = layer;
    unbounded.skeleton_distance.setConstant(1.0);
    try {
        static_cast<void>(with_thickness(unbounded, wanted, ThicknessPolicy::refuse));
        FAIL("accepted");
    } catch (const InvalidInput& error) {
        const std::string text = error.what();
        CHECK(text.find("soft layer: the thickness makes the cells below body triangle ") == 0);
        CHECK(text.find("expected >= 0.2)") != std::string::npos);
    }
}

TEST_CASE_TEMPLATE("a vertex without a validity cone leaves the region, the skin stays", S, float, double) {
    CapsuleBody<S> body;
    // Drawn along the skin beyond its neighbours, the vertex folds triangles over.
    const std::int32_t folded = body.vertex(body.num_rings / 2, 0);
    body.positions.col(folded) = body.positions.col(body.vertex(body.num_rings / 2 + 2, 0));
    body.positions(0, folded) += S(0.001);
    const SoftLayer<S> layer = make(body);
    CHECK(layer.report.vertices_without_cone >= 1);
    CHECK(layer.region.region_vertices[size_t(folded)] == -1);
    CHECK(layer.region.loops.size() == 3);
    CHECK(layer.report.smallest_cone_cosine >= layer.options.smallest_cosine);
    check_valid(layer);
}

TEST_CASE("a body without extremities named keeps its whole skin; its layer is closed") {
    const CapsuleBody<double> body;
    SoftLayerOptions<double> options;
    options.region.extremities = JointGroups{};
    options.num_layers = 3;
    const SoftLayer<double> layer = make(body, options);
    check_valid(layer);
    CHECK(layer.region.num_triangles() == body.faces.cols());
    CHECK(layer.prescribed_vertices.size() == size_t(layer.num_columns()));
}

TEST_CASE("options out of range and skins that are none are refused") {
    CapsuleBody<double> body;
    auto options = capsule_options<double>();
    const auto message = [&] {
        try {
            static_cast<void>(make(body, options));
        } catch (const InvalidInput& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    SUBCASE("layers") {
        options.num_layers = 0;
        CHECK(message() == "soft layer: num_layers = 0, expected >= 1");
    }
    SUBCASE("minimum") {
        options.minimum_thickness = 0;
        CHECK(message() == "soft layer: minimum_thickness = 0, expected > 0");
    }
    SUBCASE("full") {
        options.full_thickness = 0.001;
        CHECK(message() == "soft layer: full_thickness = 0.001, expected >= minimum_thickness");
    }
    SUBCASE("fraction") {
        options.bone_fraction = 1;
        CHECK(message() == "soft layer: bone_fraction = 1, expected a value between 0 and 1");
    }
    SUBCASE("radius") {
        options.bone_radius = -0.01;
        CHECK(message() == "soft layer: bone_radius = -0.01, expected >= 0");
    }
    SUBCASE("not finite") {
        const auto infinity = std::numeric_limits<double>::infinity();
        SUBCASE("minimum") {
            options.minimum_thickness = options.full_thickness = infinity;
            CHECK(message() == "soft layer: minimum_thickness = inf, expected > 0");
        }
        SUBCASE("decay") {
            options.decay_distance = infinity;
            CHECK(message() == "soft layer: decay_distance = inf, expected > 0");
        }
        SUBCASE("cosine") {
            options.wanted_cosine = std::numeric_limits<double>::quiet_NaN();
            CHECK(message() == "soft layer: wanted_cosine = nan, expected a value between 0 and 1");
        }
    }
    SUBCASE("decay") {
        options.decay_distance = 0;
        CHECK(message() == "soft layer: decay_distance = 0, expected > 0");
    }
    SUBCASE("rounds") {
        options.projection_rounds = -1;
        CHECK(message() == "soft layer: projection_rounds = -1, expected >= 0");
    }
    SUBCASE("margin") {
        options.validity_margin = 1;
        CHECK(message() == "soft layer: validity_margin = 1, expected a value between 0 and 1");
    }
    SUBCASE("cosine") {
        options.smallest_cosine = 0;
        CHECK(message() == "soft layer: smallest_cosine = 0, expected a value between 0 and 1");
    }
    SUBCASE("open skin") {
        body.faces = body.faces.leftCols(body.faces.cols() - 1).eval();
        CHECK(message().find("soft layer: skin: edge (") == 0);
    }
    SUBCASE("joints") {
        body.joints = body.joints.leftCols(2).eval();
        CHECK(message() == "skeleton: 2 joint positions, expected 3");
    }
}

TEST_CASE_TEMPLATE("real bodies: no inverted prism, no inverted tet, no crossing", S, float, double) {
    for (const char* name : {"body_small.npz", "body_full.npz"}) {
        SmplBody<S> body;
        if (!read_body(name, body)) {
            continue;
        }
        CAPTURE(name);
        const SoftLayer<S> layer = make_soft_layer(body);
        check_valid(layer);
        CHECK(layer.region.loops.size() == 5);  // neck, wrists, ankles
        CHECK(layer.report.crossings_left == 0);
        CHECK(layer.report.vertices_without_cone == 0);
        CHECK(layer.report.thickness_min > S(0.001));
        CHECK(layer.report.thickness_mean > S(0.020));
        CHECK(layer.report.vertices_reduced < layer.num_columns() / 15);
    }
}

TEST_CASE("the embedded human, in its template and in other shapes") {
    SmplBody<double> body = procedural_human<double>();
    const Matrix3X<double> rest = body.template_vertices;
    for (const double beta : {0.0, 2.0, -2.0}) {
        CAPTURE(beta);
        body.template_vertices = rest;
        body.template_vertices.reshaped() += body.shape_directions * VectorX<double>::Constant(body.num_shapes(), beta);
        const SoftLayer<double> layer = make_soft_layer(body);
        check_valid(layer);
        CHECK(layer.region.loops.size() == 5);
        CHECK(layer.report.crossings_left == 0);
        CHECK(layer.report.vertices_without_cone == 0);
        CHECK(layer.report.thickness_min == layer.options.minimum_thickness);
        CHECK(layer.report.thickness_mean > 0.02);
    }
}

TEST_CASE("real bodies of other shapes, and the same bits twice") {
    SmplBody<double> body;
    if (!read_body("body_small.npz", body)) {
        return;
    }
    RandomGenerator random(2024);
    for (int sample = 0; sample < 3; ++sample) {
        VectorX<double> beta(body.num_shapes());
        for (double& value : beta) {
            value = random.uniform(-2, 2);
        }
        SmplBody<double> shaped = body;
        shaped.template_vertices.reshaped() += body.shape_directions * beta;
        const SoftLayer<double> layer = make_soft_layer(shaped);
        check_valid(layer);
        CHECK(layer.report.thickness_mean > 0.018);
        if (sample == 0) {
            CHECK(make_soft_layer(shaped).mesh.rest_positions == layer.mesh.rest_positions);
        }
    }
}
