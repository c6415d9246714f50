// SPDX-License-Identifier: MIT
/// @file
/// Animated triangle meshes as binary glTF (.glb), playable in Blender and in web viewers.
///
/// What        vertex animation: frame 0 is the mesh, every later frame a morph target whose weight rises to one and
///             falls back linearly, which is linear interpolation of the vertices between frames. Several meshes, each
///             moved by a translation, play together; a mesh of one frame stands still.
/// Example     GltfAnimation animation(30.0);
///             const Index skin = animation.add_mesh({.name = "skin", .triangles = body.faces});
///             for (const Matrix3X<double>& x : frames) { animation.add_frame(skin, x); }
///             animation.write("skin.glb");
/// Shapes      positions 3 x n, triangles 3 x m, colors 3 x n or empty.
/// Units       metres, y up; frame rate [1/s]; colours linear RGB in [0, 1].
/// Valid       positions are stored in float32: 12 bytes per vertex and frame, twice that with smooth shading.
/// Refuses     frames of different size, values that are not finite, triangles out of range, animated meshes with
///             different numbers of frames, more than 2 GiB (InvalidInput names mesh and frame).
/// Source      Khronos Group, "glTF 2.0 Specification", sec. 3.7.2.2 (morph targets), 3.11 (animations)
/// Needs       tinygltf (link with -ltinygltf)
/// Tests       tests/unit/io/gltf_test.cpp
#pragma once

#if !__has_include(<tiny_gltf.h>)
#error "softtissue: io/gltf.hpp needs tinygltf (Debian: libtinygltf-dev)"
#endif

#include <softtissue/core/error.hpp>
#include <softtissue/core/notation.hpp>
#include <softtissue/io/atomic_file.hpp>
#include <softtissue/mesh/surface_normals.hpp>

#include <tiny_gltf.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <string>
#include <vector>

namespace softtissue {

/// A mesh of an animation; its positions come frame by frame.
struct GltfMesh {
    std::string name;
    Triangles triangles;
    Vector3<double> translation = Vector3<double>::Zero();        ///< moves the whole mesh [m]
    Vector3<double> base_color = Vector3<double>::Constant(0.8);  ///< multiplies the vertex colours
    Matrix3X<float> colors = {};                                  ///< one per vertex, or empty
    bool smooth_shading = true;                                   ///< store vertex normals for every frame
    double opacity = 1.0;                                         ///< below 1: blended with what lies behind
};

class GltfAnimation {
public:
    explicit GltfAnimation(double frame_rate) : frame_rate_(frame_rate) {
        require(frame_rate > 0.0 && frame_rate <= std::numeric_limits<double>::max(), "gltf: frame rate is ",
                frame_rate, ", expected > 0");
        model_.asset.version = "2.0";
        model_.asset.generator = "softtissue";
        model_.buffers.resize(1);
        model_.scenes.resize(1);
        model_.defaultScene = 0;
    }

    /// Announces a mesh; returns its number for add_frame().
    Index add_mesh(GltfMesh mesh) {
        require(mesh.triangles.cols() > 0, "gltf: mesh '", mesh.name, "' has no triangles");
        const auto number = static_cast<int>(meshes_.size());
        tinygltf::Material material;
        require(mesh.opacity > 0.0 && mesh.opacity <= 1.0, "gltf: opacity of mesh '", mesh.name, "' is ", mesh.opacity,
                ", expected > 0 and <= 1");
        material.pbrMetallicRoughness.baseColorFactor = {mesh.base_color.x(), mesh.base_color.y(), mesh.base_color.z(),
                                                         mesh.opacity};
        material.alphaMode = mesh.opacity < 1.0 ? "BLEND" : "OPAQUE";
        material.pbrMetallicRoughness.metallicFactor = 0.0;
        material.pbrMetallicRoughness.roughnessFactor = 0.7;
        model_.materials.push_back(std::move(material));
        tinygltf::Mesh object;
        object.name = mesh.name;
        object.primitives.resize(1);
        object.primitives[0].mode = TINYGLTF_MODE_TRIANGLES;
        object.primitives[0].material = number;
        model_.meshes.push_back(std::move(object));
        tinygltf::Node node;
        node.name = mesh.name;
        node.mesh = number;
        node.translation.assign(mesh.translation.data(), mesh.translation.data() + 3);
        model_.nodes.push_back(std::move(node));
        model_.scenes[0].nodes.push_back(number);
        meshes_.push_back({std::move(mesh), {}, {}, 0});
        return number;
    }

    /// Appends the next frame of `mesh`, positions 3 x n.
    template <class Derived>
    void add_frame(Index mesh, const Eigen::MatrixBase<Derived>& positions) {
        append_frame(mesh, positions.template cast<float>());
    }

    /// Writes the file, complete or not at all. The animation is finished by that: nothing may be added after it, but it
    /// may be written again.
    void write(const std::filesystem::path& path) {
        require(!meshes_.empty() && finished_ == complete_, path.string(),
                ": expected a gltf animation with meshes whose frames fit");
        if (!finished_) {
            finished_ = true;
            append_animation(path.string());
            complete_ = true;
        }
        AtomicFile file(path);
        errno = 0;
        std::ofstream stream(file.temporary_path(), std::ios::binary);
        tinygltf::TinyGLTF().WriteGltfSceneToStream(&model_, stream, false, true);
        stream.close();
        file.require_written(stream.good());
        file.commit();
    }

private:
    struct MeshState {
        GltfMesh mesh;
        Matrix3X<float> first_positions;
        Matrix3X<float> first_normals;
        Index num_frames;
    };

    static constexpr int no_target = 0;  // not a vertex buffer
    static constexpr std::size_t max_bytes = std::numeric_limits<std::int32_t>::max();

    void append_frame(Index number, const Matrix3X<float>& positions) {
        require(number >= 0 && number < Index(meshes_.size()) && !finished_, "gltf: no mesh ", number,
                " to add a frame to");
        MeshState& state = meshes_[std::size_t(number)];
        const std::string& name = state.mesh.name;
        for (Index v = 0; v < positions.cols(); ++v) {
            require(positions.col(v).allFinite(), "gltf: mesh '", name, "', frame ", state.num_frames, ": vertex ", v,
                    " is not finite");
        }
        tinygltf::Primitive& primitive = model_.meshes[std::size_t(number)].primitives[0];
        if (state.num_frames == 0) {
            append_first_frame(state, positions, primitive);
        } else {
            require(positions.cols() == state.first_positions.cols(), "gltf: mesh '", name, "', frame ",
                    state.num_frames, " has ", positions.cols(), " vertices, expected ", state.first_positions.cols());
            std::map<std::string, int> target;
            target["POSITION"] = append_vectors(positions - state.first_positions);
            if (state.mesh.smooth_shading) {
                target["NORMAL"] = append_vectors(shading_normals(state.mesh, positions) - state.first_normals);
            }
            primitive.targets.push_back(std::move(target));
        }
        ++state.num_frames;
    }

    void append_first_frame(MeshState& state, const Matrix3X<float>& positions, tinygltf::Primitive& primitive) {
        const GltfMesh& mesh = state.mesh;
        const Index n = positions.cols();
        require(mesh.triangles.minCoeff() >= 0 && mesh.triangles.maxCoeff() < n, "gltf: mesh '", mesh.name,
                "' has triangles with vertices from ", mesh.triangles.minCoeff(), " to ", mesh.triangles.maxCoeff(),
                ", expected 0 to ", n - 1);
        require(mesh.colors.cols() == 0 || mesh.colors.cols() == n, "gltf: mesh '", mesh.name, "' has ",
                mesh.colors.cols(), " colours, expected ", n);
        for (Index v = 0; v < mesh.colors.cols(); ++v) {
            const Vector3<float> color = mesh.colors.col(v);
            require((color.array() >= 0.0F && color.array() <= 1.0F).all(), "gltf: mesh '", mesh.name,
                    "': colour of vertex ", v, " is ", color.transpose(), ", expected three values from 0 to 1");
        }
        state.first_positions = positions;
        primitive.attributes["POSITION"] = append_vectors(positions);
        if (mesh.smooth_shading) {
            state.first_normals = shading_normals(mesh, positions);
            primitive.attributes["NORMAL"] = append_vectors(state.first_normals);
        }
        if (mesh.colors.cols() > 0) {
            primitive.attributes["COLOR_0"] = append_vectors(mesh.colors);
        }
        primitive.indices = append_accessor(mesh.triangles.data(), std::size_t(mesh.triangles.size()),
                                            TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR,
                                            TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);
    }

    /// Unit normals; glTF allows no zero normal, so a vertex without one looks up.
    static Matrix3X<float> shading_normals(const GltfMesh& mesh, const Matrix3X<float>& positions) {
        Matrix3X<float> normals = vertex_normals(positions, mesh.triangles);
        for (Index v = 0; v < normals.cols(); ++v) {
            if (normals.col(v).squaredNorm() < 0.5F) {
                normals.col(v) = Vector3<float>::UnitY();
            }
        }
        return normals;
    }

    /// One key per frame: weights of the targets, all zero for frame 0, then one target after the other.
    void append_animation(const std::string& file) {
        Index frames = 1;
        tinygltf::Animation animation;
        for (std::size_t m = 0; m < meshes_.size(); ++m) {
            const MeshState& state = meshes_[m];
            require(state.num_frames > 0, file, ": gltf mesh '", state.mesh.name, "' has no frames");
            if (state.num_frames == 1) {
                continue;
            }
            require(frames == 1 || frames == state.num_frames, file, ": gltf mesh '", state.mesh.name, "' has ",
                    state.num_frames, " frames, expected ", frames, " as in the other meshes");
            if (frames == 1) {
                frames = state.num_frames;
                append_keys(frames, animation);
            }
            tinygltf::AnimationChannel channel;
            channel.sampler = 0;
            channel.target_node = static_cast<int>(m);
            channel.target_path = "weights";
            animation.channels.push_back(std::move(channel));
        }
        if (frames > 1) {
            model_.animations.push_back(std::move(animation));
        }
    }

    void append_keys(Index frames, tinygltf::Animation& animation) {
        VectorX<float> times(frames);
        for (Index t = 0; t < frames; ++t) {
            times(t) = static_cast<float>(double(t) / frame_rate_);
        }
        const Index targets = frames - 1;
        MatrixX<float> weights = MatrixX<float>::Zero(targets, frames);
        weights.rightCols(targets).diagonal().setOnes();
        tinygltf::AnimationSampler sampler;
        sampler.input = append_accessor(times.data(), std::size_t(frames), TINYGLTF_COMPONENT_TYPE_FLOAT,
                                        TINYGLTF_TYPE_SCALAR, no_target);
        model_.accessors.back().minValues = {0.0};
        model_.accessors.back().maxValues = {double(times(frames - 1))};
        sampler.output = append_accessor(weights.data(), std::size_t(weights.size()), TINYGLTF_COMPONENT_TYPE_FLOAT,
                                         TINYGLTF_TYPE_SCALAR, no_target);
        animation.samplers.push_back(std::move(sampler));
    }

    int append_vectors(const Matrix3X<float>& vectors) {
        const int accessor = append_accessor(vectors.data(), std::size_t(vectors.cols()), TINYGLTF_COMPONENT_TYPE_FLOAT,
                                             TINYGLTF_TYPE_VEC3, TINYGLTF_TARGET_ARRAY_BUFFER);
        const Vector3<double> lowest = vectors.rowwise().minCoeff().cast<double>();
        const Vector3<double> highest = vectors.rowwise().maxCoeff().cast<double>();
        model_.accessors.back().minValues.assign(lowest.data(), lowest.data() + 3);
        model_.accessors.back().maxValues.assign(highest.data(), highest.data() + 3);
        return accessor;
    }

    /// Copies `count` elements of 4-byte components into the buffer, behind a view and an accessor of their own.
    int append_accessor(const void* data, std::size_t count, int component_type, int type, int target) {
        std::vector<unsigned char>& buffer = model_.buffers[0].data;
        const std::size_t bytes = count * (type == TINYGLTF_TYPE_VEC3 ? 12 : 4);
        require(bytes <= max_bytes - buffer.size(), "gltf: more than ", max_bytes,
                " bytes, expected fewer frames or vertices");
        tinygltf::BufferView view;
        view.buffer = 0;
        view.byteOffset = buffer.size();
        view.byteLength = bytes;
        view.target = target;
        buffer.resize(buffer.size() + bytes);
        std::memcpy(buffer.data() + view.byteOffset, data, bytes);
        model_.bufferViews.push_back(std::move(view));
        tinygltf::Accessor accessor;
        accessor.bufferView = static_cast<int>(model_.bufferViews.size()) - 1;
        accessor.componentType = component_type;
        accessor.type = type;
        accessor.count = count;
        model_.accessors.push_back(std::move(accessor));
        return static_cast<int>(model_.accessors.size()) - 1;
    }

    double frame_rate_;
    std::vector<MeshState> meshes_;
    tinygltf::Model model_;
    bool finished_ = false;
    bool complete_ = false;
};

}  // namespace softtissue
