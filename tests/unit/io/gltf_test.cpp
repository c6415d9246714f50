// SPDX-License-Identifier: MIT
#include <softtissue/io/gltf.hpp>

#include "io_test_support.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

const Triangles tetrahedron = (Triangles(3, 4) << 0, 0, 1, 0, 2, 1, 2, 3, 1, 3, 3, 2).finished();

/// A tetrahedron that grows and sways.
Matrix3X<double> frame(int t) {
    Matrix3X<double> x = (Matrix3X<double>(3, 4) << 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1).finished();
    x *= 1.0 + 0.3 * t;
    x.row(1).array() += std::sin(double(t));
    return x;
}

tinygltf::Model load(const std::filesystem::path& path) {
    tinygltf::Model model;
    std::string error;
    std::string warning;
    CHECK(tinygltf::TinyGLTF().LoadBinaryFromFile(&model, &error, &warning, path.string()));
    CHECK(error == "");
    CHECK(warning == "");
    return model;
}

/// The floats of an accessor, one column per element.
MatrixX<float> floats(const tinygltf::Model& model, int number) {
    const tinygltf::Accessor& accessor = model.accessors[std::size_t(number)];
    const tinygltf::BufferView& view = model.bufferViews[std::size_t(accessor.bufferView)];
    REQUIRE(accessor.componentType == TINYGLTF_COMPONENT_TYPE_FLOAT);
    const Index rows = accessor.type == TINYGLTF_TYPE_VEC3 ? 3 : 1;
    MatrixX<float> values(rows, Index(accessor.count));
    REQUIRE(view.byteLength == std::size_t(values.size()) * sizeof(float));
    REQUIRE(view.byteOffset + view.byteLength <= model.buffers[0].data.size());
    std::memcpy(values.data(), model.buffers[0].data.data() + view.byteOffset, view.byteLength);
    return values;
}

/// Positions of `mesh` with the weights of key `key`, as a player would compute them.
Matrix3X<float> played(const tinygltf::Model& model, std::size_t mesh, Index key, const std::string& attribute) {
    const tinygltf::Primitive& primitive = model.meshes[mesh].primitives[0];
    MatrixX<float> values = floats(model, primitive.attributes.at(attribute));
    const MatrixX<float> weights = floats(model, model.animations[0].samplers[0].output);
    const auto targets = Index(primitive.targets.size());
    for (Index k = 0; k < targets; ++k) {
        const float weight = weights(0, key * targets + k);
        values += weight * floats(model, primitive.targets[std::size_t(k)].at(attribute));
    }
    return values;
}

}  // namespace

TEST_CASE("frames, normals, colours and placement come back from the file") {
    const TemporaryFolder folder;
    constexpr int num_frames = 5;
    const Matrix3X<float> colors = Matrix3X<float>::Constant(3, 4, 0.25F);
    GltfAnimation animation(30.0);
    const Index skinned = animation.add_mesh({.name = "skinned", .triangles = tetrahedron, .colors = colors});
    const Index simulated = animation.add_mesh(
        {.name = "simulated", .triangles = tetrahedron, .translation = {1.5, 0.0, 0.0}, .smooth_shading = false});
    const Index still = animation.add_mesh({.name = "still", .triangles = tetrahedron});
    animation.add_frame(still, frame(0));
    for (int t = 0; t < num_frames; ++t) {
        animation.add_frame(skinned, frame(t));
        animation.add_frame(simulated, frame(2 * t).cast<float>());
    }
    animation.write(folder / "a.glb");
    CHECK(folder.num_files() == 1);
    const tinygltf::Model model = load(folder / "a.glb");

    REQUIRE(model.meshes.size() == 3);
    REQUIRE(model.animations.size() == 1);
    CHECK(model.nodes[1].name == "simulated");
    CHECK(model.nodes[1].translation == std::vector<double>{1.5, 0.0, 0.0});
    CHECK(model.scenes[0].nodes == std::vector<int>{0, 1, 2});
    for (int t = 0; t < num_frames; ++t) {
        // Float32 rounds frame and difference by at most half an ulp of numbers below 8 each.
        const double tolerance = 4.0 * 8.0 * double(std::numeric_limits<float>::epsilon());
        CHECK((played(model, 0, t, "POSITION").cast<double>() - frame(t)).cwiseAbs().maxCoeff() < tolerance);
        CHECK((played(model, 1, t, "POSITION").cast<double>() - frame(2 * t)).cwiseAbs().maxCoeff() < tolerance);
        // The shortest edge is 1, so that positions off by this much turn a normal by a few times as much.
        const Matrix3X<double> normals = vertex_normals(frame(t), tetrahedron);
        CHECK((played(model, 0, t, "NORMAL").cast<double>() - normals).cwiseAbs().maxCoeff() < 4.0 * tolerance);
    }
    CHECK(model.meshes[1].primitives[0].attributes.count("NORMAL") == 0);
    CHECK(floats(model, model.meshes[0].primitives[0].attributes.at("COLOR_0")) == colors);
    CHECK(model.meshes[2].primitives[0].targets.empty());

    const tinygltf::AnimationSampler& sampler = model.animations[0].samplers[0];
    CHECK(sampler.interpolation == "LINEAR");
    const MatrixX<float> times = floats(model, sampler.input);
    CHECK(times(0, 3) == float(3.0 / 30.0));
    CHECK(model.accessors[std::size_t(sampler.input)].minValues == std::vector<double>{0.0});
    CHECK(model.accessors[std::size_t(sampler.input)].maxValues == std::vector<double>{double(times(0, 4))});
    CHECK(model.animations[0].channels.size() == 2);
    CHECK(model.animations[0].channels[1].target_node == 1);
    CHECK(model.animations[0].channels[1].target_path == "weights");
    // Every key shows exactly one frame.
    const MatrixX<float> weights = floats(model, sampler.output);
    CHECK(weights.cols() == num_frames * (num_frames - 1));
    CHECK(weights.sum() == float(num_frames - 1));
}

TEST_CASE("the file obeys what the specification asks of sizes, alignment and bounds") {
    const TemporaryFolder folder;
    GltfAnimation animation(24.0);
    const Index mesh = animation.add_mesh({.name = "m", .triangles = tetrahedron});
    animation.add_frame(mesh, frame(0));
    animation.add_frame(mesh, frame(1));
    animation.write(folder / "a.glb");
    const std::string file = read_bytes(folder / "a.glb");
    CHECK(file.starts_with("glTF"));
    std::uint32_t length = 0;
    std::memcpy(&length, file.data() + 8, 4);
    CHECK(length == file.size());
    CHECK(file.size() % 4 == 0);

    const tinygltf::Model model = load(folder / "a.glb");
    CHECK(model.asset.version == "2.0");
    std::size_t end = 0;
    for (const tinygltf::BufferView& view : model.bufferViews) {
        CHECK(view.byteOffset == end);  // nothing unused between
        CHECK(view.byteOffset % 4 == 0);
        end = view.byteOffset + view.byteLength;
    }
    CHECK(end == model.buffers[0].data.size());
    const tinygltf::Primitive& primitive = model.meshes[0].primitives[0];
    CHECK(primitive.mode == TINYGLTF_MODE_TRIANGLES);
    for (const int number : {primitive.attributes.at("POSITION"), primitive.targets[0].at("POSITION")}) {
        const tinygltf::Accessor& accessor = model.accessors[std::size_t(number)];
        const MatrixX<float> values = floats(model, number);
        for (Index d = 0; d < 3; ++d) {
            CHECK(accessor.minValues[std::size_t(d)] == double(values.row(d).minCoeff()));
            CHECK(accessor.maxValues[std::size_t(d)] == double(values.row(d).maxCoeff()));
        }
    }
    const tinygltf::Accessor& indices = model.accessors[std::size_t(primitive.indices)];
    CHECK(indices.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT);
    CHECK(indices.count == 12);
    CHECK(model.bufferViews[std::size_t(indices.bufferView)].target == TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
}

TEST_CASE("one frame makes a still picture, a vertex without normal gets one") {
    const TemporaryFolder folder;
    GltfAnimation animation(24.0);
    const Index mesh = animation.add_mesh({.name = "m", .triangles = tetrahedron});
    animation.add_frame(mesh, Matrix3X<double>::Zero(3, 4));
    animation.write(folder / "a.glb");
    const tinygltf::Model model = load(folder / "a.glb");
    CHECK(model.animations.empty());
    const MatrixX<float> normals = floats(model, model.meshes[0].primitives[0].attributes.at("NORMAL"));
    CHECK(normals.colwise().norm() == Eigen::RowVectorXf::Ones(4));
}

TEST_CASE("what cannot be shown is refused, and no file appears") {
    const TemporaryFolder folder;
    constexpr double infinity = std::numeric_limits<double>::infinity();
    CHECK(contains(refusal([] { GltfAnimation animation(0.0); }), "gltf: frame rate is 0, expected > 0"));
    CHECK(contains(refusal([] { GltfAnimation animation(infinity); }), "gltf: frame rate is inf"));
    GltfAnimation animation(30.0);
    CHECK(contains(refusal([&] { animation.add_mesh({.name = "m", .triangles = {}}); }), "mesh 'm' has no triangles"));
    const Index a = animation.add_mesh({.name = "a", .triangles = tetrahedron});
    const Index b = animation.add_mesh({.name = "b", .triangles = tetrahedron, .colors = Matrix3X<float>::Ones(3, 5)});
    const Index c =
        animation.add_mesh({.name = "c", .triangles = tetrahedron, .colors = Matrix3X<float>::Constant(3, 4, 2.0F)});
    const auto refused = [&](Index mesh, const Matrix3X<double>& x) {
        return refusal([&] { animation.add_frame(mesh, x); });
    };
    CHECK(contains(refused(3, frame(0)), "no mesh 3"));
    CHECK(contains(refused(-1, frame(0)), "no mesh -1"));
    CHECK(contains(refused(a, frame(0).leftCols(3)),
                   "mesh 'a' has triangles with vertices from 0 to 3, expected 0 to 2"));
    animation.add_frame(a, frame(0));
    CHECK(contains(refused(a, frame(0).leftCols(3)), "mesh 'a', frame 1 has 3 vertices, expected 4"));
    Matrix3X<double> broken = frame(1);
    broken(1, 2) = infinity;
    CHECK(contains(refused(a, broken), "mesh 'a', frame 1: vertex 2 is not finite"));
    broken(1, 2) = 1e300;  // finite as double, not in the file's float32
    CHECK(contains(refused(a, broken), "mesh 'a', frame 1: vertex 2 is not finite"));
    CHECK(contains(refused(b, frame(0)), "mesh 'b' has 5 colours, expected 4"));
    CHECK(contains(refused(c, frame(0)), "mesh 'c': colour of vertex 0 is 2 2 2, expected three values from 0 to 1"));
    CHECK(contains(refusal([&] { animation.write(folder / "a.glb"); }), "a.glb: gltf mesh 'b' has no frames"));

    GltfAnimation uneven(30.0);
    for (const int frames : {2, 3}) {
        const Index mesh = uneven.add_mesh({.name = std::to_string(frames), .triangles = tetrahedron});
        for (int t = 0; t < frames; ++t) {
            uneven.add_frame(mesh, frame(t));
        }
    }
    CHECK(contains(refusal([&] { uneven.write(folder / "a.glb"); }),
                   "mesh '3' has 3 frames, expected 2 as in the other meshes"));
    CHECK(contains(refusal([&] { GltfAnimation(30.0).write(folder / "a.glb"); }),
                   "expected a gltf animation with meshes"));
    CHECK(folder.num_files() == 0);
}

TEST_CASE("an animation is finished by its first writing, which may be repeated") {
    const TemporaryFolder folder;
    GltfAnimation animation(30.0);
    const Index mesh = animation.add_mesh({.name = "m", .triangles = tetrahedron});
    animation.add_frame(mesh, frame(0));
    CHECK(contains(refusal([&] { animation.write(folder / "none/a.glb"); }), "none/a.glb: cannot write"));
    CHECK(contains(refusal([&] { animation.add_frame(mesh, frame(1)); }), "no mesh 0 to add a frame to"));
    animation.write(folder / "a.glb");
    animation.write(folder / "b.glb");
    CHECK(read_bytes(folder / "a.glb") == read_bytes(folder / "b.glb"));

    GltfAnimation empty(30.0);
    empty.add_mesh({.name = "m", .triangles = tetrahedron});
    CHECK(contains(refusal([&] { empty.write(folder / "c.glb"); }), "has no frames"));
    CHECK(contains(refusal([&] { empty.write(folder / "c.glb"); }),
                   "expected a gltf animation with meshes whose frames fit"));
}
