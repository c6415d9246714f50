// SPDX-License-Identifier: MIT
// Writes the seeds of the corpora: for each target the smallest files that its reader accepts, made by the library's own
// writers where it has them.   softtissue_fuzz_seeds tests/fuzz/corpus
#include "container.hpp"

#include <softtissue/io/amass_file.hpp>
#include <softtissue/io/dataset_plan_file.hpp>
#include <softtissue/io/layered_body_file.hpp>
#include <softtissue/io/neural_model_file.hpp>
#include <softtissue/io/sample_file.hpp>
#include <softtissue/io/smpl_file.hpp>
#include <softtissue/io/training_state_file.hpp>

#include "../unit/io/gltf_test_file.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

using namespace softtissue;
using io_test::read_bytes;
using io_test::write_bytes;

namespace {

/// The folder of a target's seeds.
std::filesystem::path corpus(const std::filesystem::path& root, const char* target) {
    std::filesystem::create_directories(root / target);
    return root / target;
}

SmplBody<double> octahedron() {
    SmplBody<double> body;
    body.template_vertices.resize(3, 6);
    body.template_vertices << 1, -1, 0, 0, 0, 0, 0, 0, 1, -1, 0, 0, 0, 0, 0, 0, 1, -1;
    body.faces.resize(3, 8);
    body.faces << 0, 2, 1, 3, 2, 1, 3, 0, 2, 1, 3, 0, 0, 2, 1, 3, 4, 4, 4, 4, 5, 5, 5, 5;
    body.tree = KinematicTree({-1, 0});
    MatrixX<double> weights(6, 2);
    weights << 1, 0, 0, 1, 0.5, 0.5, 0.25, 0.75, 0, 1, 1, 0;
    body.weights = SkinningWeights<double>(weights);
    body.joint_regressor.resize(2, 6);
    body.joint_regressor.insert(0, 1) = 1.0;
    body.joint_regressor.insert(1, 3) = 1.0;
    body.shape_directions = MatrixX<double>::Constant(18, 1, 0.1);
    body.pose_directions.resize(18, 9);
    body.pose_directions.insert(4, 2) = 0.25;
    body.joint_names = {"pelvis", "knee"};
    return body;
}

/// One triangle of skin over muscle over bone.
SkeletalLayers<double> triangle_body() {
    SkeletalLayers<double> file;
    LayeredBody<double>& body = file.body.layered;
    body.layers = {3, 2};
    body.mesh.rest_positions.resize(3, 9);
    body.mesh.rest_positions << 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 1, 1, 2, 2, 2;
    body.mesh.cells.resize(6, 2);
    body.mesh.cells << 0, 3, 1, 4, 2, 5, 3, 6, 4, 7, 5, 8;
    body.weights = SkinningWeights<double>(MatrixX<double>::Constant(9, 2, 0.5));
    body.prescribed = {0, 1, 2};
    SimulatedRegion<double>& region = body.region;
    region.triangles.resize(3, 1);
    region.triangles << 0, 1, 2;
    region.body_triangles = {0};
    region.body_vertices = region.region_vertices = {0, 1, 2};
    region.loops = {{0, 1, 2}};
    region.cut_distance = VectorX<double>::Zero(3);
    body.skin_offsets = Matrix3X<double>::Zero(3, 3);
    file.body.joints = Matrix3X<double>::Identity(3, 2);
    file.tree = KinematicTree({-1, 0});
    file.joint_names = {"upper", "lower"};
    return file;
}

DatasetPlan small_plan() {
    DatasetPlan plan;
    plan.clips = {"walk"};
    plan.bodies = {{DatasetSplit::train, VectorX<double>::Zero(2)}, {DatasetSplit::test, VectorX<double>::Ones(2)}};
    plan.poses = {{DatasetSplit::train, Pose<double>::rest(2), {0, 1, 0, 2}, 0.05}};
    plan.samples = {{DatasetSplit::train, 0, 0}, {DatasetSplit::test, 1, 0}};
    return plan;
}

DatasetSample small_sample() {
    DatasetSample sample;
    sample.pose = Pose<double>::rest(2);
    sample.betas = VectorX<double>::Zero(2);
    sample.positions = triangle_body().body.layered.mesh.rest_positions;
    sample.status = "converged";
    return sample;
}

void write_npz_seeds(const std::filesystem::path& root) {
    NpyArrays arrays;
    arrays["real"] = NpyArray::from_columns(Matrix3X<double>::Identity(3, 2));
    arrays["text"] = NpyArray::from_strings({"a", "bc"}, {2});
    arrays["whole"] = NpyArray::from_values(std::span<const std::int32_t>(std::vector<std::int32_t>{1, -2, 3}), {3});
    arrays["byte"] = NpyArray::from_scalar(std::uint8_t(7));
    for (const auto& [name, array] : arrays) {
        const auto bytes = array.file_bytes();
        write_bytes(corpus(root, "npy") / (name + ".npy"), std::string(bytes.begin(), bytes.end()));
    }
    write_bytes(corpus(root, "npy") / "fortran.npy",
                io_test::npy_image("{'fortran_order': True, 'shape': (2, 3L), 'descr': \">i2\"}", "abcdefghijkl"));
    write_bytes(corpus(root, "npy") / "records.npy",
                io_test::npy_image("{'descr': [('a', '<f8')], 'fortran_order': False, 'shape': (1,), }", "12345678"));
    write_npz(corpus(root, "npz") / "stored.npz", arrays);
    write_npz(corpus(root, "npz") / "deflated.npz", arrays, NpzCompression::deflated);

    AmassClip<double> clip;
    clip.motion = {{Pose<double>::rest(2), Pose<double>::rest(2)}, 60.0};
    clip.gender = "female";
    clip.betas = VectorX<double>::Ones(3);
    write_amass_clip(corpus(root, "amass") / "two_joints.npz", clip);
    clip.motion.poses.assign(1, Pose<double>::rest(52));
    write_amass_clip(corpus(root, "amass") / "hands.npz", clip);

    write_smpl_body(corpus(root, "smpl") / "body.npz", octahedron(), NpzCompression::stored);
    NpyArrays dense = read_npz(root / "smpl" / "body.npz").arrays();
    for (const char* part : {"_data", "_indices", "_indptr", "_shape"}) {
        dense.erase(std::string("posedirs") + part);
    }
    dense["posedirs"] = NpyArray::from_values(std::span<const float>(std::vector<float>(6 * 3 * 9, 0.5F)), {6, 3, 9});
    write_npz(root / "smpl" / "dense.npz", dense);

    write_layered_body(corpus(root, "layered_body") / "body.npz", triangle_body());
    write_sample(corpus(root, "sample") / "sample.npz", small_sample());
    write_dataset_plan(corpus(root, "dataset_plan") / "plan.npz", small_plan());
    const auto folder = corpus(root, "dataset_folder");
    std::vector<softtissue_fuzz::Part> all{{"plan.json", R"({"format": 1, "kind": "seed", "reason": "none"})"}};
    for (const auto& file :
         {root / "layered_body" / "body.npz", root / "sample" / "sample.npz", root / "dataset_plan" / "plan.npz"}) {
        const auto parts = split(softtissue_fuzz::Container::npz, read_bytes(file));
        all.insert(all.end(), parts->begin(), parts->end());
    }
    write_bytes(folder / "all.npz", join(softtissue_fuzz::Container::npz, all));
}

void write_tensor_seeds(const std::filesystem::path& root) {
    const std::vector<float> four{0.5F, -1.0F, 2.0F, 3.0F};
    write_safetensors(corpus(root, "safetensors") / "types.safetensors",
                      {{"half", StoredTensor::from_values(std::span(four), {2, 2}, TensorType::f16)},
                       {"brain", StoredTensor::from_values(std::span(four), {4}, TensorType::bf16)},
                       {"single", StoredTensor::from_values(std::span(four), {4, 1})},
                       {"whole", StoredTensor::from_values(std::span(four).subspan(1, 0), {0}, TensorType::i64)}},
                      {{"format", "pt"}});
    Mlp<float> network({.inputs = 9, .hidden = {2}, .outputs = 9});
    network.initialize(1);
    NamedTensors tensors;
    store_network(network, "net.", tensors);
    write_safetensors(corpus(root, "network") / "network.safetensors", tensors);

    const BodyIdentity body{{"upper", "lower"}, {-1, 0}, 2, 1, 7};
    const NetworkOptions fixed_shape{.shape_input = false};
    const NeuralModel<float> plain{"plain", fixed_shape, network, {}, body, {{"by", "seed"}}};
    write_neural_model(corpus(root, "neural_model") / "plain.safetensors", plain);
    Mlp<float> shaped({.inputs = 10, .hidden = {2}, .outputs = 9});
    shaped.initialize(2);
    const ShapeSpace<double> shapes({VectorX<double>::Zero(6), MatrixX<double>::Ones(6, 1), VectorX<double>::Ones(1)});
    write_neural_model(root / "neural_model" / "shaped.safetensors",
                       NeuralModel<float>{"shaped", {}, shaped, shapes, body, {}});
    const SafetensorsFile file = read_safetensors(root / "neural_model" / "plain.safetensors");
    NamedTensors decoded = file.tensors();
    decoded.emplace_back("decoder.weight", StoredTensor::from_matrix(MatrixX<float>::Identity(9, 9)));
    decoded.emplace_back("decoder.bias", StoredTensor::from_vector(VectorX<float>::Zero(9)));
    write_safetensors(root / "neural_model" / "decoder.safetensors", decoded, file.metadata());

    TrainingState<float> state;
    state.parameters = state.first_moment = state.second_moment = state.best_parameters = VectorX<float>::Ones(3);
    state.training_losses = state.validation_losses = {1.0, 0.5};
    write_training_state(corpus(root, "training_state") / "state.safetensors", state, {{"description", "seed"}});
}

void write_text_seeds(const std::filesystem::path& root) {
    const io_test::GltfFile bar = io_test::rigged_bar();
    bar.write(corpus(root, "gltf") / "bar.glb");
    write_bytes(root / "gltf" / "bar.gltf", bar.embedded());
    nlohmann::json beside = {{"asset", {{"version", "2.0"}}}};
    beside["buffers"] = {{{"byteLength", 64}, {"uri", "buffer.bin"}}};
    beside["bufferViews"] = {{{"buffer", 0}, {"byteLength", 48}}};
    beside["accessors"] = {{{"bufferView", 0},
                            {"componentType", 5123},
                            {"normalized", true},
                            {"count", 3},
                            {"type", "VEC3"},
                            {"sparse",
                             {{"count", 1},
                              {"indices", {{"bufferView", 0}, {"byteOffset", 8}, {"componentType", 5121}}},
                              {"values", {{"bufferView", 0}}}}}}};
    write_bytes(root / "gltf" / "sparse.gltf", beside.dump());
    write_bytes(corpus(root, "json_element") / "all.json",
                R"({"a": [1, 2.5, -3, {"b": true}], "b": {"c": "text"}, "c": [1e3, 4.0, null]})");
    write_bytes(corpus(root, "joint_names") / "names.json", R"({"a": "pelvis", "c": "left_foot"})");
    write_bytes(
        corpus(root, "bvh") / "arm.bvh",
        "HIERARCHY\nROOT Hips\n{\n OFFSET 0 1 0\n CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation "
        "Yrotation\n JOINT Left Arm\n {\n  OFFSET 10 0 0\n  CHANNELS 3 Zrotation Xrotation Yrotation\n  End Site\n"
        "  {\n   OFFSET 5 0 0\n  }\n }\n}\nMOTION\nFrames: 2\nFrame Time: 0.0333\n0 0 0 0 0 0 1 2 3\n"
        "1e1 -0.5 0 90 0 -45 +1 2 3\n");
    write_bytes(corpus(root, "obj") / "faces.obj",
                "# seed\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1e0 -0.5\nvn 0 0 1\nf 1//1 2//1 3//1 4//1\nf -4 -3/2 -1/2/1\n");
    for (int kind = 0; kind < 7; ++kind) {  // of what is compared
        std::string bytes(1, static_cast<char>(kind));
        for (int k = 0; k < 96; ++k) {
            bytes += static_cast<char>((37 * k * (kind + 1)) % (k % 5 == 0 ? 212 : 160));
        }
        write_bytes(corpus(root, "agreement") / std::to_string(kind), bytes);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        return 2;
    }
    write_npz_seeds(argv[1]);
    write_tensor_seeds(argv[1]);
    write_text_seeds(argv[1]);
    return 0;
}
