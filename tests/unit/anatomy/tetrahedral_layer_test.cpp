// SPDX-License-Identifier: MIT
#include <softtissue/anatomy/tetrahedral_layer.hpp>

#include <softtissue/anatomy/make_soft_layer.hpp>
#include <softtissue/mesh/split_prisms.hpp>
#include <softtissue/mesh/validate_surface.hpp>

#include <support/capsule_body.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#ifdef SOFTTISSUE_HAS_TETGEN
#include <softtissue/io/smpl_file.hpp>

#include <support/tetgen_mesher.hpp>
#endif

using namespace softtissue;

namespace {

template <class S>
SoftLayer<S> capsule_layer() {
    const CapsuleBody<S> body;
    SoftLayerOptions<S> options;
    options.region.extremities = JointGroups{{0}, {2}};
    return make_soft_layer(body.positions, body.faces, body.weights, body.tree, body.joints, options);
}

/// A mesher that knows the layer: one prism layer between the ends of the columns, split.
template <class S>
struct SplitColumns {
    const SoftLayer<S>& layer;

    Tetrahedralisation<S> operator()(const Matrix3X<S>& positions, const Triangles&) const {
        const PrismLayers layers{layer.num_columns(), 1};
        const CellMesh<Prism6, S> prisms{positions, layers.prisms(layer.region.triangles)};
        return {positions, split_prisms(prisms).cells};
    }
};

}  // namespace

static_assert(Tetrahedraliser<SplitColumns<float>, float>);
static_assert(!Tetrahedraliser<SplitColumns<float>, double>);

TEST_CASE_TEMPLATE("the boundary of a layer is closed and encloses its volume", S, float, double) {
    const SoftLayer<S> layer = capsule_layer<S>();
    const LayerBoundary<S> boundary = make_layer_boundary(layer);
    CHECK_NOTHROW(validate_closed_surface(boundary.positions, boundary.triangles, "boundary"));
    size_t rim = 0;
    for (const auto& loop : layer.region.loops) {
        rim += loop.size();
    }
    CHECK(boundary.triangles.cols() == 2 * layer.region.num_triangles() + 2 * Index(rim));
    const CellMesh<Tet4, S> split = split_prisms(layer.mesh);
    S volume(0);
    for (Index c = 0; c < split.num_cells(); ++c) {
        volume += Tet4::rest_volume(split.rest_nodes(c));
    }
    // The rim is flat where the capsule's rings are, up to the cut of its bilinear sides.
    CHECK(enclosed_volume(boundary.positions, boundary.triangles) == doctest::Approx(double(volume)).epsilon(1e-4));
}

TEST_CASE_TEMPLATE("a tetrahedralisation that keeps the boundary is taken", S, float, double) {
    const SoftLayer<S> layer = capsule_layer<S>();
    const TetrahedralLayer<S> tets = tetrahedralise_layer(layer, SplitColumns<S>{layer});
    CHECK(tets.mesh.num_cells() == 3 * layer.region.num_triangles());
    for (Index i = 0; i < layer.num_columns(); ++i) {
        CHECK(tets.mesh.rest_positions.col(tets.skin_vertex(i)) == layer.skin_positions.col(i));
        const auto is_prescribed = [&](std::int32_t v) {
            return std::binary_search(tets.prescribed_vertices.begin(), tets.prescribed_vertices.end(), v);
        };
        CHECK(is_prescribed(tets.inner_vertex(i)));
        CHECK(is_prescribed(tets.skin_vertex(i)) == layer.region.is_rim(i));
    }
}

TEST_CASE("a mesher that does not keep the boundary is refused") {
    const SoftLayer<double> layer = capsule_layer<double>();
    const auto message = [&](auto change) {
        try {
            static_cast<void>(tetrahedralise_layer(layer, [&](const Matrix3X<double>& x, const Triangles& t) {
                Tetrahedralisation<double> result = SplitColumns<double>{layer}(x, t);
                change(result);
                return result;
            }));
        } catch (const InvalidInput& error) {
            return std::string(error.what());
        }
        return std::string("accepted");
    };
    CHECK(message([](auto&) {}) == "accepted");
    CHECK(message([](auto& r) { r.positions(1, 5) += 1e-9; }).find("boundary vertex 5 was moved") != std::string::npos);
    CHECK(message([](auto& r) { r.positions = r.positions.leftCols(9).eval(); }).find("returned 9 vertices") !=
          std::string::npos);
    CHECK(message([](auto& r) { r.tets.col(3).reverseInPlace(); }) == "accepted");  // an even permutation
    CHECK(message([](auto& r) {
              std::swap(r.tets(0, 3), r.tets(1, 3));
          }).find("mesh: cell 3 has a rest Jacobian bound") == 0);
    CHECK(message([](auto& r) {
              r.tets = r.tets.leftCols(r.tets.cols() - 1).eval();
          }).find("expected the boundary's topology retained") != std::string::npos);
}

#ifdef SOFTTISSUE_HAS_TETGEN
TEST_CASE("TetGen fills the layer of a real body") {
    const std::filesystem::path path =
        std::filesystem::path(SOFTTISSUE_SHARED_DIR) / "data" / "body" / "body_small.npz";
    if (!std::filesystem::exists(path)) {
        MESSAGE("skipped: no file ", path.string());
        return;
    }
    const SoftLayer<double> layer = make_soft_layer(read_smpl_body<double>(path));
    const TetrahedralLayer<double> tets = tetrahedralise_layer(layer, TetGenMesher{});
    const LayerBoundary<double> boundary = make_layer_boundary(layer);
    double volume = 0;
    for (Index c = 0; c < tets.mesh.num_cells(); ++c) {
        volume += Tet4::rest_volume(tets.mesh.rest_nodes(c));
    }
    CHECK(volume == doctest::Approx(enclosed_volume(boundary.positions, boundary.triangles)).epsilon(1e-9));
}
#endif
