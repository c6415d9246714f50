// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/make_layered_body.hpp>

#include <softtissue/anatomy/posed_wrap.hpp>
#include <softtissue/io/smpl_file.hpp>
#include <softtissue/model/procedural_human.hpp>
#include <softtissue/skinning/joint_transforms.hpp>
#include <softtissue/skinning/linear_blend.hpp>
#include <softtissue/testing/random_states.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

using namespace softtissue;

namespace {

/// Everything that holds for every layered body.
template <class S>
void check_layers(const SmplBody<S>& body, const LayeredBody<S>& layered) {
    layered.mesh.validate();
    CHECK(layered.mesh.count_inverted(layered.mesh.rest_positions) == 0);
    CHECK(layered.mesh.num_cells() == layered.num_muscle_cells() + layered.num_fat_cells());
    const LayeredBodyReport<S>& report = layered.report;
    CHECK(report.muscle.inverted_cells + report.fat.inverted_cells == 0);
    CHECK(report.muscle.crossings + report.fat.crossings == 0);
    CHECK(report.muscle.smallest_scaled_jacobian > S(0.03));
    CHECK(report.fat.smallest_scaled_jacobian > S(0.03));
    CHECK(report.muscle.smallest_relative_coefficient > S(0.2));
    CHECK(report.fat.smallest_relative_coefficient > S(0.2));
    CHECK(report.muscle.thinnest > S(0.002));
    CHECK(report.fat.thinnest > S(0.0016));
    CHECK(report.largest_repair < S(0.02));
    CHECK(layered.region.loops.size() == 5);  // neck, wrists, ankles

    // Level 2 and the offsets give the skin back; cuts are thin and prescribed; the layers fill the skin.
    const Matrix3X<S> skin = layered.region.gather(body.template_vertices);
    CHECK((layered.level_positions(2) + layered.skin_offsets - skin).cwiseAbs().maxCoeff() <= S(1e-6));
    for (Index v = 0; v < layered.mesh.num_vertices(); ++v) {
        const Index column = layered.layers.column(v);
        const bool expected = layered.layers.level(v) == 0 || layered.region.is_rim(column);
        REQUIRE(std::binary_search(layered.prescribed.begin(), layered.prescribed.end(), v) == expected);
    }
    CHECK(std::is_sorted(layered.prescribed.begin(), layered.prescribed.end()));
    const S total = capped_volume<S>(layered.level_positions(2), layered.region.triangles, layered.region.loops);
    const S sum = report.bone_volume + report.muscle.volume + report.fat.volume;
    CHECK(std::abs(sum - total) < S(0.005) * total);  // between the rims
}

/// The body in another shape.
template <class S>
SmplBody<S> shaped(const SmplBody<S>& body, const VectorX<S>& beta) {
    SmplBody<S> result = body;
    result.template_vertices.reshaped() += body.shape_directions * beta;
    return result;
}

VectorX<double> random_shape(RandomGenerator& random, Index count) {
    VectorX<double> beta(count);
    for (double& value : beta) {
        value = random.uniform(-2, 2);
    }
    return beta;
}

const std::vector<const char*> body_files = {"body_small.npz", "body_full.npz"};

/// Calls body(name, data) for the real bodies that are there.
template <class Body>
void for_each_real_body(const Body& body) {
    for (const char* name : body_files) {
        const std::filesystem::path path = std::filesystem::path(SOFTTISSUE_SHARED_DIR) / "data" / "body" / name;
        if (!std::filesystem::exists(path)) {
            MESSAGE("skipped: no file ", path.string());
            continue;
        }
        CAPTURE(name);
        body(std::string(name), read_smpl_body<double>(path));
    }
}

const SmplBody<double>& embedded_human() {
    static const SmplBody<double> body = procedural_human<double>();
    return body;
}

const LayeredBody<double>& embedded_layers() {
    static const LayeredBody<double> layered = make_layered_body(embedded_human());
    return layered;
}

std::string refusal(const SmplBody<double>& body, const LayeredBodyOptions<double>& options = {}) {
    try {
        static_cast<void>(make_layered_body(body, options));
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "accepted";
}

}  // namespace

TEST_CASE("the embedded human in its template and in other shapes") {
    for (const double beta : {0.0, 2.0, -2.0}) {
        CAPTURE(beta);
        const SmplBody<double> body = shaped<double>(embedded_human(), VectorX<double>::Constant(10, beta));
        const LayeredBody<double> layered = make_layered_body(body);
        check_layers(body, layered);
        CHECK(layered.report.repaired_vertices == 0);  // a design without clefts
    }
}

TEST_CASE("in single precision") {
    const SmplBody<float> body = embedded_human().cast<float>();
    check_layers(body, make_layered_body(body));
}

TEST_CASE("real bodies: template and another shape, the same bits twice") {
    for_each_real_body([](const std::string&, const SmplBody<double>& body) {
        RandomGenerator random(2024);
        for (int sample = 0; sample < 2; ++sample) {
            CAPTURE(sample);
            const VectorX<double> beta =
                sample == 0 ? VectorX<double>::Zero(body.num_shapes()).eval() : random_shape(random, body.num_shapes());
            const SmplBody<double> other = shaped<double>(body, beta);
            const LayeredBody<double> layered = make_layered_body(other);
            check_layers(other, layered);
            if (sample == 0) {
                CHECK(layered.report.muscle.volume == doctest::Approx(0.0214).epsilon(0.03));
                CHECK(layered.report.fat.volume == doctest::Approx(0.0114).epsilon(0.05));
                CHECK(layered.report.bone_volume == doctest::Approx(0.0171).epsilon(0.03));
                CHECK(make_layered_body(other).mesh.rest_positions == layered.mesh.rest_positions);
            }
        }
    });
}

TEST_CASE("real bodies in twenty random shapes" * doctest::skip()) {
    for_each_real_body([](const std::string& name, const SmplBody<double>& body) {
        RandomGenerator random(7);
        for (int sample = 0; sample < 20; ++sample) {
            CAPTURE(sample);
            const SmplBody<double> other = shaped<double>(body, random_shape(random, body.num_shapes()));
            const LayeredBody<double> layered = make_layered_body(other);
            check_layers(other, layered);
            const LayeredBodyReport<double>& r = layered.report;
            MESSAGE(name, " ", sample, ": scaled Jacobian ", r.muscle.smallest_scaled_jacobian, " ",
                    r.fat.smallest_scaled_jacobian, ", r ", r.muscle.smallest_relative_coefficient, " ",
                    r.fat.smallest_relative_coefficient, ", thinnest ", r.muscle.thinnest, " ", r.fat.thinnest,
                    ", litres ", 1e3 * r.bone_volume, " ", 1e3 * r.muscle.volume, " ", 1e3 * r.fat.volume,
                    ", repaired ", r.repaired_vertices, " by ", r.largest_repair);
        }
    });
}

TEST_CASE("below a deep fold of the skin layers become thin, but do not vanish") {
    for_each_real_body([](const std::string&, const SmplBody<double>& body) {
        VectorX<double> beta = VectorX<double>::Zero(body.num_shapes());
        beta.head(10) << 0.47, 0.58, -1.49, 3, 2.72, -1.97, 0.13, 3, 1.46, -2.29;  // folds below the breasts
        const LayeredBodyReport<double> report = make_layered_body(shaped<double>(body, beta)).report;
        CHECK(report.muscle.inverted_cells + report.fat.inverted_cells == 0);
        CHECK(report.muscle.thinnest > 5e-4);
        CHECK(report.fat.thinnest > 5e-4);
    });
    LayeredBodyOptions<double> options;
    options.thinnest = 0.002;  // less than the cuts have
    CHECK_MESSAGE(refusal(embedded_human(), options).find("for the fat, expected >= 0.002") != std::string::npos,
                  refusal(embedded_human(), options));
}

TEST_CASE("a small change of the shape is a small change of the layers") {
    const SmplBody<double> changed = shaped<double>(embedded_human(), 0.02 * VectorX<double>::Unit(10, 0));
    const LayeredBody<double>& before = embedded_layers();
    const LayeredBody<double> after = make_layered_body(changed);
    const double skin = (after.level_positions(2) - before.level_positions(2)).colwise().norm().maxCoeff();
    CHECK(skin > 1e-5);
    for (const Index level : {0, 1}) {
        const Matrix3X<double> moved = after.level_positions(level) - before.level_positions(level);
        // The targets cross no branch here; the sweeps end at a tenth of a millimetre.
        CHECK(moved.colwise().norm().maxCoeff() < 2 * skin + 4e-4);
    }
}

TEST_CASE(
    "smoothed weights: those of the skin on the cuts, alike on the three levels; the posed bone wrap stays feasible") {
    const SmplBody<double>& body = embedded_human();
    const LayeredBody<double>& layered = embedded_layers();
    const MatrixX<double> weights = layered.weights.dense();
    const MatrixX<double> skin_weights = body.weights.dense();
    double change = 0;
    for (Index column = 0; column < layered.num_columns(); ++column) {
        CHECK(weights.row(3 * column) == weights.row(3 * column + 1));
        CHECK(weights.row(3 * column) == weights.row(3 * column + 2));
        const double difference =
            (weights.row(3 * column) - skin_weights.row(layered.region.body_vertices[size_t(column)])).norm();
        change = std::max(change, difference);
        if (layered.region.is_rim(column)) {
            CHECK(difference < 1e-12);
        }
    }
    CHECK(change > 0.05);

    Pose<double> pose;
    pose.rotation_vectors = Matrix3X<double>::Zero(3, 24);
    pose.translation.setZero();
    pose.rotation_vectors.col(18) << 0, -1.4, 0;   // elbow
    pose.rotation_vectors.col(5) << 1.4, 0, 0;     // knee
    pose.rotation_vectors.col(1) << -0.9, 0, 0;    // hip
    pose.rotation_vectors.col(17) << 0, 0.4, 0.8;  // shoulder
    const Matrix3X<double> joints = (body.joint_regressor * body.template_vertices.transpose()).transpose();
    const std::vector<AffineTransform<double>> transforms = joint_transforms<double>(body.tree, joints, pose);
    MatrixX<double> prepared;
    const LinearBlend<double> blend;
    blend.prepare_into(transforms, prepared);
    Matrix3X<double> posed = layered.level_positions(0);
    for (Index column = 0; column < layered.num_columns(); ++column) {
        posed.col(column) = blend.blend(prepared, layered.weights.row(3 * column))(posed.col(column));
    }
    const PosedWrapReport<double> report = examine_posed_wrap<double>(layered, posed, transforms);
    CHECK(report.infeasible_vertices == 0);
    CHECK(report.folded_triangles <= 5);
    CHECK(report.smallest_area_ratio < 0.9);
}

TEST_CASE("thicknesses that are given are built where they can be") {
    const SmplBody<double>& body = embedded_human();
    LayeredBodyOptions<double> options;
    options.fat_thickness.setConstant(body.num_vertices(), 0.005);
    options.bone_depth.setConstant(body.num_vertices(), 0.014);
    const LayeredBody<double> layered = make_layered_body(body, options);
    check_layers(body, layered);
    const Matrix3X<double> fat = layered.level_positions(2) - layered.level_positions(1);
    const Matrix3X<double> depth = layered.level_positions(2) - layered.level_positions(0);
    Index counted = 0;
    Index exact = 0;
    for (Index v = 0; v < layered.num_columns(); ++v) {
        if (layered.region.cut_distance(v) > options.decay_distance) {
            ++counted;
            exact += std::abs(fat.col(v).norm() - 0.005) < 5e-4 && std::abs(depth.col(v).norm() - 0.014) < 1e-3 ? 1 : 0;
        }
    }
    CHECK(double(exact) > 0.95 * double(counted));
}

TEST_CASE("what cannot be layered is refused") {
    SmplBody<double> body = embedded_human();
    LayeredBodyOptions<double> options;
    SUBCASE("fat thicker than the way to the bone allows") {
        options.fat_thickness.setConstant(body.num_vertices(), 0.06);
        const std::string text = refusal(body, options);
        CHECK(text.find("layered body: fat_thickness of body vertex ") == 0);
        CHECK(text.find(" (joint ") != std::string::npos);
        CHECK(text.find("): asked 0.0") != std::string::npos);
        CHECK(text.find(", possible 0.0") != std::string::npos);
    }
    SUBCASE("a bone wrap beyond the bones") {
        options.bone_depth.setConstant(body.num_vertices(), 0.15);
        CHECK(refusal(body, options).find("layered body: bone_depth of body vertex ") == 0);
    }
    SUBCASE("another skeleton") {
        std::vector<std::int32_t> parents = body.tree.parents();
        parents[23] = 20;
        body.tree = KinematicTree(parents);
        CHECK(refusal(body).find("layered body: joint 23 hangs from joint 20, expected 21") == 0);
    }
    SUBCASE("open skin") {
        body.faces = body.faces.leftCols(body.faces.cols() - 1).eval();
        CHECK(refusal(body).find("layered body: skin: edge (") == 0);
    }
    SUBCASE("legs that pass through each other") {
        // Moved sideways as they are, no smoothing brings the shins apart.
        for (Index v = 0; v < body.num_vertices(); ++v) {
            if (body.template_vertices(1, v) < 0.6) {
                const double s = std::min((0.6 - body.template_vertices(1, v)) / 0.2, 1.0);
                body.template_vertices(0, v) -= (body.template_vertices(0, v) > 0 ? 0.15 : -0.05) * s;
            }
        }
        const std::string text = refusal(body);
        CHECK(text.find("layered body: body triangles ") == 0);
        CHECK(text.find(" cross, and the repair of the skin leaves ") != std::string::npos);
    }
    SUBCASE("a skin without room, where it may not be moved") {
        options.repair.max_rounds = 0;
        options.smallest_cosine = 0.9;
        const std::string text = refusal(body, options);
        CHECK(text.find("layered body: below body vertex ") == 0);
        CHECK(text.find("no layer can exist: best cosine with its inward normals 0.") != std::string::npos);
    }
}
