// SPDX-License-Identifier: MIT
// Every kind of file that the library writes itself, small, in two versions.
#pragma once

#include <softtissue/io/atomic_file.hpp>
#include <softtissue/io/gltf.hpp>
#include <softtissue/io/npz.hpp>
#include <softtissue/io/obj.hpp>
#include <softtissue/io/pvd.hpp>
#include <softtissue/io/sample_file.hpp>
#include <softtissue/io/training_state_file.hpp>
#include <softtissue/io/usda.hpp>
#include <softtissue/io/vtu.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace faults {

using namespace softtissue;

/// Sums of the number of the version and of the place: no two versions agree anywhere.
inline Matrix3X<double> points(int version, Index count = 200) {
    return Matrix3X<double>::NullaryExpr(3, count,
                                         [&](Index d, Index v) { return version + 0.25 * double(3 * v + d); });
}

inline Triangles strip(Index count = 198) {
    return Triangles::NullaryExpr(3, count, [](Index k, Index t) { return std::int32_t(t + k); });
}

inline void write_plain(const std::filesystem::path& path, int version) {
    AtomicFile file(path);
    for (int block = 0; block < 5; ++block) {
        file.write(std::string(3000, char('0' + version)));
    }
    file.commit();
}

inline void write_stored(const std::filesystem::path& path, int version) {
    write_npz(path, {{"a", NpyArray::from_columns(points(version))}, {"b", NpyArray::from_scalar(double(version))}});
}

inline void write_deflated(const std::filesystem::path& path, int version) {
    write_npz(path, {{"a", NpyArray::from_columns(points(version))}}, NpzCompression::deflated);
}

inline void write_training(const std::filesystem::path& path, int version) {
    TrainingState<float> state(points(version).reshaped().cast<float>());
    state.training_losses = state.validation_losses = {1.0, 0.5};
    write_training_state(path, state, {{"description", "version " + std::to_string(version)}});
}

inline void write_dataset_sample(const std::filesystem::path& path, int version) {
    DatasetSample sample;
    sample.sample = version;
    sample.pose = Pose<double>::rest(2);
    sample.betas = VectorX<double>::Constant(3, version);
    sample.positions = points(version);
    sample.status = "converged";
    write_sample(path, sample);
}

inline void write_surface(const std::filesystem::path& path, int version) {
    write_obj(path, points(version), strip());
}

inline void write_mesh(const std::filesystem::path& path, int version) {
    write_vtu(path, points(version), strip(),
              {.vertex_arrays = {{"moved", points(version).cast<float>()}}, .cell_arrays = {}});
}

inline void write_series(const std::filesystem::path& path, int version) {
    std::vector<PvdStep> steps;
    for (int k = 0; k < 100; ++k) {
        steps.push_back({version + 0.5 * k, "frame_" + std::to_string(k) + ".vtu"});
    }
    write_pvd(path, steps);
}

inline void write_gltf(const std::filesystem::path& path, int version) {
    GltfAnimation animation(30.0);
    const Index mesh = animation.add_mesh({.name = "m", .triangles = strip()});
    animation.add_frame(mesh, points(version));
    animation.add_frame(mesh, points(version + 10));
    animation.write(path);
}

inline void write_usda(const std::filesystem::path& path, int version) {
    UsdAnimation animation(30.0);
    const Index mesh = animation.add_surface({.name = "m", .triangles = strip()});
    animation.add_frame(mesh, points(version));
    animation.write(path);
}

struct Writer {
    const char* name;
    void (*write)(const std::filesystem::path& path, int version);
    bool needs_json = false;  // of nlohmann, which without memory may end the process
};

inline constexpr Writer writers[] = {{"plain.txt", write_plain},
                                     {"stored.npz", write_stored},
                                     {"deflated.npz", write_deflated},
                                     {"training.safetensors", write_training, true},
                                     {"sample.npz", write_dataset_sample},
                                     {"surface.obj", write_surface},
                                     {"mesh.vtu", write_mesh},
                                     {"series.pvd", write_series},
                                     {"animation.glb", write_gltf, true},
                                     {"animation.usda", write_usda}};

}  // namespace faults
