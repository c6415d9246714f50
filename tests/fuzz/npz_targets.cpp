// SPDX-License-Identifier: MIT
// Readers of .npy and .npz.
#include "target.hpp"

#include <softtissue/io/amass_file.hpp>
#include <softtissue/io/dataset_folder.hpp>
#include <softtissue/io/dataset_plan_file.hpp>
#include <softtissue/io/layered_body_file.hpp>
#include <softtissue/io/npy_array.hpp>
#include <softtissue/io/npz.hpp>
#include <softtissue/io/sample_file.hpp>
#include <softtissue/io/smpl_file.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace softtissue_fuzz {

using namespace softtissue;

namespace {

template <class T>
void read_values(const NpyArray& array) {
    is_accepted([&] { expect(std::ssize(array.as<T>()) == array.num_elements(), "as() gives every element"); });
}

void read_every_way(const NpyArray& array) {
    read_values<double>(array);
    read_values<float>(array);
    read_values<std::int64_t>(array);
    read_values<std::int32_t>(array);
    read_values<std::uint8_t>(array);
    is_accepted([&] { static_cast<void>(array.strings()); });
    is_accepted([&] { static_cast<void>(array.scalar<double>()); });
    is_accepted([&] { static_cast<void>(array.vector<float>()); });
    is_accepted([&] { static_cast<void>(array.columns3<double>()); });
    is_accepted([&] { static_cast<void>(array.matrices<float, 3, 2>()); });
    is_accepted([&] {
        const MatrixX<double> matrix = array.matrix<double>();
        expect(matrix.size() == array.num_elements(), "matrix() gives every element");
    });
}

void npy(Bytes bytes) {
    read_every_way(NpyArray("input", {bytes.begin(), bytes.end()}));
}

void npz(Bytes bytes) {
    const NpzFile file = read_npz(input_file("input.npz", bytes));
    for (const auto& [name, array] : file.arrays()) {
        read_every_way(array);
    }
}

void amass(Bytes bytes) {
    const std::filesystem::path path = input_file("input.npz", bytes);
    is_accepted([&] {
        const AmassClip<float> clip = read_amass_clip<float>(path, 24, AmassHands::at_rest);
        expect(shape_coefficients(clip.betas, 10).allFinite(), "shape coefficients are finite");
    });
    const AmassClip<double> clip = read_amass_clip<double>(path, 2);
    expect(clip.file_joints == 2 && clip.motion.num_frames() > 0, "a clip has frames of two joints");
}

void smpl(Bytes bytes) {
    const std::filesystem::path path = input_file("input.npz", bytes);
    const SmplBody<float> body = read_smpl_body<float>(path, SmplSurface::any);
    expect((body.joint_regressor * body.template_vertices.transpose()).rows() == body.num_joints(),
           "the regressor gives the joints");
    is_accepted([&] { static_cast<void>(read_smpl_body<double>(path)); });
}

/// What programs do with a layered body, without looking at it first.
void use(const SkeletalLayers<double>& file) {
    const LayeredBody<double>& body = file.body.layered;
    expect(body.column_weights().num_vertices() == body.num_columns(), "a row of weights for every column");
    static_cast<void>(capped_volume<double>(body.level_positions(0), body.region.triangles, body.region.loops));
    const Matrix3X<double> skin = Matrix3X<double>::Zero(3, Index(body.region.region_vertices.size()));
    expect(body.region.gather(skin).cols() == body.region.num_vertices(), "body vertices exist");
    expect(body.skin_offsets.allFinite() && body.mesh.rest_positions.allFinite(), "positions are finite");
    expect(!body.region.cut_distance.hasNaN(), "distances are no NaN");
    expect(file.joint_names.empty() || Index(file.joint_names.size()) == file.tree.num_joints(), "a name a joint");
}

void layered_body(Bytes bytes) {
    const std::filesystem::path path = input_file("input.npz", bytes);
    const SkeletalLayers<double> file = read_layered_body<double>(path);
    use(file);
    static_cast<void>(read_body_shape(path, file.body));
}

void sample(Bytes bytes) {
    const DatasetSample sample = read_sample(input_file("input.npz", bytes));
    expect(sample.positions.allFinite() && sample.betas.allFinite(), "a sample is finite");
    static_cast<void>(to_string(sample.split));
}

void use(const DatasetPlan& plan) {
    Index samples = 0;
    for (Index b = 0; b < plan.num_bodies(); ++b) {
        expect(plan.bodies[size_t(b)].betas.allFinite(), "shape coefficients are finite");
        const auto [first, last] = plan.samples_of(b);
        samples += last - first;
    }
    expect(samples == plan.num_samples(), "every sample has a body");
    for (const PlannedSample& planned : plan.samples) {
        const PlannedPose& pose = plan.poses[size_t(planned.pose)];
        expect(pose.pose.rotation_vectors.allFinite() && std::isfinite(pose.noise), "poses are finite");
    }
}

void dataset_plan(Bytes bytes) {
    use(read_dataset_plan(input_file("input.npz", bytes)));
}

/// One .npz with the arrays of all files of the folder, and plan.json.
void dataset_folder(Bytes bytes) {
    for (const char* folder : {"bodies", "samples", "failed"}) {
        std::filesystem::create_directories(input_folder() / folder);
    }
    for (const char* name : {"plan.npz", "body.npz", "bodies/000000.npz", "samples/000000.npz"}) {
        input_file(name, bytes);
    }
    std::string definition = "{\"format\": 1}";
    if (const auto parts = split(Container::npz, as_text(bytes))) {
        for (const Part& part : *parts) {
            definition = part.name == "plan.json" ? part.bytes : definition;
        }
    }
    input_file("plan.json", definition);
    input_file("failed/000000.json", definition);
    const DatasetFolder data(input_folder());
    use(data.plan());
    is_accepted([&] { data.require_definition({{"seed", 1}}); });
    is_accepted([&] { static_cast<void>(data.body(0)); });
    is_accepted([&] { static_cast<void>(data.sample(0)); });
    is_accepted([&] { static_cast<void>(data.failure(0)); });
    expect(data.finished(DatasetSplit::train).size() <= 1, "one sample is there");
}

}  // namespace

std::span<const Target> npz_targets() {
    static constexpr std::array<Target, 8> targets{{{"npy", Container::none, npy},
                                                    {"npz", Container::npz, npz},
                                                    {"amass", Container::npz, amass},
                                                    {"smpl", Container::npz, smpl},
                                                    {"layered_body", Container::npz, layered_body},
                                                    {"sample", Container::npz, sample},
                                                    {"dataset_plan", Container::npz, dataset_plan},
                                                    {"dataset_folder", Container::npz, dataset_folder}}};
    return targets;
}

}  // namespace softtissue_fuzz
