// SPDX-License-Identifier: MIT
/// @file
/// The parameters of networks in .safetensors files, under the names that PyTorch gives them.
///
/// What        store_parameters / load_parameters_into: any tensors that lie in one vector; store_network / load_network: a
///             whole perceptron, whose sizes are those of the tensors found.
/// Names       prefix + "0.weight", "0.bias", "1.weight", "1.bias", "3.weight", ...: linear layers and normalisations of
///             Sequential(Linear, LayerNorm, GELU, Linear, ...). Activations have no tensors: the caller knows which it is.
/// Valid       any real element type is converted to S, rounded to nearest.
/// Refuses     tensors that are missing, of another shape, not real, not finite or too large for S; tensors under the
///             prefix that the network does not have (InvalidInput names file and tensor).
/// Example     const Mlp<float> network = load_network<float>(read_safetensors("model.safetensors"), "net.");
///             NamedTensors tensors;
///             store_network(network, "net.", tensors);
///             write_safetensors("again.safetensors", tensors);
/// Needs       nlohmann-json
/// Tests       tests/unit/io/network_file_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/io/safetensors.hpp>
#include <softtissue/nn/concepts.hpp>
#include <softtissue/nn/gelu.hpp>
#include <softtissue/nn/mlp.hpp>
#include <softtissue/nn/parameter_tensor.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace softtissue {

/// Appends the tensors that lie in `parameters`.
template <RealScalar S>
void store_parameters(const std::vector<ParameterTensor>& layout, const VectorX<S>& parameters,
                      const std::string& prefix, NamedTensors& tensors) {
    for (const ParameterTensor& tensor : layout) {
        const std::span<const S> values(parameters.data() + tensor.offset, std::size_t(tensor.size()));
        tensors.emplace_back(prefix + tensor.name, StoredTensor::from_values(values, tensor.shape));
    }
}

/// Fills the places of `layout` in `parameters` from the tensors of `file` under `prefix`.
template <RealScalar S>
void load_parameters_into(const SafetensorsFile& file, const std::string& prefix,
                          const std::vector<ParameterTensor>& layout, VectorX<S>& parameters) {
    for (const ParameterTensor& tensor : layout) {
        const StoredTensor& stored = file.at(prefix + tensor.name);
        stored.require_shape(tensor.shape);
        const std::span<S> values(parameters.data() + tensor.offset, std::size_t(tensor.size()));
        require(is_real(stored.type()), stored.source(), ": holds whole numbers, expected real ones");
        stored.copy_into(values);
        for (std::size_t i = 0; i < values.size(); ++i) {
            require(std::isfinite(values[i]), stored.source(), ": element ", i, " is ", values[i],
                    ", expected a finite number");
        }
    }
    for (const auto& [name, values] : file.tensors()) {
        const bool is_known =
            !name.starts_with(prefix) ||
            std::any_of(layout.begin(), layout.end(), [&name = name, &prefix](const ParameterTensor& tensor) {
                return name.substr(prefix.size()) == tensor.name;
            });
        require(is_known, file.path(), ": tensor '", name, "' does not belong to the network");
    }
}

/// The sizes of the perceptron whose tensors lie in `file` under `prefix`.
inline MlpSizes stored_network_sizes(const SafetensorsFile& file, const std::string& prefix) {
    constexpr int modules_per_layer = 3;  // linear layer, normalisation, activation
    MlpSizes sizes;
    std::vector<Index> outputs;
    for (int module = 0; module == 0 || file.contains(prefix + std::to_string(module) + ".weight");
         module += modules_per_layer) {
        const StoredTensor& weight = file.at(prefix + std::to_string(module) + ".weight");
        const Index inputs = module == 0 ? StoredTensor::any : outputs.back();
        weight.require_shape({StoredTensor::any, inputs});
        require(weight.num_elements() > 0, weight.source(), ": is empty");
        sizes.inputs = module == 0 ? weight.shape()[1] : sizes.inputs;
        outputs.push_back(weight.shape()[0]);
    }
    sizes.outputs = outputs.back();
    sizes.hidden.assign(outputs.begin(), outputs.end() - 1);
    return sizes;
}

/// Appends all tensors of `network`.
template <RealScalar S, Activation A>
void store_network(const Mlp<S, A>& network, const std::string& prefix, NamedTensors& tensors) {
    store_parameters(network.tensors(), network.parameters(), prefix, tensors);
}

/// The network in `file` under `prefix`.
template <RealScalar S, Activation A = Gelu>
Mlp<S, A> load_network(const SafetensorsFile& file, const std::string& prefix) {
    Mlp<S, A> network(stored_network_sizes(file, prefix));
    load_parameters_into(file, prefix, network.tensors(), network.parameters());
    return network;
}

}  // namespace softtissue
