// SPDX-License-Identifier: MIT
/// @file
/// Trained animation models in files (.safetensors).
///
/// What        tensors   net.0.weight, net.0.bias, net.1.weight, ...: the network, as PyTorch names a Sequential of Linear,
///                       LayerNorm and GELU (exact)
///                       decoder.weight (outputs, coefficients), decoder.bias: optional on reading, a fixed linear decoder behind
///                       the network, folded into its last layer
///                       shape_space.mean (3 V), .components (3 V, d), .standard_deviations (d): with shape input only, F64
///             metadata  softtissue_model "1", name, kind "gradient" or "vertex", activation "gelu", dtype "F32" or "F64" (of the
///                       network), exponential, rotation, shape_input "true" or "false", joint_names and parents (JSON lists),
///                       num_vertices, num_cells, connectivity (16 hexadecimal digits, see body_identity.hpp), and note.* for
///                       people
/// Valid       what PyTorch trained, saved with these names and metadata (safetensors.torch.save_file)
/// Refuses     what read_safetensors() refuses; metadata or tensors that are missing, of another form or that do not fit
///             together, an unknown tensor, a network of another type than asked for, numbers that are not finite
///             (InvalidInput names the file and what is wrong). Another body is refused where the model meets it.
/// Needs       nlohmann-json
/// Tests       tests/unit/io/neural_model_file_test.cpp
#pragma once

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/core/scalar.hpp>
#include <softtissue/io/network_file.hpp>
#include <softtissue/io/safetensors.hpp>
#include <softtissue/ndg/linear_decoder.hpp>
#include <softtissue/ndg/neural_model.hpp>
#include <softtissue/nn/mlp.hpp>

#include <nlohmann/json.hpp>

#include <charconv>
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace softtissue {

namespace detail {

inline constexpr const char* neural_model_format = "1";

template <RealScalar N>
constexpr const char* dtype_name() {
    return std::is_same_v<N, float> ? "F32" : "F64";
}

inline std::string connectivity_text(std::uint64_t hash) {
    std::string text(16, '0');
    for (size_t k = 16; k-- > 0; hash >>= 4U) {
        text[k] = "0123456789abcdef"[hash & 15U];
    }
    return text;
}

/// Reads metadata, each kind of value with one message.
class ModelMetadata {
public:
    explicit ModelMetadata(const SafetensorsFile& file) : file_(&file) {}

    const std::string& text(const char* key) const { return file_->metadata_at(key); }

    void require_text(const char* key, const std::string& expected) const {
        require(text(key) == expected, file_->path(), ": ", key, " is '", text(key), "', expected '", expected, "'");
    }

    bool flag(const char* key) const {
        require(text(key) == "true" || text(key) == "false", file_->path(), ": ", key, " is '", text(key),
                "', expected 'true' or 'false'");
        return text(key) == "true";
    }

    template <class Integer>
    Integer number(const char* key, int base = 10) const {
        Integer value = 0;
        const std::string& from = text(key);
        const auto [end, error] = std::from_chars(from.data(), from.data() + from.size(), value, base);
        require(error == std::errc() && end == from.data() + from.size(), file_->path(), ": ", key, " is '", from,
                "', expected a whole number");
        return value;
    }

    template <class T>
    std::vector<T> list(const char* key) const {
        const nlohmann::json json = nlohmann::json::parse(text(key), nullptr, false);
        bool fits = json.is_array();
        std::vector<T> result;
        for (const nlohmann::json& item : json) {
            fits = fits && is_a<T>(item);
            if (fits) {
                result.push_back(item.get<T>());
            }
        }
        require(fits, file_->path(), ": ", key, " is '", text(key), "', expected a list of ",
                std::is_same_v<T, std::string> ? "texts" : "whole numbers");
        return result;
    }

private:
    template <class T>
    static bool is_a(const nlohmann::json& item) {
        if constexpr (std::is_same_v<T, std::string>) {
            return item.is_string();
        } else {
            return item.is_number_unsigned() ? std::in_range<T>(item.get<std::uint64_t>())
                                             : item.is_number_integer() && std::in_range<T>(item.get<std::int64_t>());
        }
    }

    const SafetensorsFile* file_;
};

/// The network of tensors "net.*"; takes their names out of `unread`.
template <RealScalar N>
Mlp<N> read_network(const SafetensorsFile& file, std::set<std::string>& unread) {
    Mlp<N> mlp = load_network<N>(file, "net.");
    for (const ParameterTensor& tensor : mlp.tensors()) {
        const StoredTensor& stored = file.at("net." + tensor.name);
        require(stored.type() == (std::is_same_v<N, float> ? TensorType::f32 : TensorType::f64), stored.source(),
                ": is of another type than the model's ", dtype_name<N>());
        unread.erase("net." + tensor.name);
    }
    return mlp;
}

/// The folded layer has as many columns as the layer before has outputs, the decoder as many as the network has.
template <RealScalar N>
void require_foldable(const SafetensorsFile& file, const Mlp<N>& mlp) {
    constexpr Index max_expansion = 64;  // what a file can make a program allocate is bounded by its size
    const Index columns = mlp.weight(mlp.layers().num_hidden()).cols();
    require(columns <= max_expansion * mlp.sizes().outputs, file.path(), ": a decoder of ", mlp.sizes().outputs,
            " coefficients behind a layer of ", columns, ", expected at least one for ", max_expansion);
}

inline ShapeSpace<double> read_shape_space(const SafetensorsFile& file, std::set<std::string>& unread) {
    PrincipalComponents<double> components;
    components.mean = file.at("shape_space.mean").vector<double>();
    components.components = file.at("shape_space.components").matrix<double>();
    components.standard_deviations = file.at("shape_space.standard_deviations").vector<double>();
    for (const char* name : {"shape_space.mean", "shape_space.components", "shape_space.standard_deviations"}) {
        unread.erase(name);
    }
    return ShapeSpace<double>(std::move(components));
}

}  // namespace detail

/// Writes a model; the same model gives the same bytes.
template <RealScalar N>
void write_neural_model(const std::filesystem::path& path, const NeuralModel<N>& model) {
    model.validate(path.string());
    NamedTensors tensors;
    store_network(model.mlp, "net.", tensors);
    if (model.options.shape_input) {
        const PrincipalComponents<double>& components = model.shape_space.components();
        tensors.emplace_back("shape_space.mean", StoredTensor::from_vector(components.mean));
        tensors.emplace_back("shape_space.components", StoredTensor::from_matrix(components.components));
        tensors.emplace_back("shape_space.standard_deviations",
                             StoredTensor::from_vector(components.standard_deviations));
    }
    const auto flag = [](bool value) { return value ? "true" : "false"; };
    TensorMetadata metadata{{"softtissue_model", detail::neural_model_format},
                            {"name", model.name},
                            {"kind", model.options.kind == NetworkKind::gradient ? "gradient" : "vertex"},
                            {"activation", "gelu"},
                            {"dtype", detail::dtype_name<N>()},
                            {"exponential", flag(model.options.exponential)},
                            {"rotation", flag(model.options.rotation)},
                            {"shape_input", flag(model.options.shape_input)},
                            {"joint_names", nlohmann::json(model.body.joint_names).dump()},
                            {"parents", nlohmann::json(model.body.parents).dump()},
                            {"num_vertices", std::to_string(model.body.num_vertices)},
                            {"num_cells", std::to_string(model.body.num_cells)},
                            {"connectivity", detail::connectivity_text(model.body.connectivity)}};
    for (const auto& [key, value] : model.notes) {
        metadata.emplace("note." + key, value);
    }
    write_safetensors(path, tensors, metadata);
}

template <RealScalar N>
NeuralModel<N> read_neural_model(const std::filesystem::path& path) {
    const SafetensorsFile file = read_safetensors(path);
    const detail::ModelMetadata metadata(file);
    metadata.require_text("softtissue_model", detail::neural_model_format);
    metadata.require_text("activation", "gelu");
    metadata.require_text("dtype", detail::dtype_name<N>());
    NetworkOptions options;
    const std::string& kind = metadata.text("kind");
    require(kind == "gradient" || kind == "vertex", file.path(), ": kind is '", kind,
            "', expected 'gradient' or 'vertex'");
    options.kind = kind == "gradient" ? NetworkKind::gradient : NetworkKind::vertex;
    options.exponential = metadata.flag("exponential");
    options.rotation = metadata.flag("rotation");
    options.shape_input = metadata.flag("shape_input");
    BodyIdentity body{metadata.list<std::string>("joint_names"), metadata.list<std::int32_t>("parents"),
                      metadata.number<std::uint32_t>("num_vertices"), metadata.number<std::uint32_t>("num_cells"),
                      metadata.number<std::uint64_t>("connectivity", 16)};
    require(body.joint_names.empty() || body.joint_names.size() == body.parents.size(), file.path(), ": ",
            body.joint_names.size(), " joint names for ", body.parents.size(), " parents");

    std::set<std::string> unread;
    for (const auto& [name, tensor] : file.tensors()) {
        unread.insert(name);
    }
    Mlp<N> mlp = detail::read_network<N>(file, unread);
    if (file.contains("decoder.weight")) {
        detail::require_foldable(file, mlp);
        mlp = fold_decoder(mlp, LinearDecoder<N>{file.at("decoder.weight").template matrix<N>(),
                                                 file.at("decoder.bias").template vector<N>()});
        unread.erase("decoder.weight");
        unread.erase("decoder.bias");
    }
    NeuralModel<N> model{metadata.text("name"), options, std::move(mlp), {}, std::move(body), {}};
    if (options.shape_input) {
        model.shape_space = detail::read_shape_space(file, unread);
    }
    require(unread.empty(), file.path(), ": tensor '", unread.empty() ? "" : *unread.begin(), "' is none of a model's");
    const std::string note = "note.";
    for (const auto& [key, value] : file.metadata()) {
        if (key.starts_with(note)) {
            model.notes.emplace(key.substr(note.size()), value);
        }
    }
    model.validate(file.path());
    return model;
}

}  // namespace softtissue
