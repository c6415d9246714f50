// SPDX-License-Identifier: MIT
#include <softtissue/io/smpl_file.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

constexpr Index n = 6;       // an octahedron
constexpr Index joints = 3;  // a chain 0 - 1 - 2
constexpr Index columns = 9 * (joints - 1);
constexpr Index num_shapes = 2;

template <class T>
NpyArray array(const std::vector<T>& values, std::vector<Index> shape) {
    return NpyArray::from_values(std::span<const T>(values), std::move(shape));
}

const std::vector<double> vertices{1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1};
const std::vector<std::int32_t> faces{0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
const std::vector<std::uint32_t> tree{4294967295U, 0, 1, 0, 1, 2};

/// Every fifth value is i + 1, the others are 0.
std::vector<float> sparse_values() {
    std::vector<float> values(std::size_t(3 * n * columns), 0.0F);
    for (std::size_t i = 0; i < values.size(); i += 5) {
        values[i] = float(i + 1);
    }
    return values;
}

NpyArrays sample_arrays() {
    NpyArrays arrays;
    arrays["v_template"] = array(vertices, {n, 3});
    arrays["f"] = array(faces, {8, 3});
    arrays["kintree_table"] = array(tree, {2, joints});
    arrays["weights"] =
        array(std::vector<double>{1, 0, 0, 0.5, 0.5, 0, 0.25, 0.25, 0.5, 0, 1, 0, 0, 0, 1, 0, 0.75, 0.25}, {n, joints});
    MatrixX<double> regressor = MatrixX<double>::Zero(joints, n);
    regressor(0, 1) = 1.0;
    regressor(1, 2) = 0.5;
    regressor(1, 5) = 0.5;
    regressor(2, 0) = 1.0;
    arrays["J_regressor"] = NpyArray::from_matrix(regressor);
    std::vector<float> shapes(std::size_t(3 * n * num_shapes));
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        shapes[i] = float(i);
    }
    arrays["shapedirs"] = array(shapes, {n, 3, num_shapes});
    arrays["posedirs"] = array(sparse_values(), {n, 3, columns});
    arrays["joint_names"] = NpyArray::from_strings({"pelvis", "knee", "foot"}, {joints});
    return arrays;
}

template <RealScalar S = double>
SmplBody<S> body_of(const NpyArrays& arrays) {
    const TemporaryFolder folder;
    write_npz(folder / "body.npz", arrays);
    return read_smpl_body<S>(folder / "body.npz");
}

std::string refused(const NpyArrays& arrays) {
    const std::string text = refusal([&] { static_cast<void>(body_of(arrays)); });
    CHECK(contains(text, "body.npz: "));
    return text;
}

std::string refused_with(const std::string& name, const NpyArray& replacement) {
    NpyArrays arrays = sample_arrays();
    arrays[name] = replacement;
    return refused(arrays);
}

/// The sample's doubles with one of them replaced.
std::string refused_with_value(const std::string& name, std::size_t place, double value) {
    const NpyArrays arrays = sample_arrays();
    std::vector<double> values = arrays.at(name).as<double>();
    values[place] = value;
    return refused_with(name, array(values, arrays.at(name).shape()));
}

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE_TEMPLATE("every array goes to its place", S, float, double) {
    const SmplBody<S> body = body_of<S>(sample_arrays());
    CHECK(body.num_vertices() == n);
    CHECK(body.num_joints() == joints);
    CHECK(body.template_vertices.col(3) == Vector3<S>(0, -1, 0));
    CHECK(body.faces.col(1) == Eigen::Vector3i(2, 1, 4));
    CHECK(body.tree.parents() == std::vector<std::int32_t>{-1, 0, 1});
    CHECK(body.weights.dense()(2, 2) == S(0.5));
    CHECK(body.joint_regressor.coeff(1, 5) == S(0.5));
    CHECK(body.joint_regressor.nonZeros() == 4);
    CHECK(body.shape_directions(3 * 4 + 1, 1) == S((4 * 3 + 1) * num_shapes + 1));
    CHECK(body.pose_directions.nonZeros() == (3 * n * columns + 4) / 5);
    CHECK(body.pose_directions.coeff(0, 5) == S(6));
    CHECK(body.pose_directions.coeff(3 * 2 + 1, 4) == S((2 * 3 + 1) * columns + 4 + 1));
    CHECK(body.joint_names == std::vector<std::string>{"pelvis", "knee", "foot"});
}

TEST_CASE("compressed rows give the same body as dense arrays") {
    const SmplBody<double> dense = body_of(sample_arrays());
    NpyArrays arrays = sample_arrays();
    arrays.erase("posedirs");
    arrays.erase("J_regressor");
    CsrArrays<double> posedirs({n, 3, columns});
    const std::vector<float> values = sparse_values();
    for (Index i = 0; i < Index(values.size()); i += 5) {
        posedirs.append(i / (3 * columns), i % (3 * columns), double(values[std::size_t(i)]));
    }
    posedirs.store(arrays, "posedirs");
    CsrArrays<double> regressor({joints, n});
    regressor.append(0, 1, 1.0);
    regressor.append(1, 2, 0.5);
    regressor.append(1, 5, 0.5);
    regressor.append(2, 0, 1.0);
    regressor.store(arrays, "J_regressor");
    const SmplBody<double> sparse = body_of(arrays);
    CHECK(MatrixX<double>(sparse.pose_directions) == MatrixX<double>(dense.pose_directions));
    CHECK(MatrixX<double>(sparse.joint_regressor) == MatrixX<double>(dense.joint_regressor));
}

TEST_CASE("the tree follows the joint ids, whatever marks the root") {
    const auto parents = [](const std::vector<std::int64_t>& table) {
        NpyArrays arrays = sample_arrays();
        arrays["kintree_table"] = array(table, {2, joints});
        return body_of(arrays).tree.parents();
    };
    CHECK(parents({-1, 0, 1, 0, 1, 2}) == std::vector<std::int32_t>{-1, 0, 1});
    CHECK(parents({0, 0, 1, 0, 1, 2}) == std::vector<std::int32_t>{-1, 0, 1});
    CHECK(parents({4294967295, 7, 9, 7, 9, 8}) == std::vector<std::int32_t>{-1, 0, 1});
    CHECK(parents({-1, 8, 9, 9, 7, 8}) == std::vector<std::int32_t>{-1, 2, 0});
}

TEST_CASE_TEMPLATE("what is written is read again", S, float, double) {
    const TemporaryFolder folder;
    const SmplBody<S> body = body_of<S>(sample_arrays());
    for (const NpzCompression compression : {NpzCompression::stored, NpzCompression::deflated}) {
        write_smpl_body(folder / "b.npz", body, compression);
        const SmplBody<S> again = read_smpl_body<S>(folder / "b.npz");
        CHECK(again.template_vertices == body.template_vertices);
        CHECK(again.faces == body.faces);
        CHECK(again.tree == body.tree);
        CHECK(again.weights.dense() == body.weights.dense());
        CHECK(MatrixX<S>(again.joint_regressor) == MatrixX<S>(body.joint_regressor));
        CHECK(again.shape_directions == body.shape_directions);
        CHECK(MatrixX<S>(again.pose_directions) == MatrixX<S>(body.pose_directions));
        CHECK(again.joint_names == body.joint_names);
    }
}

TEST_CASE("missing arrays and wrong shapes are refused by name") {
    for (const char* name : {"v_template", "f", "kintree_table", "weights", "J_regressor", "shapedirs", "posedirs"}) {
        NpyArrays arrays = sample_arrays();
        arrays.erase(name);
        CHECK(contains(refused(arrays), std::string("array '") + name + "' is missing"));
        CHECK(contains(refused_with(name, NpyArray::from_matrix(MatrixX<double>::Zero(7, 5))),
                       std::string("array '") + name + "': shape is (7, 5), expected"));
    }
    CHECK(contains(refused_with("joint_names", NpyArray::from_strings({"a", "b"}, {2})), "2 joint names, expected 3"));
    CHECK(contains(refused_with("f", array(std::vector<double>(24, 0.5), {8, 3})),
                   "array 'f': element 0 is 0.5, expected a whole"));
}

TEST_CASE("values that are not finite are refused where they are") {
    CHECK(contains(refused_with_value("v_template", 4, not_a_number), "v_template of vertex 1 is not finite"));
    CHECK(contains(refused_with_value("shapedirs", 13, not_a_number), "shapedirs of vertex 2 is not finite"));
    CHECK(contains(refused_with_value("J_regressor", 7, not_a_number), "J_regressor[1, 1]"));
    CHECK(contains(refused_with_value("posedirs", std::size_t(3 * columns), not_a_number), "posedirs[3, 0]"));
    CHECK(contains(refused_with_value("weights", 5, not_a_number), "weights[1, 2]"));
    NpyArrays too_large_for_float = sample_arrays();
    too_large_for_float["v_template"] = array(std::vector<double>(18, 1e300), {n, 3});
    CHECK(contains(refusal([&] { static_cast<void>(body_of<float>(too_large_for_float)); }), "vertex 0 is not finite"));
}

TEST_CASE("weights that do not sum to one are refused") {
    CHECK(contains(refused_with_value("weights", 3, 0.6), "weights of vertex 1 sum to 1.1, expected 1"));
    CHECK(contains(refused_with_value("weights", 0, -1.0), "weights[0, 0] = -1, expected a finite value >= 0"));
}

TEST_CASE("a kinematic tree that is none is refused") {
    const auto refused_tree = [](const std::vector<std::int64_t>& table) {
        return refused_with("kintree_table", array(table, {2, joints}));
    };
    CHECK(contains(refused_tree({-1, 2, 1, 0, 1, 2}),
                   "kinematic tree: joint 1 does not hang from the root, expected no cycle"));
    CHECK(contains(refused_tree({2, 0, 1, 0, 1, 2}), "every joint has a parent, expected one root"));
    CHECK(contains(refused_tree({-1, -1, 1, 0, 1, 2}), "joints 0 and 1 both have no parent"));
    CHECK(contains(refused_tree({-1, 0, 5, 0, 1, 2}),
                   "array 'kintree_table': parent of joint 2 is 5, expected the id of a joint"));
    CHECK(contains(refused_tree({-1, 0, 1, 0, 1, 1}), "joint id 1 appears twice"));
}

TEST_CASE("a surface that is not closed and manifold, or degenerate, is refused") {
    const std::vector<std::int32_t> open(faces.begin(), faces.end() - 3);
    CHECK(contains(refused_with("f", array(open, {7, 3})), "expected a closed surface"));
    std::vector<std::int32_t> turned = faces;
    std::swap(turned[0], turned[1]);
    CHECK(refused_with("f", array(turned, {8, 3})).size() > 0);
    std::vector<std::int32_t> outside = faces;
    outside[5] = 6;
    CHECK(contains(refused_with("f", array(outside, {8, 3})), "f[1, 2] = 6, expected a vertex from 0 to 5"));
    std::vector<double> flat = vertices;
    for (std::size_t v = 0; v < 6; ++v) {
        flat[3 * v] = 0.0;
    }
    CHECK(refused_with("v_template", array(flat, {n, 3})).size() > 0);
}

TEST_CASE("a surface with an opening is read where it need not be closed") {
    const TemporaryFolder folder;
    NpyArrays arrays = sample_arrays();
    arrays["f"] = array(std::vector<std::int32_t>(faces.begin(), faces.end() - 3), {7, 3});
    CHECK(contains(refused(arrays), "expected a closed surface"));
    write_npz(folder / "body.npz", arrays);
    CHECK(read_smpl_body<double>(folder / "body.npz", SmplSurface::any).faces.cols() == 7);
    arrays["f"] = array(std::vector<std::int32_t>{0, 2, 6}, {1, 3});
    write_npz(folder / "body.npz", arrays);
    CHECK(contains(refusal([&] { static_cast<void>(read_smpl_body<double>(folder / "body.npz", SmplSurface::any)); }),
                   "f[0, 2] = 6"));
}

TEST_CASE("what smplx's files hold besides is left alone: hands, landmarks, texture, pickled objects") {
    NpyArrays arrays = sample_arrays();
    arrays["kintree_table"] = array(std::vector<std::int64_t>{4294967295, 0, 1, 0, 1, 2}, {2, joints});
    arrays["f"] = array(std::vector<std::uint32_t>(faces.begin(), faces.end()), {8, 3});
    arrays["hands_meanl"] = array(std::vector<float>(45, 0.1F), {45});
    arrays["lmk_faces_idx"] = array(std::vector<std::int64_t>{1, 2}, {2});
    arrays["vt"] = array(std::vector<double>{0.0, 1.0}, {1, 2});
    arrays["bs_style"] = NpyArray::from_strings({"lbs"}, {});
    arrays["joint2num"] =
        NpyArray("body.npz: array 'joint2num'",
                 as_bytes(npy_image("{'descr': '|O', 'fortran_order': False, 'shape': ()}", "\x80\x04K\x01.")));
    const SmplBody<double> body = body_of(arrays);
    CHECK(body.faces == body_of(sample_arrays()).faces);
    CHECK(body.tree.parents() == std::vector<std::int32_t>{-1, 0, 1});
}

TEST_CASE("a body that does not fit together is not written") {
    const TemporaryFolder folder;
    SmplBody<double> body = body_of(sample_arrays());
    body.shape_directions.resize(5, 2);
    CHECK(
        contains(refusal([&] { write_smpl_body(folder / "b.npz", body); }), "b.npz: shapedirs (3n x shapes) is 5 x 2"));
    CHECK(folder.num_files() == 0);
}

TEST_CASE("the bodies of the data folder are read and agree where they share vertices") {
    const std::filesystem::path bodies = std::filesystem::path(SOFTTISSUE_SHARED_DIR) / "data/body";
    if (!std::filesystem::exists(bodies)) {
        MESSAGE("skipped: no folder " << bodies.string());
        return;
    }
    const SmplBody<double> small = read_smpl_body<double>(bodies / "body_small.npz");
    const SmplBody<double> full = read_smpl_body<double>(bodies / "body_full.npz");
    CHECK(small.num_vertices() == 6890);
    CHECK(full.num_vertices() == 12303);
    CHECK(small.tree == full.tree);
    // Per-vertex rows of the small body are copies of the full one's; posedirs dense there, compressed here.
    const std::vector<std::int64_t> full_index =
        read_npz(bodies / "body_small.npz").at("full_index").as<std::int64_t>();
    double position_difference = 0.0;
    double pose_difference = 0.0;
    for (Index v = 0; v < small.num_vertices(); ++v) {
        const Index w = full_index[std::size_t(v)];
        position_difference =
            std::max(position_difference, (small.template_vertices.col(v) - full.template_vertices.col(w)).norm());
        for (Index c = 0; c < 3; ++c) {
            const VectorX<double> a = small.pose_directions.row(3 * v + c).transpose();
            const VectorX<double> b = full.pose_directions.row(3 * w + c).transpose();
            pose_difference = std::max(pose_difference, (a - b).cwiseAbs().maxCoeff());
        }
    }
    CHECK(position_difference == 0.0);
    CHECK(pose_difference == 0.0);
}
