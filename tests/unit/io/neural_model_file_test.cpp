// SPDX-License-Identifier: MIT
#include <softtissue/io/neural_model_file.hpp>

#include <support/limb_model.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

using namespace softtissue;
using namespace softtissue_test;

namespace {

const std::filesystem::path path =
    std::filesystem::temp_directory_path() / "softtissue_neural_model_file_test.safetensors";

std::string bytes_of_file() {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// The message for the model's file after `change` to tensors and metadata.
template <class Change>
std::string refusal_after(const Change& change) {
    write_neural_model(path, random_limb_model<float>({}, 1.0));
    const SafetensorsFile file = read_safetensors(path);
    NamedTensors tensors = file.tensors();
    TensorMetadata metadata = file.metadata();
    change(tensors, metadata);
    write_safetensors(path, tensors, metadata);
    try {
        read_neural_model<float>(path);
    } catch (const InvalidInput& error) {
        const std::string message = error.what();
        const std::string start = path.string() + ": ";
        return message.starts_with(start) ? message.substr(start.size()) : "other file: " + message;
    }
    return "";
}

std::string with_metadata(const std::string& key, const std::string& value) {
    return refusal_after([&](NamedTensors&, TensorMetadata& metadata) { metadata[key] = value; });
}

StoredTensor& tensor(NamedTensors& tensors, const std::string& name) {
    return std::find_if(tensors.begin(), tensors.end(), [&](const auto& item) { return item.first == name; })->second;
}

}  // namespace

TEST_CASE_TEMPLATE("what was written comes back, in all variants", N, float, double) {
    for (const NetworkOptions& options :
         {NetworkOptions{}, NetworkOptions{.exponential = false}, NetworkOptions{.rotation = false},
          NetworkOptions{.shape_input = false}, NetworkOptions{.kind = NetworkKind::vertex}}) {
        const NeuralModel<N> model = random_limb_model<N>(options, 1.0);
        write_neural_model(path, model);
        const NeuralModel<N> found = read_neural_model<N>(path);
        CHECK(found.name == model.name);
        CHECK(found.options == options);
        CHECK(found.body == model.body);
        CHECK(found.notes == model.notes);
        CHECK(found.mlp.parameters() == model.mlp.parameters());
        CHECK(found.mlp.sizes().hidden == model.mlp.sizes().hidden);
        CHECK(found.shape_space.components().components == model.shape_space.components().components);
        CHECK(found.shape_space.components().mean == model.shape_space.components().mean);
        const std::string bytes = bytes_of_file();
        write_neural_model(path, found);
        CHECK(bytes_of_file() == bytes);
    }
}

TEST_CASE("a decoder behind the network is folded into it") {
    const NeuralModel<float> model = random_limb_model<float>({}, 1.0);
    write_neural_model(path, model);
    const SafetensorsFile file = read_safetensors(path);
    NamedTensors tensors = file.tensors();
    Mlp<float> small({.inputs = 11, .hidden = {16, 8}, .outputs = 5});
    small.initialize(4);
    std::erase_if(tensors, [](const auto& item) { return item.first.starts_with("net."); });
    store_network(small, "net.", tensors);
    LinearDecoder<float> decoder{MatrixX<float>::Constant(3240, 5, 0.1F), VectorX<float>::LinSpaced(3240, 0, 1)};
    decoder.weight.col(2).setLinSpaced(3240, -1, 1);
    tensors.emplace_back("decoder.weight", StoredTensor::from_matrix(decoder.weight));
    tensors.emplace_back("decoder.bias", StoredTensor::from_vector(decoder.bias));
    write_safetensors(path, tensors, file.metadata());
    const NeuralModel<float> found = read_neural_model<float>(path);
    CHECK(found.mlp.parameters() == fold_decoder(small, decoder).parameters());
}

TEST_CASE("a decoder that would make far more weights than the file has is refused") {
    const std::string message = refusal_after([](NamedTensors& tensors, TensorMetadata&) {
        std::erase_if(tensors, [](const auto& item) { return item.first.starts_with("net."); });
        store_network(Mlp<float>({.inputs = 11, .hidden = {65}, .outputs = 1}), "net.", tensors);
        tensors.emplace_back("decoder.weight", StoredTensor::from_matrix(MatrixX<float>::Zero(3240, 1)));
        tensors.emplace_back("decoder.bias", StoredTensor::from_vector(VectorX<float>::Zero(3240)));
    });
    CHECK(message == "a decoder of 1 coefficients behind a layer of 65, expected at least one for 64");
}

TEST_CASE("what is no model, or not this one, is refused with one message") {
    CHECK(refusal_after([](NamedTensors&, TensorMetadata&) {}).empty());
    CHECK(with_metadata("softtissue_model", "2") == "softtissue_model is '2', expected '1'");
    CHECK(with_metadata("dtype", "F64") == "dtype is 'F64', expected 'F32'");
    CHECK(with_metadata("activation", "relu") == "activation is 'relu', expected 'gelu'");
    CHECK(with_metadata("kind", "mesh") == "kind is 'mesh', expected 'gradient' or 'vertex'");
    CHECK(with_metadata("rotation", "yes") == "rotation is 'yes', expected 'true' or 'false'");
    CHECK(with_metadata("num_cells", "36O") == "num_cells is '36O', expected a whole number");
    CHECK(with_metadata("num_cells", "361") == "a network of 3240 outputs, expected nine for each of 361 cells");
    CHECK(with_metadata("num_cells", "9223372036854775807").find("expected a whole number") != std::string::npos);
    CHECK(with_metadata("num_vertices", "-1") == "num_vertices is '-1', expected a whole number");
    CHECK(with_metadata("parents", "[-1, 4294967296]") ==
          "parents is '[-1, 4294967296]', expected a list of whole numbers");
    CHECK(with_metadata("parents", "[-1, 0.5]") == "parents is '[-1, 0.5]', expected a list of whole numbers");
    CHECK(with_metadata("parents", "[-1") == "parents is '[-1', expected a list of whole numbers");
    CHECK(with_metadata("joint_names", "[1, 2]") == "joint_names is '[1, 2]', expected a list of texts");
    CHECK(with_metadata("joint_names", "[\"upper\"]") == "1 joint names for 2 parents");
    CHECK(with_metadata("shape_input", "false") == "tensor 'shape_space.components' is none of a model's");
    CHECK(refusal_after([](NamedTensors&, TensorMetadata& metadata) { metadata.erase("connectivity"); }) ==
          "metadata 'connectivity' is missing");
    CHECK(refusal_after([](NamedTensors& tensors, TensorMetadata&) { tensors.pop_back(); }) ==
          "tensor 'shape_space.standard_deviations' is missing");
    CHECK(refusal_after([](NamedTensors& tensors, TensorMetadata&) {
              tensors.emplace_back("extra", StoredTensor::from_vector(VectorX<float>::Zero(1)));
          }) == "tensor 'extra' is none of a model's");
    CHECK(refusal_after([](NamedTensors& tensors, TensorMetadata&) {
              StoredTensor& weight = tensor(tensors, "net.3.bias");
              weight = StoredTensor::from_vector(weight.vector<double>());
          }) == "tensor 'net.3.bias': is of another type than the model's F32");
    CHECK(refusal_after([](NamedTensors& tensors, TensorMetadata&) {
              StoredTensor& mean = tensor(tensors, "shape_space.mean");
              mean = StoredTensor::from_vector(VectorX<double>::Zero(897));
          }).find("shape space") != std::string::npos);
    CHECK_FALSE(refusal_after([](NamedTensors& tensors, TensorMetadata&) {
                    StoredTensor& bias = tensor(tensors, "net.0.bias");
                    VectorX<float> values = bias.vector<float>();
                    values(3) = std::numeric_limits<float>::infinity();
                    bias = StoredTensor::from_vector(values);
                }).empty());
}

TEST_CASE("a file that is cut off anywhere, or changed in its header, is refused or changes nothing that was said") {
    write_neural_model(path, random_limb_model<float>({.kind = NetworkKind::vertex, .shape_input = false}, 1.0));
    const std::string bytes = bytes_of_file();
    const auto write = [&](const std::string& content) {
        std::ofstream(path, std::ios::binary).write(content.data(), std::streamsize(content.size()));
    };
    for (const size_t length : {size_t(0), size_t(7), size_t(100), bytes.size() / 2, bytes.size() - 1}) {
        write(bytes.substr(0, length));
        CHECK_THROWS_AS(read_neural_model<float>(path), InvalidInput);
    }
    write(bytes);
    CHECK_NOTHROW(read_neural_model<float>(path));
    CHECK_THROWS_AS(read_neural_model<double>(path), InvalidInput);
    std::filesystem::remove(path);
    CHECK_THROWS_AS(read_neural_model<float>(path), InvalidInput);
}
