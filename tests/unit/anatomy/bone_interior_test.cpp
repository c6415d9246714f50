// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/bone_interior.hpp>

#include <softtissue/anatomy/make_soft_layer.hpp>
#include <softtissue/mesh/surface_normals.hpp>
#include <softtissue/mesh/validate_surface.hpp>
#include <softtissue/skinning/linear_blend.hpp>

#include <support/capsule_body.hpp>

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include <cstdint>
#include <filesystem>
#include <limits>
#include <vector>

#ifdef SOFTTISSUE_HAS_TETGEN
#include <softtissue/io/smpl_file.hpp>

#include <support/tetgen_mesher.hpp>
#endif

using namespace softtissue;

namespace {

#ifdef SOFTTISSUE_HAS_TETGEN
/// Rows of the body for the vertices of its simulated region.
template <class S>
SkinningWeights<S> region_weights(const SkinningWeights<S>& weights, const SimulatedRegion<S>& region) {
    const MatrixX<S> all = weights.dense();
    MatrixX<S> rows(region.num_vertices(), all.cols());
    for (Index v = 0; v < rows.rows(); ++v) {
        rows.row(v) = all.row(region.body_vertices[size_t(v)]);
    }
    return SkinningWeights<S>(rows);
}
#endif

template <class S>
struct CapsuleWrap {
    CapsuleBody<S> body;
    SoftLayer<S> layer;
    Matrix3X<S> positions;
    SkinningWeights<S> weights;

    CapsuleWrap() {
        SoftLayerOptions<S> options;
        options.region.extremities = JointGroups{{0}, {2}};
        layer = make_soft_layer(body.positions, body.faces, body.weights, body.tree, body.joints, options);
        positions = layer.inner_positions();
        // Linear from joint 0 to joint 2 along the capsule.
        MatrixX<S> dense = MatrixX<S>::Zero(positions.cols(), 3);
        dense.col(2) = positions.row(1).transpose();
        dense.col(0) = VectorX<S>::Ones(positions.cols()) - dense.col(2);
        weights = SkinningWeights<S>(dense);
    }
};

/// A mesher that adds a vertex: the convex surface starred from its middle.
struct Star {
    template <class S>
    Tetrahedralisation<S> operator()(const Matrix3X<S>& positions, const Triangles& triangles) const {
        Tetrahedralisation<S> volume{Matrix3X<S>(3, positions.cols() + 1), Connectivity<4>(4, triangles.cols())};
        volume.positions << positions, positions.rowwise().mean();
        volume.tets << triangles,
            Connectivity<1>::Constant(1, triangles.cols(), static_cast<std::int32_t>(positions.cols()));
        volume.tets.row(0).swap(volume.tets.row(1));
        return volume;
    }
};

template <class S>
double sum_of_volumes(const CellMesh<Tet4, S>& mesh) {
    double sum = 0;
    for (Index c = 0; c < mesh.num_cells(); ++c) {
        sum += double(Tet4::rest_volume(mesh.rest_nodes(c)));
    }
    return sum;
}

template <class S>
Matrix3X<S> posed(const Matrix3X<S>& rest, const SkinningWeights<S>& weights,
                  const std::vector<AffineTransform<S>>& joints) {
    const LinearBlend<S> policy;
    MatrixX<S> prepared;
    policy.prepare_into(joints, prepared);
    Matrix3X<S> result(3, rest.cols());
    for (Index v = 0; v < rest.cols(); ++v) {
        result.col(v) = policy.blend(prepared, weights.row(v))(rest.col(v));
    }
    return result;
}

}  // namespace

TEST_CASE_TEMPLATE("the cuts are closed outwards", S, float, double) {
    const CapsuleWrap<S> wrap;
    const LayerBoundary<S> closed = close_cuts(wrap.positions, wrap.layer.region.triangles);
    CHECK_NOTHROW(validate_closed_surface(closed.positions, closed.triangles, "closed wrap"));
    CHECK(closed.positions.cols() == wrap.positions.cols() + 2);
    CHECK(closed.positions.leftCols(wrap.positions.cols()) == wrap.positions);
    CHECK(closed.triangles.leftCols(wrap.layer.region.num_triangles()) == wrap.layer.region.triangles);
    const LayerBoundary<S> again = close_cuts(closed.positions, closed.triangles);
    CHECK(again.triangles == closed.triangles);
}

TEST_CASE_TEMPLATE("the inside of the wrap is filled and has the wrap's weights", S, float, double) {
    const CapsuleWrap<S> wrap;
    const BoneInterior<S> interior = make_bone_interior(wrap.positions, wrap.layer.region.triangles, wrap.weights);
    const LayerBoundary<S> closed = close_cuts(wrap.positions, wrap.layer.region.triangles);
    CHECK(interior.num_given_vertices == wrap.positions.cols());
    CHECK(interior.mesh.rest_positions == closed.positions);
    CHECK(interior.weights.num_vertices() == closed.positions.cols());
    CHECK(interior.weights.num_joints() == 3);
    CHECK(interior.weights.dense().topRows(wrap.positions.cols()) == wrap.weights.dense());
    // The loops are level: the mean of weights linear in height is that of the middle.
    for (Index v = wrap.positions.cols(); v < closed.positions.cols(); ++v) {
        CHECK(double(interior.weights.dense()(v, 2)) == doctest::Approx(double(closed.positions(1, v))).epsilon(1e-5));
    }
    // Nearly a cylinder: what tets reach beyond it stays small.
    const double expected = double(enclosed_volume(closed.positions, closed.triangles));
    CHECK(sum_of_volumes(interior.mesh) >= expected * (1 - 1e-5));
    CHECK(sum_of_volumes(interior.mesh) <= expected * 1.01);
}

TEST_CASE_TEMPLATE("a mesher's own vertex gets harmonic weights", S, float, double) {
    const CapsuleWrap<S> wrap;
    const BoneInterior<S> interior =
        make_bone_interior(wrap.positions, wrap.layer.region.triangles, wrap.weights, Star{});
    const Index added = interior.mesh.num_vertices() - 1;
    REQUIRE(added == wrap.positions.cols() + 2);
    const MatrixX<S> weights = interior.weights.dense();
    // Harmonic interpolation reproduces linear functions.
    CHECK(double(weights(added, 2)) == doctest::Approx(double(interior.mesh.rest_positions(1, added))).epsilon(1e-4));
    CHECK(double(weights.row(added).sum()) == doctest::Approx(1.0).epsilon(1e-6));
}

TEST_CASE_TEMPLATE("one skinning call poses wrap and interior together", S, float, double) {
    const CapsuleWrap<S> wrap;
    const BoneInterior<S> interior = make_bone_interior(wrap.positions, wrap.layer.region.triangles, wrap.weights);
    const Matrix3<S> R = Eigen::AngleAxis<S>(S(0.8), Vector3<S>::UnitX()).toRotationMatrix();
    std::vector<AffineTransform<S>> joints(3);
    joints[2].linear = R;
    joints[2].translation = Vector3<S>::UnitY() - R * Vector3<S>::UnitY();
    const Matrix3X<S> x = posed(interior.mesh.rest_positions, interior.weights, joints);
    CHECK(x.leftCols(wrap.positions.cols()) == posed(wrap.positions, wrap.weights, joints));
    CHECK((x - interior.mesh.rest_positions).cwiseAbs().maxCoeff() > S(0.1));
    // Seen along y the wrap twists nowhere: bones in it keep most of their volume.
    const CellMesh<Tet4, S> bent{x, interior.mesh.cells};
    CHECK(sum_of_volumes(bent) > 0.8 * sum_of_volumes(interior.mesh));

    joints.assign(3, {R, Vector3<S>(S(1), S(2), S(3))});
    const Matrix3X<S> moved = posed(interior.mesh.rest_positions, interior.weights, joints);
    const Matrix3X<S> expected = (R * interior.mesh.rest_positions).colwise() + Vector3<S>(S(1), S(2), S(3));
    CHECK((moved - expected).cwiseAbs().maxCoeff() < S(16) * std::numeric_limits<S>::epsilon());
}

TEST_CASE_TEMPLATE("the interior shares the vertices of the layers around it", S, float, double) {
    const CapsuleWrap<S> wrap;
    const SoftLayer<S>& layer = wrap.layer;
    const BoneInterior<S> interior = make_bone_interior(wrap.positions, layer.region.triangles, wrap.weights);
    // The layers' own level 0 differs from inner_positions() by rounding; weights follow the height.
    Matrix3X<S> rest = layer.mesh.rest_positions;
    MatrixX<S> dense = MatrixX<S>::Zero(rest.cols(), 3);
    for (Index i = 0; i < layer.num_columns(); ++i) {
        rest.col(layer.layers.vertex(i, 0)) = wrap.positions.col(i);
        for (Index level = 0; level < layer.layers.num_levels(); ++level) {
            dense.row(layer.layers.vertex(i, level)) = wrap.weights.dense().row(i);
        }
    }
    const SkinningWeights<S> weights(dense);
    const BoneInterior<S> joined = join_to_layers(interior, layer.layers, rest, weights);
    CHECK(joined.num_given_vertices == rest.cols());
    CHECK(joined.mesh.num_vertices() == rest.cols() + 2);
    CHECK(joined.mesh.rest_positions.leftCols(rest.cols()) == rest);
    CHECK(joined.weights.num_vertices() == joined.mesh.num_vertices());
    CHECK(joined.mesh.num_cells() == interior.mesh.num_cells());
    const MatrixX<S> before = interior.weights.dense();
    const MatrixX<S> after = joined.weights.dense();
    bool is_same = true;
    for (Index c = 0; c < joined.mesh.num_cells(); ++c) {
        is_same = is_same && joined.mesh.rest_nodes(c) == interior.mesh.rest_nodes(c);
        for (int k = 0; k < 4; ++k) {
            is_same = is_same && after.row(joined.mesh.cells(k, c)) == before.row(interior.mesh.cells(k, c));
        }
    }
    CHECK(is_same);

    rest(0, layer.layers.vertex(3, 0)) += S(1e-3);
    CHECK_THROWS_AS(join_to_layers(interior, layer.layers, rest, weights), InvalidInput);
    CHECK_THROWS_AS(join_to_layers(interior, PrismLayers{7, 2}, rest, weights), InvalidInput);
}

TEST_CASE("what does not fit together is refused") {
    const CapsuleWrap<double> wrap;
    const Triangles& triangles = wrap.layer.region.triangles;
    CHECK_THROWS_AS(make_bone_interior(wrap.positions, triangles, wrap.body.weights), InvalidInput);
    const auto with = [&](auto change) {
        return [change](const Matrix3X<double>& x, const Triangles& t) {
            Tetrahedralisation<double> volume = DelaunayInterior{}(x, t);
            change(volume);
            return volume;
        };
    };
    CHECK_NOTHROW(make_bone_interior(wrap.positions, triangles, wrap.weights, with([](auto&) {})));
    CHECK_THROWS_AS(
        make_bone_interior(wrap.positions, triangles, wrap.weights, with([](auto& v) { v.positions(0, 3) += 1e-9; })),
        InvalidInput);
    CHECK_THROWS_AS(make_bone_interior(wrap.positions, triangles, wrap.weights,
                                       with([](auto& v) { v.positions = v.positions.leftCols(7).eval(); })),
                    InvalidInput);
    CHECK_THROWS_AS(make_bone_interior(wrap.positions, triangles, wrap.weights,
                                       with([](auto& v) { v.tets.row(0).swap(v.tets.row(1)); })),
                    InvalidInput);
}

#ifdef SOFTTISSUE_HAS_TETGEN
TEST_CASE("TetGen and the fallback fill the same inside of a real body") {
    const std::filesystem::path path =
        std::filesystem::path(SOFTTISSUE_SHARED_DIR) / "data" / "body" / "body_small.npz";
    if (!std::filesystem::exists(path)) {
        MESSAGE("skipped: no file ", path.string());
        return;
    }
    const SmplBody<double> body = read_smpl_body<double>(path);
    const SoftLayer<double> layer = make_soft_layer(body);
    const Matrix3X<double> positions = layer.inner_positions();
    const SkinningWeights<double> weights = region_weights(body.weights, layer.region);
    const LayerBoundary<double> closed = close_cuts(positions, layer.region.triangles);
    const double expected = enclosed_volume(closed.positions, closed.triangles);

    const BoneInterior<double> fallback = make_bone_interior(positions, layer.region.triangles, weights);
    CHECK(sum_of_volumes(fallback.mesh) >= expected * (1 - 1e-9));
    CHECK(sum_of_volumes(fallback.mesh) <= expected * 1.02);

    const BoneInterior<double> kept = make_bone_interior(positions, layer.region.triangles, weights, TetGenMesher{});
    CHECK(sum_of_volumes(kept.mesh) == doctest::Approx(expected).epsilon(1e-9));
    const BoneInterior<double> refined =
        make_bone_interior(positions, layer.region.triangles, weights, TetGenMesher{"q"});
    CHECK(refined.mesh.num_vertices() > closed.positions.cols());
    CHECK(refined.weights.num_vertices() == refined.mesh.num_vertices());
}
#endif
