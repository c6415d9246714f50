// SPDX-License-Identifier: MIT
#include <softtissue/io/layered_body_file.hpp>

#include "io_test_support.hpp"

#include <support/limb_dataset.hpp>

#include <doctest/doctest.h>

#include <limits>

using namespace softtissue;
using namespace softtissue_test;
using namespace io_test;

namespace {

SkeletalLayers<double> limb_file() {
    SkeletalLayers<double> limb{LimbMaker()(VectorX<double>::Zero(2)), limb_tree(), {"upper", "lower"}};
    SimulatedRegion<double>& region = limb.body.layered.region;
    for (std::int32_t v = 0; v < 100; ++v) {
        region.body_vertices.push_back(v + 1);
    }
    region.region_vertices.assign(102, -1);
    region.body_triangles.assign(size_t(region.num_triangles()), 5);
    region.loops = {{0, 1, 2}, {9, 8}};
    region.cut_distance(3) = std::numeric_limits<double>::infinity();
    return limb;
}

}  // namespace

TEST_CASE("a layered body comes back as it was written") {
    const TemporaryFolder folder;
    const SkeletalLayers<double> limb = limb_file();
    write_layered_body(folder / "body.npz", limb);
    const SkeletalLayers<double> read = read_layered_body<double>(folder / "body.npz");
    const LayeredBody<double>&a = limb.body.layered, &b = read.body.layered;
    CHECK(b.mesh.rest_positions == a.mesh.rest_positions);
    CHECK(b.mesh.cells == a.mesh.cells);
    CHECK(b.weights.dense() == a.weights.dense());
    CHECK(b.prescribed == a.prescribed);
    CHECK(b.skin_offsets == a.skin_offsets);
    CHECK(b.layers.num_vertices() == a.layers.num_vertices());
    CHECK(b.region.triangles == a.region.triangles);
    CHECK(b.region.body_triangles == a.region.body_triangles);
    CHECK(b.region.body_vertices == a.region.body_vertices);
    CHECK(b.region.region_vertices == a.region.region_vertices);
    CHECK(b.region.loops == a.region.loops);
    CHECK(b.region.cut_distance == a.region.cut_distance);
    CHECK(read.body.joints == limb.body.joints);
    CHECK(read.tree == limb.tree);
    CHECK(read.joint_names == limb.joint_names);

    write_layered_body(folder / "again.npz", read);
    CHECK(read_bytes(folder / "again.npz") == read_bytes(folder / "body.npz"));
}

TEST_CASE("a shape comes back as a whole body") {
    const TemporaryFolder folder;
    VectorX<double> betas(2);
    betas << 0.5, -1;
    const ShapedBody<double> shaped = LimbMaker()(betas);
    write_body_shape(folder / "shape.npz", shaped, betas);
    const ShapedBody<double> read = read_body_shape(folder / "shape.npz", limb_file().body);
    CHECK(read.layered.mesh.rest_positions == shaped.layered.mesh.rest_positions);
    CHECK(read.joints == shaped.joints);
    CHECK(read.layered.mesh.cells == shaped.layered.mesh.cells);
    CHECK(read_npz(folder / "shape.npz").at("betas").vector<double>() == betas);
}

TEST_CASE("files that do not fit together are refused, with the file's name") {
    const TemporaryFolder folder;
    const auto refused = [&](const char* name, const NpyArray& replacement) {
        write_layered_body(folder / "body.npz", limb_file());
        NpyArrays arrays = read_npz(folder / "body.npz").arrays();
        arrays[name] = replacement;
        write_npz(folder / "bad.npz", arrays);
        const std::string text = refusal([&] { static_cast<void>(read_layered_body<double>(folder / "bad.npz")); });
        INFO(name);
        CHECK(text.find((folder / "bad.npz").string()) == 0);
    };
    const auto from = [](const std::vector<std::int32_t>& values) { return detail::index_array(values); };
    refused("prescribed", from({0, 300}));
    refused("loops", from({100}));
    refused("loop_sizes", from({3, 3}));
    refused("cells", NpyArray::from_columns(Connectivity<6>::Zero(6, 3).eval()));
    refused("triangles", NpyArray::from_columns(Triangles::Constant(3, 180, -1).eval()));
    refused("joints", NpyArray::from_columns(Matrix3X<double>::Zero(3, 3).eval()));
    refused("rest_positions", NpyArray::from_columns(
                                  Matrix3X<double>::Constant(3, 300, std::numeric_limits<double>::quiet_NaN()).eval()));
    refused("rest_positions", NpyArray::from_columns(Matrix3X<double>::Zero(3, 299).eval()));
    refused("weights", NpyArray::from_matrix(MatrixX<double>::Constant(300, 1, 1.0).eval()));
    refused("skin_offsets",
            NpyArray::from_columns(Matrix3X<double>::Constant(3, 100, std::numeric_limits<double>::infinity()).eval()));
    refused("cut_distance", detail::vector_array<double>(VectorX<double>::Constant(100, -1)));
    refused("cut_distance", detail::vector_array<double>(VectorX<double>::Zero(99)));
    refused("body_triangles", from({0, 1, 2}));
    refused("body_triangles", from(std::vector<std::int32_t>(180, -1)));
    refused("joint_names", NpyArray::from_strings({"upper"}, {1}));
}
