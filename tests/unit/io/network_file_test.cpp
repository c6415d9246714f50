// SPDX-License-Identifier: MIT
#include <softtissue/io/network_file.hpp>

#include "io_test_support.hpp"

#include <support/reference_case.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

using namespace softtissue;
using namespace io_test;

namespace {

template <class S>
Mlp<S> sample_network(std::uint64_t seed = 1) {
    Mlp<S> network({.inputs = 3, .hidden = {4, 2}, .outputs = 5});
    network.initialize(seed);
    return network;
}

template <class S>
NamedTensors tensors_of(const Mlp<S>& network, const std::string& prefix = "net.") {
    NamedTensors tensors;
    store_network(network, prefix, tensors);
    return tensors;
}

/// The refusal of the sample with one tensor replaced.
std::string refused_with(const std::string& name, const StoredTensor& replacement) {
    NamedTensors tensors = tensors_of(sample_network<double>());
    for (auto& [other, tensor] : tensors) {
        if (other == name) {
            tensor = replacement;
        }
    }
    const SafetensorsFile file("f", std::move(tensors), {});
    return refusal([&] { static_cast<void>(load_network<float>(file, "net.")); });
}

}  // namespace

TEST_CASE_TEMPLATE("a network comes back to the bit, under PyTorch's names", S, float, double) {
    const TemporaryFolder folder;
    const Mlp<S> network = sample_network<S>();
    write_safetensors(folder / "a.safetensors", tensors_of(network), {{"format", "pt"}});
    const SafetensorsFile file = read_safetensors(folder / "a.safetensors");
    std::vector<std::string> names;
    for (const auto& [name, tensor] : file.tensors()) {
        names.push_back(name);
    }
    CHECK(names == std::vector<std::string>{"net.0.weight", "net.0.bias", "net.1.weight", "net.1.bias", "net.3.weight",
                                            "net.3.bias", "net.4.weight", "net.4.bias", "net.6.weight", "net.6.bias"});
    CHECK(file.at("net.3.weight").shape() == std::vector<Index>{2, 4});
    CHECK(file.at("net.3.weight").template matrix<S>() == MatrixX<S>(network.weight(1)));
    const Mlp<S> again = load_network<S>(file, "net.");
    CHECK(again.sizes().inputs == 3);
    CHECK(again.sizes().hidden == std::vector<Index>{4, 2});
    CHECK(again.sizes().outputs == 5);
    CHECK(again.parameters() == network.parameters());
}

TEST_CASE("weights of other precision are converted, several networks share a file") {
    NamedTensors tensors = tensors_of(sample_network<double>(), "a.");
    for (const auto& entry : tensors_of(sample_network<float>(2), "b.")) {
        tensors.push_back(entry);
    }
    const SafetensorsFile file("f", std::move(tensors), {});
    CHECK(load_network<float>(file, "a.").parameters() == sample_network<double>().parameters().cast<float>());
    CHECK(load_network<double>(file, "b.").parameters() == sample_network<float>(2).parameters().cast<double>());
}

TEST_CASE("one linear layer is a network") {
    Mlp<double> network({.inputs = 2, .hidden = {}, .outputs = 3});
    network.initialize(4);
    const SafetensorsFile file("f", tensors_of(network, ""), {});
    CHECK(load_network<double>(file, "").parameters() == network.parameters());
}

TEST_CASE("tensors that are missing, do not fit or make no sense are refused") {
    const StoredTensor zeros = StoredTensor::from_matrix(MatrixX<double>::Zero(2, 5));
    CHECK(contains(refused_with("net.3.weight", zeros), "shape is (2, 5), expected (any, 4)"));
    CHECK(contains(refused_with("net.1.bias", StoredTensor::from_vector(VectorX<double>::Zero(5))),
                   "shape is (5,), expected (4,)"));
    VectorX<double> bias = VectorX<double>::Zero(4);
    bias(2) = std::numeric_limits<double>::quiet_NaN();
    CHECK(contains(refused_with("net.0.bias", StoredTensor::from_vector(bias)), "element 2 is nan, expected a finite"));
    bias(2) = 1e300;
    CHECK(contains(refused_with("net.0.bias", StoredTensor::from_vector(bias)), "element 2 is 1e+300, too large"));
    const std::vector<std::int32_t> whole(4);
    CHECK(contains(refused_with("net.0.bias", StoredTensor::from_values(std::span<const std::int32_t>(whole), {4})),
                   "holds whole numbers, expected real ones"));
    CHECK(contains(refused_with("net.0.weight", StoredTensor::from_matrix(MatrixX<double>::Zero(4, 0))), "is empty"));

    const auto refused = [](const NamedTensors& tensors) {
        const SafetensorsFile file("f", tensors, {});
        return refusal([&] { static_cast<void>(load_network<double>(file, "net.")); });
    };
    CHECK(refused({}) == "f: tensor 'net.0.weight' is missing");
    NamedTensors tensors = tensors_of(sample_network<double>());
    for (std::size_t i = 0; i < tensors.size(); ++i) {
        CAPTURE(tensors[i].first);
        NamedTensors others = tensors;
        others.erase(others.begin() + std::ptrdiff_t(i));
        CHECK(contains(refused(others), "f: "));
    }
    tensors.emplace_back("net.7.weight", zeros);
    CHECK(contains(refused(tensors), "f: tensor 'net.7.weight' does not belong to the network"));
    tensors.back().first = "mean";
    CHECK(refused(tensors).empty());
}

TEST_CASE("a network trained with PyTorch gives the outputs it gave there") {
    const std::filesystem::path path =
        std::filesystem::path(SOFTTISSUE_SHARED_DIR) / "reference" / "o5_mlp_f64.safetensors";
    const auto reference = softtissue_test::reference_case("o5_mlp_f64.npz");
    if (!reference || !std::filesystem::exists(path)) {
        return;
    }
    const Mlp<double> network = load_network<double>(read_safetensors(path), "net.");
    const MatrixX<double> inputs = reference->at("x").matrix<double>().transpose();
    MatrixX<double> outputs(network.sizes().outputs, inputs.cols());
    auto scratch = network.make_scratch(inputs.cols());
    network.infer_into(inputs, scratch, outputs);
    CHECK(outputs.allFinite());
    CHECK(network.sizes().inputs == 30);
    const NpyArray& activations = reference->at("act.9");
    CHECK((outputs - activations.matrix<double>().transpose()).norm() < 1e-12 * outputs.norm());
}
