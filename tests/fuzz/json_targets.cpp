// SPDX-License-Identifier: MIT
// Readers of JSON and of what contains JSON.
#include "target.hpp"
#ifdef SOFTTISSUE_LIBFUZZER
#include "mutation.hpp"
#endif

#include <softtissue/io/character_rig.hpp>
#include <softtissue/io/gltf_document.hpp>
#include <softtissue/io/gltf_reader.hpp>
#include <softtissue/io/joint_names_file.hpp>
#include <softtissue/io/json_element.hpp>
#include <softtissue/io/network_file.hpp>
#include <softtissue/io/neural_model_file.hpp>
#include <softtissue/io/safetensors.hpp>
#include <softtissue/io/training_state_file.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace softtissue_fuzz {

using namespace softtissue;

namespace {

/// Every question to an element, then to those in it.
void ask(const JsonElement& element, int depth) {
    is_accepted([&] { expect(std::isfinite(element.number()), "a number is finite"); });
    is_accepted([&] { expect(std::abs(element.integer(-7, 9)) <= 9, "an integer is in range"); });
    is_accepted([&] { expect(element.integer(0, GltfContainer::max_integer) >= 0, "an integer is in range"); });
    is_accepted([&] { static_cast<void>(element.text()); });
    is_accepted([&] { static_cast<void>(element.flag()); });
    is_accepted([&] { expect(element.numbers(3).allFinite(), "numbers are finite"); });
    is_accepted([&] { static_cast<void>(element.items("a")); });
    is_accepted([&] {
        for (Index i = 0; depth > 0 && i < element.size(); ++i) {
            ask(element.at(i), depth - 1);
        }
    });
    for (const char* key : {"a", "b", "c"}) {
        is_accepted([&] { ask(element.at(key), depth - 1); });
    }
}

void json_element(Bytes bytes) {
    const std::string_view text = as_text(bytes);
    const nlohmann::json json = nlohmann::json::parse(text.begin(), text.end(), nullptr, false);
    ask(JsonElement("input", json), 6);
}

void joint_names(Bytes bytes) {
    const std::vector<std::int32_t> joints = read_joint_names(input_file("input.json", bytes), {"a", "b", "c"});
    static_cast<void>(smpl_extremities_of(KinematicTree({-1, 0, 1}), joints));
}

template <class T>
void read_values(const StoredTensor& tensor) {
    is_accepted([&] { expect(std::ssize(tensor.values<T>()) == tensor.num_elements(), "values() gives all"); });
}

void safetensors(Bytes bytes) {
    const SafetensorsFile file = read_safetensors(input_file("input.safetensors", bytes));
    for (const auto& [name, tensor] : file.tensors()) {
        read_values<double>(tensor);
        read_values<float>(tensor);
        read_values<std::int64_t>(tensor);
        read_values<std::int32_t>(tensor);
        read_values<std::uint8_t>(tensor);
        is_accepted([&tensor = tensor] { static_cast<void>(tensor.scalar<double>()); });
        is_accepted([&tensor = tensor] { static_cast<void>(tensor.vector<float>()); });
        is_accepted([&tensor = tensor] { static_cast<void>(tensor.matrix<double>()); });
    }
}

void network(Bytes bytes) {
    const Mlp<float> mlp = load_network<float>(read_safetensors(input_file("input.safetensors", bytes)), "net.");
    const MatrixX<float> inputs = MatrixX<float>::Zero(mlp.sizes().inputs, 2);
    MatrixX<float> outputs(mlp.sizes().outputs, 2);
    Mlp<float>::Scratch scratch = mlp.make_scratch(2);
    mlp.infer_into(inputs, scratch, outputs);
}

void neural_model(Bytes bytes) {
    const NeuralModel<float> model = read_neural_model<float>(input_file("input.safetensors", bytes));
    if (model.options.shape_input) {
        const VectorX<double> zero = VectorX<double>::Zero(model.num_shape_inputs());
        expect(model.shape_space.decode(zero).allFinite(), "the mean shape is finite");
    }
}

void training_state(Bytes bytes) {
    const TrainingState<float> state = read_training_state<float>(input_file("input.safetensors", bytes));
    expect(state.first_moment.size() == state.parameters.size(), "as many moments as parameters");
}

/// Every accessor of the file, whatever uses it.
void read_accessors(const std::filesystem::path& path) {
    GltfDocument document(path);
    nlohmann::json number = 0;
    for (Index k = 0; k < document.count("accessors"); ++k) {
        number = k;
        for (const char* type : {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT4"}) {
            is_accepted([&] {
                expect(document.read(JsonElement("accessor", number), type).values.allFinite(), "numbers are finite");
            });
        }
    }
}

void use(const GltfCharacter& character) {
    expect(character.positions.allFinite(), "positions are finite");
    expect(character.triangles.minCoeff() >= 0 && character.triangles.maxCoeff() < character.num_vertices(),
           "triangles are of vertices");
    const auto morphed_at = [&](const VectorX<double>& weights) { static_cast<void>(character.morphed(weights)); };
    morphed_at(character.morph_weights);
    for (const GltfClip& clip : character.clips) {
        for (const double share : {-0.1, 0.0, 0.3, 1.0}) {
            const double time = clip.start + share * clip.duration();
            expect(Index(character.joint_transforms(clip, time).size()) == character.num_joints(), "joints move");
            morphed_at(character.morph_weights_at(clip, time));
        }
    }
    const CharacterRig rig(character);
    is_accepted([&] { static_cast<void>(rig.body()); });
    for (const GltfClip& clip : character.clips) {
        is_accepted([&] {
            const Pose<double> pose = rig.pose(clip, clip.start + 0.3 * clip.duration());
            expect(pose.rotation_vectors.allFinite() && pose.translation.allFinite(), "a pose is finite");
        });
        if (clip.duration() < 2.0) {
            is_accepted([&] { static_cast<void>(rig.motion(clip)); });
        }
    }
}

void gltf(Bytes bytes) {
    input_file("buffer.bin", std::string(256, '\0'));
    const std::filesystem::path path = input_file("input.glb", bytes);
    is_accepted([&] { read_accessors(path); });
    is_accepted([&] { use(read_gltf_character(path, {.weld = false})); });
    is_accepted([&] { use(read_gltf_character(path, {.fill_holes = true})); });
    use(read_gltf_character(path));
}

}  // namespace

#ifdef SOFTTISSUE_LIBFUZZER
void fit_tensors(std::string& header, std::string& elements, std::size_t most_data) {
    using Json = nlohmann::ordered_json;
    Json json = Json::parse(header, nullptr, false);
    if (!json.is_object()) {
        return;
    }
    std::size_t end = 0;
    for (auto& [name, tensor] : json.items()) {
        if (name == "__metadata__" || !tensor.is_object() || !tensor.contains("shape") || !tensor["shape"].is_array()) {
            continue;
        }
        const std::string type = tensor.contains("dtype") && tensor["dtype"].is_string() ? tensor["dtype"] : "F64";
        std::size_t size = type == "U8" ? 1 : type.ends_with("16") ? 2 : type.ends_with("32") ? 4 : 8;
        for (const Json& extent : tensor["shape"]) {
            size *= extent.is_number_unsigned() ? extent.get<std::size_t>() % (most_data + 1) : 1;
            size = std::min(size, 16 * most_data);
        }
        tensor["data_offsets"] = {end, end + size};
        end += size;
    }
    if (end <= most_data) {
        header = json.dump(-1, ' ', false, Json::error_handler_t::replace);
        elements.resize(end, '\x3c');
    }
}
#endif

std::span<const Target> json_targets() {
    static constexpr std::array<Target, 7> targets{{{"json_element", Container::none, json_element},
                                                    {"joint_names", Container::none, joint_names},
                                                    {"safetensors", Container::safetensors, safetensors},
                                                    {"network", Container::safetensors, network},
                                                    {"neural_model", Container::safetensors, neural_model},
                                                    {"training_state", Container::safetensors, training_state},
                                                    {"gltf", Container::glb, gltf}}};
    return targets;
}

}  // namespace softtissue_fuzz
